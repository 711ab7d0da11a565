#include "src/depth_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/boundary.hpp"
#include "domain/depth_fields.hpp"
#include "domain/merging_fields.hpp"
#include "domain/pore_pressure_field.hpp"
#include "domain/two_phase_fields.hpp"
#include "physics/depth/merging.hpp"
#include "src/step_support.hpp"

namespace talus {

namespace {
constexpr double pairs_worth_a_particle = 20;  // what costs the same as all but pairs
constexpr std::uint64_t merging_interval =
    5;  // steps; columns move little in them, and a search costs as a pass
}  // namespace

DepthSimulation::DepthSimulation(const Communicator& comm, DepthSetup setup, ParticleSet particles)
    : comm_(comm),
      setup_(std::move(setup)),
      particles_(std::move(particles)),
      decomposition_(comm, setup_.partition),
      outflow_(comm) {
    decomposition_.expect(particles_);
}

void DepthSimulation::add_fields(ParticleSet& particles, const DepthSetup& setup) {
    const auto add = [&particles](std::initializer_list<const FieldInfo*> fields) {
        for (const FieldInfo* info : fields) particles.add(*info);
    };
    const depth::Settings& settings = setup.settings;
    add({&field::velocity, &field::volume, &field::smoothing_length, &field::depth, &field::acceleration,
         &field::predicted_velocity, &field::next_smoothing_length, &field::column_height,
         &field::grad_h_volume, &field::pressure_factor, &field::wave_speed, &field::signal_speed});
    if (settings.balance) add({&field::still_acceleration});
    if (settings.merging_distance > 0) add({&field::known_id, &field::nearest_column});
    if (settings.earth_pressure) add({&field::divergence, &field::earth_pressure});
    if (settings.two_phase)
        add({&field::is_water, &field::other_height, &field::other_cover, &field::lateral_gravity,
             &field::relative_velocity, &field::exchange});
    if (settings.two_phase && settings.entrainment > 0) add({&field::released_water});
    const bool fitted = settings.form == depth::Form::bed_fitted;
    const bool level = setup.terrain->is_plane() && setup.terrain->slope(0, 0) == std::array<double, 2>{};
    const bool by_level = settings.gradient == depth::Gradient::level;
    if (by_level) add({&field::surface_level});
    if (fitted || !level || by_level) add({&field::bed_slope});
    if (fitted) add({&field::apparent_gravity});
    if (setup.pore_pressure) particles.add(field::excess_pore_pressure, setup.pore_pressure->points);
}

double DepthSimulation::interaction_radius() const {
    double largest = 0;
    for (const double s : particles_.own(field::smoothing_length)) largest = std::max(largest, s);
    largest = comm_.all_max(largest);
    if (largest == 0) largest = setup_.settings.largest_smoothing_length;  // all have left the terrain
    return largest * depth::Settings::support();
}

double DepthSimulation::work() const {
    return std::accumulate(pass_count_.work_of_cell.begin(), pass_count_.work_of_cell.end(), 0.0);
}

void DepthSimulation::arrange() {
    if (grid_.fit(setup_.box, interaction_radius(), true)) decomposition_.divide(particles_, *grid_);
    decomposition_.arrange(particles_, *grid_);
}

void DepthSimulation::start() {
    constexpr int most_rounds = 100;
    constexpr double enough = 1e-14, tolerable = 1e-6;  // relative; rounding keeps some from the first
    double change = 1;
    for (int round = 0; round < most_rounds && !(change < enough); ++round) {
        arrange();
        depth::predict(particles_, setup_.settings, setup_.friction, 0);
        find_heights();
        change = comm_.all_max(change_of_smoothing_lengths());
        const auto next = std::as_const(particles_).own(field::next_smoothing_length);
        std::copy(next.begin(), next.end(), particles_.data(field::smoothing_length));
    }
    comm_.all_agree(
        1, change < tolerable
               ? ""
               : fmt::format("the smoothing lengths of the columns are not found: after {} rounds they "
                             "still change by {:.3g}, relative; allowed: {:g}. Columns that stand in one "
                             "place, or sizes that differ too much?",
                             most_rounds, change, tolerable));
    arrange();
    evaluate(0);
    conclude_step();
}

double DepthSimulation::change_of_smoothing_lengths() const {
    const auto now = particles_.own(field::smoothing_length),
               next = particles_.own(field::next_smoothing_length);
    double greatest = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
        greatest = std::max(greatest, std::abs(next[i] / now[i] - 1));
    return greatest;
}

void DepthSimulation::resume(double time, double time_step, std::uint64_t step,
                             const std::map<std::string, double>& numbers) {
    time_ = time;
    time_step_ = time_step;
    step_ = step;
    outflow_.restore(numbers);
    arrange();
}

void DepthSimulation::step() {
    const double dt = time_step_;
    phases_.enter(Phase::motion);
    depth::kick(particles_, setup_.settings, setup_.friction, dt / 2);
    const bool is_merging = setup_.settings.merging_distance > 0 && (step_ + 1) % merging_interval == 0;
    const Decomposition::Ledger merged = is_merging ? merge() : Decomposition::Ledger{};
    depth::drift(particles_, setup_.settings, dt);
    apply_boundaries(particles_, setup_.box);
    phases_.enter(Phase::decompose);
    const Decomposition::Ledger gone = outflow_.take(particles_, *setup_.terrain, time_ + dt);
    decomposition_.expect_change({}, gone);
    const auto interval = static_cast<std::uint64_t>(setup_.rebalance_interval);
    if (work_measured_ && gone.count() + merged.count() == 0 && interval > 0 && step_ % interval == 0)
        decomposition_.rebalance(pass_count_.work_of_cell);
    arrange();
    evaluate(dt / 2);
    phases_.enter(Phase::motion);
    depth::kick(particles_, setup_.settings, setup_.friction, dt / 2);
    if (setup_.settings.balance) depth::fade_balance(particles_, dt);
    if (setup_.settings.two_phase) drag(dt);
    if (setup_.settings.two_phase && setup_.settings.entrainment > 0) erode(dt);
    time_ += dt;
    ++step_;
    conclude_step();
    phases_.stop();
}

void DepthSimulation::find_heights() {
    depth::Settings settings = setup_.settings;
    settings.largest_smoothing_length =
        std::min(settings.largest_smoothing_length, grid_->covered_radius() / depth::Settings::support());
    const auto pass = [&](Cells cells) {
        depth::height_pass(particles_, decomposition_.table(), cells, settings);
    };
    if (settings.earth_pressure)
        overlapped(phases_, Phase::density, decomposition_.halo(), particles_,
                   {&field::position, &field::volume, &field::predicted_velocity}, pass);
    else if (settings.two_phase)
        overlapped(phases_, Phase::density, decomposition_.halo(), particles_,
                   {&field::position, &field::volume, &field::smoothing_length, &field::is_water}, pass);
    else
        overlapped(phases_, Phase::density, decomposition_.halo(), particles_,
                   {&field::position, &field::volume}, pass);
}

/// The velocities as they are now into predicted_velocity, which partners can see.
void DepthSimulation::copy_velocity() {
    for (int axis = 0; axis < particles_.dimension(); ++axis) {
        const auto now = std::as_const(particles_).own(field::velocity, axis);
        std::copy(now.begin(), now.end(), particles_.data(field::predicted_velocity, axis));
    }
}

/// Columns that have come nearer than merging_distance become one. Returns what is gone, the same on every
/// rank; the decomposition expects it. arrange() must follow.
Decomposition::Ledger DepthSimulation::merge() {
    phases_.enter(Phase::density);
    copy_velocity();
    const auto ids = std::as_const(particles_).own(field::id);
    std::copy(ids.begin(), ids.end(), particles_.data(field::known_id));
    decomposition_.halo().begin(particles_, {&field::position, &field::smoothing_length, &field::volume,
                                             &field::predicted_velocity, &field::known_id});
    decomposition_.halo().finish();
    const std::vector<std::uint32_t> nearest =
        depth::find_nearest(particles_, decomposition_.table(), setup_.settings);
    decomposition_.halo().begin(particles_, {&field::nearest_column});
    decomposition_.halo().finish();
    const std::vector<std::uint32_t> kept = depth::merge(particles_, nearest);
    Decomposition::Ledger gone{{particles_.size() - kept.size(), 0}};
    for (const std::uint64_t id : ids) gone.sums[1] += id;
    for (const std::uint32_t i : kept) gone.sums[1] -= ids[i];
    if (gone.count() > 0) particles_.reorder(kept);
    comm_.all_sum(std::span<std::uint64_t>(gone.sums));
    decomposition_.expect_change({}, gone);
    phases_.enter(Phase::motion);
    return gone;
}

/// Drag between solid and water for a time, with the velocities as they are now.
void DepthSimulation::drag(double time) {
    copy_velocity();
    overlapped(phases_, Phase::forces, decomposition_.halo(), particles_, {&field::predicted_velocity},
               [&](Cells cells) {
                   depth::relative_velocity_pass(particles_, decomposition_.table(), cells, setup_.settings,
                                                 time);
               });
    overlapped(phases_, Phase::forces, decomposition_.halo(), particles_,
               {&field::relative_velocity, &field::exchange}, [&](Cells cells) {
                   depth::drag_pass(particles_, decomposition_.table(), cells, setup_.settings);
               });
    phases_.enter(Phase::motion);
}

/// What solid takes up of the ground in a time, and water with it.
void DepthSimulation::erode(double time) {
    overlapped(phases_, Phase::forces, decomposition_.halo(), particles_, {&field::volume}, [&](Cells cells) {
        depth::erosion_pass(particles_, decomposition_.table(), cells, setup_.settings, time);
    });
    overlapped(phases_, Phase::forces, decomposition_.halo(), particles_, {&field::released_water},
               [&](Cells cells) { depth::release_pass(particles_, decomposition_.table(), cells); });
    phases_.enter(Phase::motion);
}

/// Everything that follows from positions and the predicted velocities.
void DepthSimulation::evaluate(double time_ahead) {
    phases_.enter(Phase::motion);
    depth::predict(particles_, setup_.settings, setup_.friction, time_ahead);
    find_heights();
    phases_.enter(Phase::material);
    const std::vector<double> loads_before = loads();
    if (const auto& law = setup_.settings.earth_pressure)
        depth::strain_earth_pressure(particles_, *law, 2 * time_ahead);
    depth::meet_bed(particles_, *setup_.terrain, setup_.settings);
    if (setup_.pore_pressure) consolidate(loads_before, 2 * time_ahead);
    if (setup_.settings.two_phase) {
        phases_.enter(Phase::halo);
        decomposition_.halo().begin(particles_,
                                    {&field::other_height, &field::other_cover, &field::lateral_gravity});
        decomposition_.halo().finish();
    }
    pass_count_.pairs = 0;
    pass_count_.work_of_cell.assign(decomposition_.own_cells().size(), 0.0);
    const bool by_level = setup_.settings.gradient == depth::Gradient::level;
    // Where the level drives, the factor is zero; its place in the messages is the level's.
    overlapped(phases_, Phase::forces, decomposition_.halo(), particles_,
               {&field::position, &field::volume, &field::smoothing_length, &field::predicted_velocity,
                &field::depth, &field::wave_speed, &field::grad_h_volume,
                by_level ? static_cast<const FieldInfo*>(&field::surface_level) : &field::pressure_factor},
               [&](Cells cells) {
                   depth::pressure_pass(particles_, decomposition_.table(), cells, setup_.settings,
                                        pass_count_);
                   if (by_level)
                       depth::level_pass(particles_, decomposition_.table(), cells, setup_.settings);
               });
    depth::slide_on_bed(particles_, setup_.settings);
    const std::span<const CellEntry> cells = decomposition_.own_cells();
    for (std::size_t k = 0; k < cells.size(); ++k)
        pass_count_.work_of_cell[k] += pairs_worth_a_particle * (cells[k].end - cells[k].begin);
    pairs_ += pass_count_.pairs;
    work_measured_ = true;
}

/// What loads the mixture of grains and water at the bed, of two phases the buoyant weight of the solid, none
/// in columns of water; nothing without pore pressure. The bed's curvature is left out: its short bumps would
/// drain the flow.
std::vector<double> DepthSimulation::loads() const {
    std::vector<double> found;
    if (!setup_.pore_pressure) return found;
    const depth::Settings& settings = setup_.settings;
    const auto& phases = settings.two_phase;
    const double density = phases ? phases->solid_density - phases->water_density : settings.density;
    const double unit_weight = setup_.pore_pressure->loaded_share * density * settings.gravity;
    const double* is_water = settings.two_phase ? particles_.data(field::is_water) : nullptr;
    const bool fitted = settings.form == depth::Form::bed_fitted;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
        std::array<double, 2> slope{};
        for (int a = 0; fitted && a < particles_.dimension(); ++a)
            slope[static_cast<std::size_t>(a)] = particles_.data(field::bed_slope, a)[i];
        const bool is_loaded = !is_water || is_water[i] == 0;
        found.push_back(is_loaded ? unit_weight * depth::Tilt(slope).cosine * particles_.data(field::depth)[i]
                                  : 0.0);
    }
    return found;
}

