#include "src/grain_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/boundary.hpp"
#include "domain/clump_fields.hpp"
#include "domain/coupling_fields.hpp"
#include "domain/grain_fields.hpp"

namespace talus {

namespace {

std::size_t history_count(const dem::AnyLawTable& laws) {
    return std::visit([](const auto& table) { return std::decay_t<decltype(table)>::Law::history_count; },
                      laws);
}

/// Force of a contact of a grain of this material pressed in by its own radius, or its pull if that is more,
/// the greatest of all partners [N].
double force_of_flat_grain(const dem::AnyLawTable& laws, std::uint8_t material, double radius, double mass) {
    dem::ContactKinematics<double> flat{};
    flat.overlap = flat.effective_radius = radius;
    flat.effective_mass = mass;
    flat.normal = {1, 0, 0};
    double greatest = 0;
    std::visit(
        [&](const auto& table) {
            for (std::size_t other = 0; other < table.pairs.materials(); ++other) {
                const auto& law = table.pairs(material, other);
                greatest =
                    std::max({greatest, law.elasticity(flat, 0).normal_force, law.surface_force(flat)});
            }
        },
        laws);
    return greatest;
}

/// Of all grains that are or may come [m].
double largest_radius(const Communicator& comm, const ParticleSet& grains, const GrainFlowPlan& flow) {
    double largest = 0;
    for (const double r : grains.own(field::radius)) largest = std::max(largest, r);
    for (const GrainSource& source : flow.sources) largest = std::max(largest, source.greatest_radius());
    return comm.all_max(largest);
}

/// Of the last step, in units of that of a grain without contacts.
std::vector<double> work_of_cells(std::span<const CellEntry> cells, const dem::ContactList& pairs,
                                  std::span<const dem::WallTouch> touches) {
    constexpr double of_contact = 0.9;  // measured: decision 031
    std::vector<double> of_grain(cells.empty() ? 0 : cells.back().end, 1.0);
    const auto add = [&](std::uint32_t i, double work) {
        if (i < of_grain.size()) of_grain[i] += work;
    };
    pairs.for_each_contact([&](std::size_t p, std::size_t) {
        add(pairs.first[p], 0.5 * of_contact);
        add(pairs.second[p], 0.5 * of_contact);
    });
    for (const dem::WallTouch& touch : touches) add(touch.grain, of_contact);
    std::vector<double> work;
    for (const CellEntry& cell : cells)
        work.push_back(std::accumulate(of_grain.begin() + cell.begin, of_grain.begin() + cell.end, 0.0));
    return work;
}

}  // namespace

GrainSimulation::GrainSimulation(const Communicator& comm, GrainSetup setup, ParticleSet grains)
    : comm_(comm),
      places_(setup.box),
      setup_(std::move(setup)),
      grains_(std::move(grains)),
      decomposition_(comm, setup_.partition),
      largest_radius_(largest_radius(comm, grains_, setup_.flow)),
      reach_(dem::greatest_reach(setup_.laws, largest_radius_)),
      flow_(comm, places_.aligned(setup_.box), setup_.flow, largest_radius_),
      pairs_(history_count(setup_.laws)),
      bonds_(setup_.bonds),
      clumps_(setup_.clumps, setup_.held),
      rows_halo_(comm, dem::GrainRows::width, dem::GrainRows::refreshed) {
    setup_.box = places_.aligned(setup_.box);
    for (int axis = 0; axis < 3; ++axis)
        for (double& x : grains_.own(field::position, axis)) x = places_(axis, x);
    if (setup_.box.shear_rate != 0) shear_.emplace(setup_.box, places_, setup_.time_step, largest_radius_);
    decomposition_.expect(grains_);
    // Ranks see all that may act on their grains, and the other ends of their bonds and clumps.
    const double seen = std::max(reach_, dem::greatest_bond_reach(setup_.bonds, largest_radius_));
    const double searched =
        std::max(2 * largest_radius_ + seen + setup_.skin, 1.001 * clumps_.greatest_extent());
    grid_ = std::make_unique<CellGrid>(setup_.fluid_cells
                                           ? setup_.fluid_cells->reaching(searched)
                                           : CellGrid(setup_.box, searched, cells_within(searched)));
    if (bonds_.in_use())
        for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
                 &field::half_step_velocity, &field::half_step_angular_velocity, &field::broken_bonds})
            grains_.add(*info);
    if (!setup_.fluid_cells || setup_.settling) decomposition_.divide(grains_, *grid_);
    if (setup_.self_gravity) gravity_.emplace(comm_, *setup_.self_gravity, setup_.time_step, clumps_);
}

