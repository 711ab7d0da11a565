#include "src/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/boundary.hpp"
#include "physics/sph/pass_support.hpp"
#include "src/step_support.hpp"

namespace talus {

namespace {
constexpr double pairs_worth_a_particle = 20;  // what costs the same as all but pairs: docs/decisions/012

bool has_strength(const Setup& setup) {
    return std::any_of(setup.materials.begin(), setup.materials.end(),
                       [](const Material& material) { return material.shear_modulus > 0; });
}
bool has_fracture(const Setup& setup) {
    return std::any_of(setup.materials.begin(), setup.materials.end(),
                       [](const Material& material) { return material.fracture.has_value(); });
}
}  // namespace

std::vector<NeededField> needed_fields(const Setup& setup) {
    std::vector<NeededField> needed;
    const auto need = [&](std::string_view model, std::initializer_list<const FieldInfo*> fields) {
        for (const FieldInfo* info : fields) needed.push_back({info, model});
    };
    const sph::Settings& sph = setup.sph;
    const bool continuity = sph.density == sph::DensityMethod::continuity;
    const bool godunov = sph.formulation == sph::Formulation::godunov;
    need("SPH", {&field::velocity, &field::mass, &field::internal_energy, &field::smoothing_length,
                 &field::body, &field::acceleration, &field::specific_power, &field::predicted_velocity,
                 &field::predicted_energy, &field::predicted_density, &field::pressure, &field::sound_speed});
    if (continuity) need("density by continuity", {&field::density});
    if (godunov)
        need("Godunov SPH", {&field::velocity_gradient, &field::pressure_gradient, &field::volume_gradient});
    else if (continuity)
        need("density by continuity", {&field::velocity_gradient});
    if (sph.variable_smoothing_length) need("variable smoothing length", {&field::next_smoothing_length});
    if (!godunov) need("artificial viscosity", {&field::viscous_speed});
    if (sph.uses(sph::Interpolation::quintic)) need("quintic interpolation", {&field::volume_curvature});
    if (setup.gravity) need("self-gravity", {&field::gravity_acceleration, &field::gravity_potential});
    if (has_strength(setup)) need("strength", {&field::deviatoric_stress, &field::predicted_stress});
    if (has_fracture(setup))
        need("fracture", {&field::damage, &field::flaw_threshold, &field::flaw_exponent, &field::flaw_count});
    const auto any_plasticity = [&](auto&& asks) {
        return std::any_of(setup.materials.begin(), setup.materials.end(), [&](const Material& material) {
            return material.plasticity && std::visit(asks, *material.plasticity);
        });
    };
    if (any_plasticity([](const auto& model) { return model.keeps_volume_strain(); }))
        need("plastic volume strain", {&field::plastic_volume_strain});
    if (any_plasticity([](const auto& model) { return model.softens(); }))
        need("softening", {&field::plastic_shear_strain});
    return needed;
}

void add_fields(ParticleSet& particles, const Setup& setup) {
    for (const NeededField& needed : needed_fields(setup)) particles.add(*needed.info);
}

Simulation::Simulation(const Communicator& comm, Setup setup, ParticleSet particles)
    : comm_(comm),
      setup_(std::move(setup)),
      particles_(std::move(particles)),
      decomposition_(comm, setup_.partition) {
    for (std::size_t b = 0; b < setup_.materials.size(); ++b) {
        constants_.shear_modulus.push_back(setup_.materials[b].shear_modulus);
        const bool falls = !is_wall(b) && (setup_.held.empty() || !setup_.held[b]);
        if (setup_.even_gravity)
            constants_.gravity.push_back(falls ? *setup_.even_gravity : std::array<double, 3>{});
    }
    if (setup_.gravity) gravity_.emplace(comm_, *setup_.gravity, setup_.sph);
    decomposition_.expect(particles_);
    const auto h = std::as_const(particles_).own(field::smoothing_length);
    const auto [least, greatest] = std::minmax_element(h.begin(), h.end());
    const double infinity = std::numeric_limits<double>::infinity();
    setup_.sph.uniform_smoothing_length =
        !setup_.sph.variable_smoothing_length &&
        comm_.all_min(h.empty() ? infinity : *least) == comm_.all_max(h.empty() ? -infinity : *greatest);
}

double Simulation::interaction_radius() const {
    double largest = 0;
    for (const double h : particles_.own(field::smoothing_length)) largest = std::max(largest, h);
    return comm_.all_max(largest) * range_of_interaction();
}

double Simulation::work() const {
    return std::accumulate(pass_count_.work_of_cell.begin(), pass_count_.work_of_cell.end(), 0.0);
}

double Simulation::range_of_interaction() const {
    return std::max(setup_.sph.force_support(), setup_.sph.kernel_support() * setup_.sph.smoothing_widening);
}

void Simulation::arrange() {
    const bool varies = setup_.sph.variable_smoothing_length;
    if ((!grid_.exists() || varies) && grid_.fit(setup_.box, interaction_radius(), varies))
        decomposition_.divide(particles_, *grid_);
    decomposition_.arrange(particles_, *grid_);
}

void Simulation::rebalance() {
    const auto interval = static_cast<std::uint64_t>(setup_.rebalance_interval);
    if (work_measured_ && interval > 0 && step_ % interval == 0)
        decomposition_.rebalance(pass_count_.work_of_cell);
}

/// The state that a step leaves is the one that is softened, so that a checkpoint holds it.
void Simulation::enter_late_phase_when_due() {
    if (!setup_.late_phase || in_late_phase_ || time_ < setup_.late_phase->from) return;
    const std::vector<Material> before = setup_.materials;
    soften_materials();
    const auto body = std::as_const(particles_).own(field::body);
    std::uint64_t clipped = 0, first_id = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t b = 0; b < before.size(); ++b) {
        const auto places = keep_pressure(before[b].eos, setup_.materials[b].eos,
                                          std::as_const(particles_).own(field::internal_energy),
                                          particles_.own(field::density), body, static_cast<std::uint8_t>(b));
        clipped += places.size();
        for (const std::size_t i : places) first_id = std::min(first_id, particles_.data(field::id)[i]);
    }
    clipped_ = {comm_.all_sum(clipped), comm_.all_min(first_id)};
}