void DepthSimulation::consolidate(std::span<const double> loads_before, double time_step) {
    const PorePressure& model = *setup_.pore_pressure;
    std::vector<double*> pressure;
    for (int k = 0; k < model.points; ++k)
        pressure.push_back(particles_.data(field::excess_pore_pressure, k));
    const std::vector<double> loads_after = loads();
    if (step_ == 0 && time_step == 0) return depth::set_pore_pressure(model.ratio, loads_after, pressure);
    std::vector<double> drained_depth;  // both phases fill the depth that water takes its way through
    for (std::size_t i = 0; i < particles_.size(); ++i) drained_depth.push_back(whole_depth(i));
    const depth::LoadedColumns columns{drained_depth, loads_before, loads_after};
    if (model.points == 1)
        depth::consolidate_first_mode(model.law, columns, time_step,
                                      particles_.own(field::excess_pore_pressure));
    else
        depth::consolidate_profile(model.law, columns, time_step, pressure);
}

void DepthSimulation::conclude_step() {
    limit_ = depth::stable_time_step(particles_, setup_.settings, setup_.terrain->resolution());
    phases_.enter(Phase::wait);
    const double before = time_step_;
    time_step_ = agreed_time_step(comm_, particles_, {time_, step_}, limit_);
    if (std::isinf(time_step_)) time_step_ = before;  // all have left the terrain
}

}  // namespace talus