/// Cells across the distance that is searched: where most grains are much smaller, wider ones would be too
/// few to spread over the ranks.
int GrainSimulation::cells_within(double searched) const {
    if (setup_.box.shear_rate != 0) return 1;  // displaced images are counted to the nearest cell
    constexpr double most = 4;
    ExactSum sum;
    for (const double r : std::as_const(grains_).own(field::radius)) sum.add(r);
    ExactSum::all_reduce(comm_, std::span<ExactSum>(&sum, 1));
    const double mean = sum.value() / static_cast<double>(std::max<std::uint64_t>(total_grains(), 1));
    const double gap = searched - 2 * largest_radius_;
    return mean > 0 ? static_cast<int>(std::clamp(searched / (2 * mean + gap), 1.0, most)) : 1;
}

void GrainSimulation::add_fields(ParticleSet& grains) {
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::angular_velocity, &field::acceleration, &field::angular_acceleration,
             &field::radius, &field::mass, &field::body, &field::copied_id})
        grains.add(*info);
}

void GrainSimulation::add_fields(ParticleSet& grains, const GrainSetup& setup) {
    add_fields(grains);
    if (!setup.clumps.empty()) dem::ClumpMotion::add_fields(grains);
    if (setup.self_gravity) GrainGravity::add_fields(grains);
    if (setup.self_gravity && !setup.clumps.empty()) dem::ClumpMotion::add_gravity_fields(grains);
    if (setup.fluid_cells)
        for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
                 &coupling_field::fluid_acceleration, &coupling_field::earlier_velocity})
            grains.add(*info);
    if (setup.slip_memories > 0) {
        grains.add(coupling_field::earlier_slip);
        grains.add(coupling_field::slip_memories, 3 * setup.slip_memories);
    }
}

std::vector<const FieldInfo*> GrainSimulation::history_fields(const GrainSetup& setup) {
    return dem::history_fields(setup.laws);
}

void GrainSimulation::start() {
    flow_.begin(grains_, clumps_);
    if (setup_.settling) time_ = -setup_.settling->longest;
    clumps_.start(grains_, places_);
    arrange({}, time_);
    if (bonds_.in_use()) join_grains();
    evaluate(0);
    finish(0, gravity_ ? gravity_->start(grains_, *grid_, decomposition_) : dem::Impulse{});
    if (setup_.fluid_cells) show_accelerations();
}

void GrainSimulation::join_grains() {
    double gap = 0;
    for (const dem::BondRule& rule : setup_.bonds) gap = std::max(gap, rule.gap * largest_radius_);
    dem::ContactList near(0);
    const std::vector<std::uint8_t> one_material(setup_.material.size(), 0);
    const dem::PairRule rule{.margin = gap,
                             .largest_radius = largest_radius_,
                             .material = one_material,
                             .held = setup_.held,
                             .materials = 1};
    dem::list_pairs(grains_, decomposition_.table(), rule, near);
    bonds_.join(grains_, near);
    arrange({}, time_);
}