void Simulation::soften_materials() {
    in_late_phase_ = true;
    for (std::size_t b = 0; b < setup_.materials.size(); ++b) {
        setup_.materials[b] = softened(setup_.materials[b], setup_.late_phase->stiffness);
        constants_.shear_modulus[b] = setup_.materials[b].shear_modulus;
    }
}

void Simulation::start() {
    enter_late_phase_when_due();
    arrange();
    evaluate(0, 0);
    conclude_step();
    time_step_ = std::min(time_step_, setup_.first_time_step);
}

void Simulation::resume(double time, double time_step, std::uint64_t step, bool in_late_phase) {
    time_ = time;
    time_step_ = time_step;
    step_ = step;
    if (in_late_phase)
        soften_materials();
    else
        enter_late_phase_when_due();
    arrange();
}

void Simulation::step() {
    const double dt = time_step_;
    phases_.enter(Phase::motion);
    sph::kick(particles_, constants_, setup_.sph, dt / 2);
    sph::move_walls(particles_, walls_at(time_ + dt / 2));
    sph::drift(particles_, dt);
    apply_boundaries(particles_, setup_.box);
    phases_.enter(Phase::decompose);
    rebalance();
    arrange();
    evaluate(dt / 2, dt);
    phases_.enter(Phase::motion);
    sph::kick(particles_, constants_, setup_.sph, dt / 2);
    time_ += dt;
    ++step_;
    conclude_step();
    enter_late_phase_when_due();
    phases_.stop();
}

