#include "src/water_simulation.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "domain/boundary.hpp"
#include "domain/coupling_fields.hpp"
#include "domain/water_fields.hpp"
#include "physics/water/wall_forces.hpp"
#include "src/step_support.hpp"

namespace talus {

namespace {
constexpr double pairs_worth_a_particle = 40;  // what costs the same as all but pairs
constexpr int cells_per_radius = 1;            // docs/decisions/022
}  // namespace

WaterSimulation::WaterSimulation(const Communicator& comm, WaterSetup setup, ParticleSet particles)
    : comm_(comm),
      setup_(std::move(setup)),
      particles_(std::move(particles)),
      decomposition_(comm, setup_.partition) {
    decomposition_.expect(particles_);
    if (!setup_.open.buffers.empty()) open_ = std::make_unique<OpenBoundaries>(comm_, setup_.open);
    if (!setup_.rigid.bodies.empty())
        rigid_ = std::make_unique<RigidBodies>(comm_, setup_.rigid, setup_.box, setup_.settings);
}

void WaterSimulation::add_fields(ParticleSet& particles, const WaterSetup& setup) {
    if (setup.holds_grains)
        for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
                 &field::predicted_velocity, &coupling_field::quadrature_volume,
                 &coupling_field::solid_fraction, &coupling_field::pair_acceleration,
                 &coupling_field::grain_acceleration})
            particles.add(*info);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::mass, &field::density, &field::body, &field::acceleration,
             &water_field::density_rate, &field::pressure, &water_field::partner_velocity,
             &water_field::partner_volume, &water_field::partner_pressure, &water_field::partner_density})
        particles.add(*info);
    if (!setup.records_force.empty()) particles.add(water_field::wall_force);
    if (setup.settings.rheology) {
        particles.add(water_field::viscosity);
        particles.add(water_field::partner_viscosity);
        particles.add(water_field::partner_gradient);
    }
    if (setup.settings.shifting > 0) particles.add(water_field::shift_velocity);
    if (!setup.rigid.bodies.empty()) RigidBodies::add_fields(particles);
}

double WaterSimulation::work() const {
    return std::accumulate(pass_count_.work_of_cell.begin(), pass_count_.work_of_cell.end(), 0.0);
}

CellGrid WaterSimulation::cells(const WaterSetup& setup) {
    return {setup.box, setup.settings.radius(), cells_per_radius};
}

void WaterSimulation::arrange() {
    if (!grid_) {
        grid_ = std::make_unique<CellGrid>(cells(setup_));
        decomposition_.divide(particles_, *grid_);
    }
    decomposition_.arrange(particles_, *grid_);
}

void WaterSimulation::start() {
    if (open_) open_->begin(particles_);
    if (rigid_) rigid_->place(particles_, 0);
    arrange();
    evaluate(0, 0);
    if (open_) open_->look(seeing_);
    conclude_step();
}

void WaterSimulation::resume(double time, double time_step, std::uint64_t step,
                             const std::map<std::string, double>& numbers) {
    if (open_) open_->restore(numbers, particles_);
    time_ = time;
    time_step_ = time_step;
    step_ = step;
    arrange();
}

void WaterSimulation::step() {
    const double dt = time_step_;
    phases_.enter(Phase::motion);
    water::kick(particles_, dt / 2);
    sph::move_walls(particles_, walls_at(time_ + dt / 2));
    sph::drift(particles_, dt);
    water::shift(particles_, dt);
    if (rigid_) {
        rigid_->kick(dt / 2);
        rigid_->move(time_, dt);
        rigid_->place(particles_, dt / 2);
    }
    apply_boundaries(particles_, setup_.box);
    if (open_) pass_open_ends();
    phases_.enter(Phase::decompose);
    const auto interval = static_cast<std::uint64_t>(setup_.rebalance_interval);
    if (work_measured_ && interval > 0 && step_ % interval == 0)
        decomposition_.rebalance(pass_count_.work_of_cell);
    arrange();
    evaluate(dt / 2, time_ + dt);
    phases_.enter(Phase::motion);
    water::kick(particles_, dt / 2);
    if (rigid_) rigid_->kick(dt / 2);
    time_ += dt;
    ++step_;
    conclude_step();
    phases_.stop();
}