void GrainSimulation::resume(double time, std::uint64_t step, const std::map<std::string, double>& numbers,
                             const ParticleSet& contacts, const ParticleSet* bonds) {
    flow_.restore(numbers, time, grains_, clumps_);
    if (time < 0 && !setup_.settling)
        throw AgreedError(
            2, "the checkpoint is of grains that settle before time 0, and the scene has no [settle]");
    if (const auto looks = numbers.find("settle.quiet_looks"); looks != numbers.end())
        quiet_looks_ = static_cast<int>(looks->second);
    time_ = time;
    step_ = last_balance_ = step;
    if (shear_) shear_->go_to(step);
    if (bonds)
        bonds_.adopt(dem::read_pairs<dem::bond_values>(comm_, *bonds, dem::BondList::fields(), grains_));
    arrange(dem::read_pairs<dem::most_history>(comm_, contacts, history_fields(setup_), grains_), time_);
    outdated_ = true;  // how far grains have moved is not known
    if (setup_.fluid_cells) show_accelerations();
}

void GrainSimulation::step() {
    phases_.enter(Phase::motion);
    std::optional<std::vector<dem::ContactRecord>> kept_contacts = exchange_grains();
    hide_accelerations();
    if (gravity_) gravity_->begin_step(grains_, responses_, decomposition_);
    if (shear_)
        shear_->drift(grains_, sums_, setup_.time_step, places_);
    else
        dem::drift(grains_, sums_, setup_.time_step, places_);
    clumps_.drift(grains_, setup_.time_step, places_, shear());
    if (outdated_ || kept_contacts || (gravity_ && gravity_->ends_block()))
        arrange(kept_contacts ? std::move(*kept_contacts) : records_of_contacts(), time_ + setup_.time_step);
    ++step_;
    evaluate(setup_.time_step);
    time_ += setup_.time_step;
    phases_.enter(Phase::gravity);
    finish(setup_.time_step, gravity_ ? gravity_->end_step(grains_, *grid_, decomposition_) : dem::Impulse{});
    if (setup_.fluid_cells) show_accelerations();
    if (time_ < 0) settle();
    phases_.stop();
}

/// Grains come and go before the step; then the contacts as they were are returned, for the list has to be
/// made anew. Those of grains that went are not found again.
std::optional<std::vector<dem::ContactRecord>> GrainSimulation::exchange_grains() {
    if (!flow_.due(step_)) return {};
    show_accelerations();
    std::vector<dem::ContactRecord> contacts = records_of_contacts();
    const std::vector<dem::WallPose> poses = poses_at(time_);
    const GrainFlow::Change change = flow_.apply(
        grains_, {time_, step_, places_, setup_.walls, poses, setup_.held, clumps_, setup_.gravity});
    if (!change.any()) return {};
    clumps_.find_own_spheres(grains_);
    decomposition_.expect_change(change.added, change.removed);
    return contacts;
}

/// Looks whether the grains are quiet; time 0 begins once they have been for long enough.
void GrainSimulation::settle() {
    const GrainSettling& settling = *setup_.settling;
    if (step_ % settling.interval != 0) return;
    show_accelerations();
    const double imbalance = force_imbalance(comm_, grains_, setup_.held, clumps_, loaded_contacts());
    quiet_looks_ = imbalance <= settling.imbalance && !flow_.inserting(time_) ? quiet_looks_ + 1 : 0;
    if (quiet_looks_ >= settling.lasting) {
        notes_.push_back(fmt::format("{} grains settled in {} steps, {:.4g} s; forces balance to {:.2g}",
                                     totals().grains, step_, time_ + settling.longest, imbalance));
        time_ = 0;
        outdated_ = true;  // walls may set out
    } else if (time_ + static_cast<double>(settling.interval) * setup_.time_step >= 0) {
        throw AgreedError(1,
                          fmt::format("step {}: the grains have not settled within {} s: the rms force on a "
                                      "grain is {:.3g} of that of a contact (settle.imbalance = {}){}",
                                      step_, settling.longest, imbalance, settling.imbalance,
                                      flow_.inserting(time_) ? ", and sources are not done" : ""));
    }
}

void GrainSimulation::save_numbers(std::map<std::string, double>& numbers) const {
    flow_.save(numbers);
    if (time_ < 0) numbers["settle.quiet_looks"] = quiet_looks_;
}

std::vector<std::string> GrainSimulation::take_notes() {
    std::vector<std::string> notes = flow_.take_notes();
    notes.insert(notes.end(), notes_.begin(), notes_.end());
    notes_.clear();
    return notes;
}