/// Everything that follows from positions and the predicted state: density, pressure, gradients, forces. Each
/// pass first visits the cells that need no copies, while those are on their way.
void Simulation::evaluate(double time_ahead, double elapsed) {
    const sph::Settings& settings = setup_.sph;
    const CellTable& table = decomposition_.table();
    Halo& halo = decomposition_.halo();
    const auto refreshed = [&](Phase phase, std::initializer_list<const FieldInfo*> fields, auto&& pass) {
        overlapped(phases_, phase, halo, particles_, fields, pass);
    };

    phases_.enter(Phase::motion);
    sph::predict(particles_, constants_, setup_.sph, time_ahead);
    if (settings.density == sph::DensityMethod::summation || settings.variable_smoothing_length) {
        refreshed(Phase::density, {&field::position, &field::mass},
                  [&](Cells cells) { sph::density_pass(particles_, table, cells, settings); });
        if (settings.variable_smoothing_length) {
            const double most = grid_->covered_radius() / range_of_interaction();
            double* h = particles_.data(field::smoothing_length);
            for (const double next : particles_.own(field::next_smoothing_length))
                *h++ = std::min(next, most);
        }
    }
    phases_.enter(Phase::material);
    material_response(time_ahead, elapsed);
    const std::vector<sph::WallNow> walls = walls_at(time_ + elapsed);
    if (!walls.empty()) extrapolate_into_walls(walls);
    if (particles_.has(field::velocity_gradient))
        refreshed(Phase::gradients,
                  {&field::position, &field::mass, &field::smoothing_length, &field::body,
                   &field::predicted_velocity, &field::predicted_density, &field::pressure,
                   &field::sound_speed, &field::predicted_stress},
                  [&](Cells cells) { sph::gradient_pass(particles_, table, cells, settings); });
    if (particles_.has(field::volume_curvature))
        refreshed(Phase::gradients, {&field::volume_gradient},
                  [&](Cells cells) { sph::curvature_pass(particles_, table, cells, settings); });

    pass_count_.pairs = 0;
    pass_count_.work_of_cell.assign(decomposition_.own_cells().size(), 0.0);
    if (settings.formulation == sph::Formulation::godunov)
        refreshed(Phase::forces,
                  {&field::velocity_gradient, &field::pressure_gradient, &field::volume_gradient,
                   &field::volume_curvature},
                  [&](Cells cells) { sph::godunov_pass(particles_, table, cells, settings, pass_count_); });
    else
        refreshed(
            Phase::forces,
            {&field::position, &field::mass, &field::smoothing_length, &field::predicted_velocity,
             &field::predicted_density, &field::pressure, &field::sound_speed, &field::predicted_stress},
            [&](Cells cells) { sph::standard_pass(particles_, table, cells, settings, pass_count_); });
    if (gravity_) {
        phases_.enter(Phase::gravity);
        gravity_->evaluate(particles_, *grid_, decomposition_, pass_count_.work_of_cell);
    }
    const std::span<const CellEntry> cells = decomposition_.own_cells();
    for (std::size_t k = 0; k < cells.size(); ++k)
        pass_count_.work_of_cell[k] += pairs_worth_a_particle * (cells[k].end - cells[k].begin);
    hold_bodies();
    sph::keep_walls(particles_, walls);
    pairs_ += pass_count_.pairs;
    work_measured_ = true;
}

/// Pressure and sound speed, the limit of strength or the return of plastic stress, growth of damage over the
/// `elapsed` time since the last evaluation, and what damage leaves of tension and shear.
void Simulation::material_response(double time_ahead, double elapsed) {
    damage_limit_ = std::numeric_limits<double>::infinity();
    const auto bodies = std::as_const(particles_).own(field::body);
    const auto energy = std::as_const(particles_).own(field::predicted_energy);
    const auto density = std::as_const(particles_).own(field::predicted_density);
    const auto pressure = particles_.own(field::pressure), sound = particles_.own(field::sound_speed);
    const bool cracks = particles_.has(field::damage);
    std::span<const double> damage;
    if (cracks) damage = particles_.own(field::damage);
    for (std::size_t b = 0; b < setup_.materials.size(); ++b) {
        const Material& material = setup_.materials[b];
        const auto body = static_cast<std::uint8_t>(b);
        talus::evaluate(material.eos, density, energy, pressure, sound, bodies, body);
        if (std::isfinite(material.least_pressure))
            for (std::size_t i = 0; i < pressure.size(); ++i)
                if (bodies[i] == body) pressure[i] = std::max(pressure[i], material.least_pressure);
        if (material.plasticity) return_plastic_stress(body, time_ahead, elapsed);
        if (material.shear_modulus > 0 && !material.plasticity) {
            const StrengthState state{pressure, energy, damage};
            limit_stress(material.strength, state, stress_columns(particles_, field::predicted_stress),
                         bodies, body);
            limit_stress(material.strength, state, stress_columns(particles_, field::deviatoric_stress),
                         bodies, body);
        }
        if (!material.fracture) continue;
        const FractureState state{{particles_.own(field::flaw_threshold),
                                   particles_.own(field::flaw_exponent), particles_.own(field::flaw_count)},
                                  pressure,
                                  stress_columns(std::as_const(particles_), field::predicted_stress),
                                  particles_.own(field::smoothing_length),
                                  setup_.sph.kernel_support()};
        const CrackGrowth growth = material.crack_growth();
        grow_damage(growth, state, elapsed, particles_.own(field::damage), bodies, body);
        damage_limit_ = std::min(
            damage_limit_, damage_time_step(growth, state, setup_.largest_damage_step, damage, bodies, body));
        relieve_stress(material.strength, damage, pressure,
                       stress_columns(particles_, field::predicted_stress), bodies, body);
    }
}