void WaterSimulation::pass_open_ends() {
    const OpenBoundaries::Change change = open_->apply(particles_, setup_.settings, time_);
    if (change.added.count() + change.removed.count() > 0)
        decomposition_.expect_change(change.added, change.removed);
}

/// Everything that follows from positions, velocities and densities at `time`, `time_ahead` of the state.
void WaterSimulation::evaluate(double time_ahead, double time) {
    if (before_evaluation_) before_evaluation_(time);
    const water::Settings& settings = setup_.settings;
    const CellTable& table = decomposition_.table();
    Halo& halo = decomposition_.halo();
    const std::vector<sph::WallNow> walls = walls_at(time);
    phases_.enter(Phase::material);
    water::prepare_partners(particles_, settings, walls, time_ahead);
    const std::initializer_list<const FieldInfo*> partners = {
        &field::position, &water_field::partner_velocity, &water_field::partner_volume,
        &water_field::partner_pressure, &water_field::partner_density};
    if (open_) water::prepare_buffers(particles_, setup_.open.buffers);
    if (!walls.empty() || open_) {  // which see the water's copies before copies of theirs are made
        phases_.enter(Phase::halo);
        halo.begin(particles_, partners);
        halo.finish();
        phases_.enter(Phase::gradients);
        if (!walls.empty()) water::wall_pass(particles_, table, Cells::all, settings, walls);
        if (open_) seeing_ = water::buffer_pass(particles_, table, settings, setup_.open.buffers);
    }
    pass_count_.pairs = 0;
    pass_count_.work_of_cell.assign(decomposition_.own_cells().size(), 0.0);
    const auto forces = [&](Cells cells) {
        water::force_pass(particles_, table, cells, settings, pass_count_);
    };
    if (settings.rheology) {  // which sees the walls' copies, too, before forces see what viscosity follows
        overlapped(phases_, Phase::gradients, halo, particles_, partners,
                   [&](Cells cells) { water::rate_pass(particles_, table, cells, settings); });
        overlapped(phases_, Phase::forces, halo, particles_,
                   {&water_field::partner_viscosity, &water_field::partner_gradient}, forces);
    } else {
        overlapped(phases_, Phase::forces, halo, particles_, partners, forces);
    }
    const std::span<const CellEntry> cells = decomposition_.own_cells();
    for (std::size_t k = 0; k < cells.size(); ++k)
        pass_count_.work_of_cell[k] += pairs_worth_a_particle * (cells[k].end - cells[k].begin);
    sph::move_walls(particles_, walls);
    if (rigid_) {
        water::find_wall_forces(particles_, table, settings, rigid_->feels());
        rigid_->take_forces(particles_);
    }
    pairs_ += pass_count_.pairs;
    work_measured_ = true;
}

std::vector<sph::WallNow> WaterSimulation::walls_at(double time) const {
    const auto& g = setup_.settings.gravity;
    std::vector<sph::WallNow> walls(setup_.walls.size());
    for (std::size_t b = 0; b < walls.size(); ++b)
        if (setup_.walls[b]) walls[b] = sph::at_time(*setup_.walls[b], time, {g[0], g[1], g[2]});
    if (rigid_) rigid_->complete(walls);
    return walls;
}

/// Agrees on the next time step, and that the state is finite: one reduction for both.
void WaterSimulation::conclude_step() {
    limit_ = water::stable_time_step(particles_, setup_.settings);
    if (rigid_ && rigid_->step_limit().time_step < limit_.time_step) limit_ = rigid_->step_limit();
    phases_.enter(Phase::wait);
    time_step_ = agreed_time_step(comm_, particles_, {time_, step_}, limit_);
}

}  // namespace talus