/// Forces and torques of all contacts, those of own grains while copies are on their way.
void GrainSimulation::evaluate(double time_step) {
    phases_.enter(Phase::motion);
    std::size_t ready = 0;  // own grains
    const auto make_ready = [&](std::size_t end) {
        constexpr std::size_t together = 64;
        if (end <= ready) return;
        end = std::min((end + together - 1) / together * together, grains_.size());
        rows_.predict(grains_, sums_, time_step, ready, end);
        dem::begin_kick(grains_, sums_, time_step, ready, end);
        ready = end;
    };
    if (clumps_.exists() || shear_ || bonds_.in_use()) make_ready(grains_.size());
    if (ready == 0) rows_.predict(grains_, sums_, time_step, rows_halo_.sent_records());
    if (shear_) shear_->place_velocities(grains_, rows_);
    clumps_.predict(grains_, time_step, rows_, shear());
    if (bonds_.in_use()) {
        dem::keep_half_step(grains_);
        decomposition_.halo().begin(grains_,
                                    {&field::half_step_velocity, &field::half_step_angular_velocity});
        decomposition_.halo().finish();
    }
    phases_.enter(Phase::halo);
    rows_halo_.begin(rows_.values());
    phases_.enter(Phase::forces);
    const double approach = 2 * moved_ + negligible_gap();
    const dem::Evaluation evaluation{rows_, time_step, approach, sums_, largest_radius_, make_ready};
    refuse_overload(dem::evaluate_pairs(evaluation, setup_.laws, dem::Pairs::own, pairs_), false);
    make_ready(grains_.size());
    poses_ = poses_at(time_ + time_step);
    refuse_overload(at_walls_.evaluate(evaluation, setup_.laws, setup_.walls, poses_), true);
    phases_.enter(Phase::halo);
    rows_halo_.finish(rows_.values());
    if (shear_) shear_->move_copies(rows_);
    phases_.enter(Phase::forces);
    refuse_overload(dem::evaluate_pairs(evaluation, setup_.laws, dem::Pairs::with_copies, pairs_), false);
    if (bonds_.in_use()) refuse_bond(bonds_.evaluate(evaluation, grains_));
    evaluated_ += pairs_.contact_count() + at_walls_.touches().size();
    look_at_pressed_grains();
    if (!clumps_.exists()) return;
    clumps_.take_forces(grains_, sums_, units_);
    phases_.enter(Phase::halo);
    decomposition_.halo().begin(grains_, {&field::sphere_force, &field::sphere_torque});
    decomposition_.halo().finish();
}

void GrainSimulation::finish(double kick_step, const dem::Impulse& impulse) {
    phases_.enter(Phase::motion);
    dem::Impulse given = impulse;
    if (setup_.fluid_cells)
        for (int axis = 0; axis < 3; ++axis)
            given.steady[static_cast<std::size_t>(axis)] =
                grains_.data(coupling_field::fluid_acceleration, axis);
    const double of_spheres = dem::finish_step(grains_, sums_, responses_, setup_.gravity, given, kick_step,
                                               setup_.time_step, remaining_motion(kick_step));
    const dem::ClumpMotion::Path of_clumps =
        clumps_.finish_step(grains_, responses_, setup_.gravity, given, kick_step, setup_.time_step,
                            remaining_motion(kick_step), shear());
    double moved2 = std::max(of_spheres, of_clumps.moved2);
    // Two grains, or a grain and a wall, may each come nearer by half the skin before a pair is missing in
    // the list.
    const double allowed = 0.499 * setup_.skin;
    if (!std::isfinite(moved2)) refuse_not_finite();
    if (shear_) {
        const double listed = 2 * largest_radius_ + listed_gap();
        const double moved =
            std::sqrt(shear_->moved2(grains_, sums_, responses_.start, listed)) + of_clumps.bent;
        moved2 = moved * moved;
    }
    const bool walls_moved =
        walls_move() && at_walls_.displacement(poses_at(time_ + setup_.time_step)) > allowed;
    std::array<double, 3> greatest{moved2, walls_moved || bonds_.broken() ? 1.0 : 0.0,
                                   fault_.empty() ? 0.0 : 1.0};
    phases_.enter(Phase::wait);
    comm_.all_max(std::span<double>(greatest));
    moved_ = std::sqrt(greatest[0]);
    outdated_ = moved_ > allowed || greatest[1] > 0;
    if (greatest[2] > 0) comm_.all_agree(1, fault_);
}