/// Plastic strains are those of the stored state; the predicted one is `time_ahead` of it.
void Simulation::return_plastic_stress(std::uint8_t body, double time_ahead, double elapsed) {
    const Material& material = setup_.materials[body];
    const auto bodies = std::as_const(particles_).own(field::body);
    const auto [opens, softens] = std::visit(
        [](const auto& model) {
            return std::pair{model.keeps_volume_strain(), model.softens()};
        },
        *material.plasticity);
    std::span<double> volume_strain, shear_strain;
    if (opens) volume_strain = particles_.own(field::plastic_volume_strain);
    if (softens) shear_strain = particles_.own(field::plastic_shear_strain);
    const PlasticState stored{particles_.own(field::density),
                              stress_columns(particles_, field::deviatoric_stress), volume_strain,
                              shear_strain},
        predicted{particles_.own(field::predicted_density),
                  stress_columns(particles_, field::predicted_stress), volume_strain, shear_strain};
    return_stress(*material.plasticity, material.elasticity(), stored, elapsed, true, {}, bodies, body);
    return_stress(*material.plasticity, material.elasticity(), predicted, elapsed + time_ahead, false,
                  particles_.own(field::pressure), bodies, body);
}

std::vector<sph::WallNow> Simulation::walls_at(double time) const {
    const auto g = setup_.even_gravity.value_or(std::array<double, 3>{});
    std::vector<sph::WallNow> walls(setup_.walls.size());
    for (std::size_t b = 0; b < walls.size(); ++b)
        if (setup_.walls[b]) walls[b] = sph::at_time(*setup_.walls[b], time, {g[0], g[1], g[2]});
    return walls;
}

/// Wall particles take what is in front of them, whose copies they need, before copies of theirs are made.
void Simulation::extrapolate_into_walls(std::span<const sph::WallNow> walls) {
    phases_.enter(Phase::halo);
    Halo& halo = decomposition_.halo();
    halo.begin(particles_,
               {&field::position, &field::smoothing_length, &field::body, &field::predicted_velocity,
                &field::predicted_density, &field::pressure, &field::predicted_stress});
    halo.finish();
    phases_.enter(Phase::gradients);
    sph::wall_pass(particles_, decomposition_.table(), Cells::all, setup_.sph, walls);
}

void Simulation::hold_bodies() {
    if (std::find(setup_.held.begin(), setup_.held.end(), true) == setup_.held.end()) return;
    const std::uint8_t* body = particles_.data(field::body);
    for (int axis = 0; axis < particles_.dimension(); ++axis) {
        double *a = particles_.data(field::acceleration, axis), *v = particles_.data(field::velocity, axis);
        for (std::size_t i = 0; i < particles_.size(); ++i)
            if (setup_.held[body[i]]) a[i] = v[i] = 0;
        if (!gravity_) continue;
        double* g = particles_.data(field::gravity_acceleration, axis);
        for (std::size_t i = 0; i < particles_.size(); ++i)
            if (setup_.held[body[i]]) g[i] = 0;
    }
    double* power = particles_.data(field::specific_power);
    for (std::size_t i = 0; i < particles_.size(); ++i)
        if (setup_.held[body[i]]) power[i] = 0;
}

/// Agrees on the next time step, and that the state is finite: one reduction for both.
void Simulation::conclude_step() {
    limit_ = sph::stable_time_step(particles_, constants_, setup_.sph);
    if (damage_limit_ < limit_.time_step) limit_ = {damage_limit_, limit_.id, "damage growth"};
    if (gravity_) {
        const sph::StepLimit by_gravity = gravity::stable_time_step(particles_, *setup_.gravity);
        if (by_gravity.time_step < limit_.time_step) limit_ = by_gravity;
    }
    phases_.enter(Phase::wait);
    time_step_ = agreed_time_step(comm_, particles_, {time_, step_}, limit_);
}

}  // namespace talus