/// Factor by which damping makes velocities smaller in a step, 1 once grains have settled.
double GrainSimulation::remaining_motion(double time_step) const {
    if (!setup_.settling || setup_.settling->damping == 0 || time_ >= 0) return 1;
    return std::exp(-time_step / setup_.settling->damping);
}

std::vector<dem::WallPose> GrainSimulation::poses_at(double time) const {
    std::vector<dem::WallPose> poses;
    for (const dem::Wall& wall : setup_.walls) poses.push_back(wall.motion.pose(time));
    return poses;
}

/// Whether any wall ever does.
bool GrainSimulation::walls_move() const {
    const auto moves = [](const dem::Wall& wall) {
        const dem::WallMotion& m = wall.motion;
        return norm(m.velocity) > 0 || norm(m.amplitude) > 0 || m.angular_velocity != 0 ||
               m.angle_amplitude != 0;
    };
    return std::any_of(setup_.walls.begin(), setup_.walls.end(), moves);
}

/// Brings grains back into the box and to their owners, contacts with them, and lists the pairs anew. `time`:
/// that of the positions [s].
void GrainSimulation::arrange(std::vector<dem::ContactRecord> records, double time) {
    phases_.enter(Phase::decompose);
    if (shear_) {
        clumps_.bring_centres_back(grains_, *shear_);
        shear_->bring_back(grains_);
        grid_->displace_images(shear_->offset());
    }
    show_accelerations();
    apply_boundaries(grains_, setup_.box);
    const auto interval = static_cast<std::uint64_t>(setup_.rebalance_interval);
    if (leader_) {
        decomposition_.follow(*leader_);
    } else if (interval > 0 && step_ >= last_balance_ + interval) {
        last_balance_ = step_;
        decomposition_.rebalance(work_of_cells(decomposition_.own_cells(), pairs_, at_walls_.touches()));
    }
    dem::follow_grains(comm_, decomposition_, *grid_, grains_, records);
    if (bonds_.in_use()) {
        std::vector<dem::BondRecord> bonds = bonds_.records();
        dem::follow_grains(comm_, decomposition_, *grid_, grains_, bonds);
        bonds_.adopt(bonds);
    }
    decomposition_.arrange(grains_, *grid_);
    const auto ids = std::as_const(grains_).own(field::id);
    std::copy(ids.begin(), ids.end(), grains_.data(field::copied_id));
    Halo& halo = decomposition_.halo();
    halo.begin(grains_, {&field::position, &field::radius, &field::mass, &field::body, &field::copied_id});
    halo.finish();
    describe_grains();
    list_contacts(records, time);
    if (const std::uint64_t alone = clumps_.find_spheres(grains_);
        alone != dem::ClumpMotion::everybody && fault_.empty())
        fault_ = fmt::format("step {}, time {} s: the clump of grain {} is torn apart", step_, time_, alone);
    moved_ = 0;
    ++lists_;
}

/// What follows from the order of grains: units of force, responses, places from which displacement counts.
void GrainSimulation::describe_grains() {
    const double *radius = grains_.data(field::radius), *mass = grains_.data(field::mass);
    const std::uint8_t* body = grains_.data(field::body);
    const std::size_t own = grains_.size(), all = grains_.size_with_halo();
    std::vector<double> units(all);
    for (std::size_t i = 0; i < all; ++i)
        units[i] = dem::force_unit(
            std::max(force_of_flat_grain(setup_.laws, setup_.material[body[i]], radius[i], mass[i]),
                     dem::greatest_bond_force(setup_.bonds, radius[i])));
    rows_.reset(grains_, units, setup_.material);
    if (clumps_.exists()) units_ = units;
    hide_accelerations();
    responses_.acceleration.resize(own);
    for (std::size_t i = 0; i < own; ++i)
        responses_.acceleration[i] =
            setup_.held[body[i]] || clumps_.of_body(body[i]) ? 0.0 : units[i] / mass[i];
    for (int axis = 0; axis < 3; ++axis) {
        const auto x = std::as_const(grains_).own(field::position, axis);
        responses_.start[static_cast<std::size_t>(axis)].assign(x.begin(), x.end());
    }
}

void GrainSimulation::list_contacts(const std::vector<dem::ContactRecord>& records, double time) {
    const std::size_t materials =
        std::visit([](const auto& table) { return table.pairs.materials(); }, setup_.laws);
    const auto in_clump = clumps_.inner_pairs(grains_);
    if (bonds_.in_use())
        if (const auto lost = bonds_.list(grains_))
            refuse_bond({dem::BondFault::stretched, lost->front(), lost->back()});
    const auto bonded = bonds_.pairs();
    dem::PairRule rule{.margin = listed_gap(),
                       .largest_radius = largest_radius_,
                       .material = setup_.material,
                       .held = setup_.held,
                       .materials = materials};
    if (in_clump || bonded)
        rule.left_out = [&](std::uint32_t i, std::uint32_t j) {
            return (in_clump && in_clump(i, j)) || (bonded && bonded(i, j));
        };
    dem::list_pairs(grains_, decomposition_.table(), rule, pairs_);
    const std::uint64_t* id = grains_.data(field::copied_id);
    const auto id_of = [id](std::uint32_t i) { return id[i]; };
    const dem::ContactRecordMap map(records);
    dem::restore_records(map, reach_ + negligible_gap(), id_of, id_of, pairs_);
    std::vector<std::uint8_t> needed = dem::copies_in(pairs_, grains_.size(), grains_.halo_size());
    bonds_.mark_copies(grains_.size(), needed);
    if (shear_) shear_->note_copies(grains_, needed);
    rows_halo_.choose(decomposition_.halo(), grains_.size(), needed);
    poses_ = poses_at(time);
    at_walls_.list(grains_, setup_.walls, poses_, rule);
    at_walls_.restore(records, grains_);
}

std::vector<dem::ContactRecord> GrainSimulation::records_of_contacts() const {
    return records_below(grains_.size_with_halo());
}

/// The contacts of the last evaluation whose first grain is stored below `end`.
std::vector<dem::ContactRecord> GrainSimulation::records_below(std::size_t end) const {
    const std::uint64_t* id = grains_.data(field::copied_id);
    const auto id_of = [id](std::uint32_t i) { return id[i]; };
    std::vector<dem::ContactRecord> records;
    dem::append_records(pairs_, end, id_of, id_of, records);
    at_walls_.append_records(grains_, records);
    return records;
}

ParticleSet GrainSimulation::save() {
    const std::string known_fault = fault_;  // of a state that is kept all the same
    arrange(records_of_contacts(), time_);
    outdated_ = true;
    phases_.stop();
    comm_.all_agree(fault_ == known_fault ? 0 : 1, fault_);
    show_accelerations();
    ParticleSet contacts = dem::empty_contacts(grains_.dimension(), history_fields(setup_));
    dem::save_pairs(records_below(grains_.size()), history_fields(setup_), contacts);
    return contacts;
}

ParticleSet GrainSimulation::saved_bonds() const {
    ParticleSet bonds = dem::empty_pairs("bonds", grains_.dimension(), dem::BondList::fields());
    dem::save_pairs(bonds_.records_below(grains_.size()), dem::BondList::fields(), bonds);
    return bonds;
}

double GrainSimulation::stable_step_of_bonds() const { return comm_.all_min(bonds_.stable_step(grains_)); }

void GrainSimulation::reset_counters() {
    evaluated_ = lists_ = 0;
    if (gravity_) gravity_->reset_counts();
    phases_ = {};
}

}  // namespace talus
