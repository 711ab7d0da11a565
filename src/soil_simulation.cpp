#include "src/soil_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/box.hpp"
#include "domain/soil_fields.hpp"
#include "physics/soil/node_density.hpp"
#include "src/step_support.hpp"

namespace talus {

namespace {

bool any_flows(const SoilSetup& setup) {
    return std::any_of(setup.materials.begin(), setup.materials.end(),
                       [](const soil::Material& material) { return material.flows(); });
}
bool any_cam_clay(const SoilSetup& setup) {
    return std::any_of(setup.materials.begin(), setup.materials.end(), [](const soil::Material& material) {
        return std::holds_alternative<soil::CamClay>(material.surface);
    });
}

}  // namespace

bool has_layers(const SoilSetup& setup) {
    return std::any_of(setup.materials.begin(), setup.materials.end(), [&](const soil::Material& material) {
        return material.density != setup.materials.front().density;
    });
}

void add_fields(ParticleSet& particles, const SoilSetup& setup) {
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &soil_field::grid, &soil_field::velocity, &soil_field::stress, &soil_field::displacement,
             &soil_field::faces, &soil_field::conditions, &field::mass, &field::body,
             &field::smoothing_length})
        particles.add(*info);
    if (setup.dimension < 3) particles.add(soil_field::lateral_stress);
    if (any_flows(setup)) {
        particles.add(soil_field::viscoplastic_strain);
        particles.add(soil_field::viscoplastic_work);
    }
    if (has_layers(setup)) particles.add(soil_field::volume);
    if (setup.moves) soil::add_moving_fields(particles, setup.stress_smoothing > 0);
    if (setup.saturated) soil::add_pore_fields(particles, setup.free_tight_faces);
    if (any_cam_clay(setup)) particles.add(soil_field::preconsolidation);
}

SoilSimulation::SoilSimulation(const Communicator& comm, SoilSetup setup, ParticleSet particles)
    : comm_(comm),
      setup_(std::move(setup)),
      particles_(std::move(particles)),
      decomposition_(comm, setup_.partition) {
    double fastest = 0;
    for (const soil::Material& material : setup_.materials)
        fastest = std::max(fastest, material.wave_speed());
    time_step_ = setup_.courant * setup_.spacing / fastest;
    double radius = 0;
    for (const double h : std::as_const(particles_).own(field::smoothing_length))
        radius = std::max(radius, (setup_.moves ? soil::moving_search_range : soil::search_range) * h);
    Box box;
    box.dimension = setup_.dimension;
    grid_ = std::make_unique<CellGrid>(box, comm_.all_max(radius), 1);
    if (setup_.saturated) pore_pressure_.emplace(comm_, decomposition_.halo());
    decomposition_.expect(particles_);
    decomposition_.divide(particles_, *grid_);
}

void SoilSimulation::arrange() {
    phases_.enter(Phase::decompose);
    decomposition_.arrange(particles_, *grid_);
    if (setup_.moves)
        soil::list_targets(particles_, decomposition_.table(), stencils_);
    else
        list_stencils();
    boundary_nodes_ = soil::list_boundary_nodes(particles_, stencils_, setup_.conditions, setup_.spacing);
    if (setup_.saturated) {
        free_axes_ = soil::list_free_axes(boundary_nodes_, setup_.conditions, stencils_, setup_.dimension,
                                          setup_.spacing);
        any_free_face_ = comm_.all_max(free_axes_.any_tight ? 1.0 : 0.0) > 0;
    }
    phases_.stop();
}

void SoilSimulation::list_stencils() {
    decomposition_.halo().begin(
        particles_, {&field::position, &field::smoothing_length, &soil_field::grid, &field::body});
    decomposition_.halo().finish();
    soil::build_stencils(particles_, decomposition_.table(), smooths(), stencils_);
    std::string message;
    if (stencils_.poor > 0)
        message = fmt::format(
            "step {}, time {} s: particle {} and {} more of this rank have too few neighbours of the other "
            "grid for a gradient; a body is thinner than two spacings there",
            step_, time_, stencils_.first_poor, stencils_.poor - 1);
    comm_.all_agree(1, message);
}

void SoilSimulation::start() {
    arrange();
    if (setup_.saturated) soil::impose_pore_pressures(particles_, boundary_nodes_, setup_.conditions, time_);
    if (setup_.free_tight_faces) soil::remember_pore_pressures(particles_);
    soil::impose_velocities(particles_, boundary_nodes_, setup_.conditions, time_);
    if (setup_.dimension == 1 && !setup_.moves)
        soil::impose_end_stress(particles_, boundary_nodes_, setup_.conditions, time_);
}

void SoilSimulation::resume(double time, std::uint64_t step) {
    time_ = time;
    step_ = step;
    arrange();
}

soil::StepSettings SoilSimulation::settings_now() const {
    soil::StepSettings settings{.time_step = time_step_,
                                .spacing = setup_.spacing,
                                .strength_factor = setup_.strength_factor(time_),
                                .damping = setup_.damping,
                                .hourglass = setup_.hourglass,
                                .stress_smoothing = setup_.stress_smoothing,
                                .materials = setup_.materials};
    const double gravity = setup_.gravity_factor(time_ + 0.5 * time_step_);
    for (std::size_t a = 0; a < 3; ++a) settings.body_force[a] = gravity * setup_.gravity[a];
    return settings;
}

void SoilSimulation::step() {
    const soil::StepSettings settings = settings_now();
    phases_.enter(Phase::material);
    const std::uint64_t too_fast = soil::apply_sources(particles_, stencils_, settings);
    if (setup_.moves)
        step_moving(settings);
    else
        step_at_rest(settings);
    pairs_ += stencils_.partner_count();
    refuse_what_broke(too_fast);
    if (setup_.moves) arrange();
    phases_.stop();
}

void SoilSimulation::step_moving(const soil::StepSettings& settings) {
    const CellTable& table = decomposition_.table();
    Halo& halo = decomposition_.halo();
    moving_memory_.volume.clear();
    overlapped(phases_, Phase::gradients, halo, particles_,
               {&field::position, &field::mass, &field::smoothing_length, &soil_field::grid,
                &soil_field::velocity, &soil_field::stress, &soil_field::lateral_stress},
               [&](Cells which) {
                   soil::predict_elements(particles_, table, which, settings, stencils_.to_elements);
               });
    overlapped(
        phases_, Phase::forces, halo, particles_,
        {&soil_field::velocity, &soil_field::nominal_stress, &soil_field::velocity_slope, &soil_field::volume,
         &soil_field::fit_weight, &soil_field::fit_centre, &soil_field::fit_inverse, &soil_field::stress_fit},
        [&](Cells which) {
            soil::accelerate_nodes(particles_, table, which, settings, stencils_.to_nodes, moving_memory_);
        });
    phases_.enter(Phase::motion);
    soil::apply_loads(particles_, boundary_nodes_, setup_.conditions, time_ + 0.5 * time_step_, settings);
    ++step_;
    time_ = static_cast<double>(step_) * time_step_;
    soil::impose_velocities(particles_, boundary_nodes_, setup_.conditions, time_);
    soil::centre_velocities(particles_, stencils_);
    overlapped(phases_, Phase::gradients, halo, particles_, {&soil_field::middle_velocity},
               [&](Cells which) { soil::measure_elements(particles_, which, stencils_.to_elements); });
    overlapped(phases_, Phase::material, halo, particles_,
               {&soil_field::velocity, &soil_field::velocity_slope}, [&](Cells which) {
                   soil::deform_nodes(particles_, which, settings, setup_.conditions, stencils_.to_nodes,
                                      moving_memory_);
               });
    phases_.enter(Phase::motion);
    soil::move_elements(particles_, stencils_.to_elements, time_step_);
}

void SoilSimulation::step_at_rest(const soil::StepSettings& settings) {
    overlapped(phases_, Phase::gradients, decomposition_.halo(), particles_,
               {&soil_field::velocity, &soil_field::stress, &soil_field::lateral_stress}, [&](Cells which) {
                   soil::advance_elements(particles_, stencils_.to_elements, which, settings);
               });
    soil::gather_tractions(boundary_nodes_, setup_.conditions, time_ + 0.5 * time_step_, stencils_,
                           setup_.dimension, memory_.tractions);
    phases_.enter(Phase::gradients);
    soil::gather_face_gradients(particles_, stencils_.face_gradients, memory_);
    if (smooths()) soil::gather_unseen(particles_, stencils_.unseen, settings, memory_);
    if (pore_pressure_) advance_pore_pressure(settings.body_force);
    overlapped(phases_, Phase::forces, decomposition_.halo(), particles_,
               {&soil_field::velocity, &soil_field::stress},
               [&](Cells which) { soil::advance_nodes(particles_, stencils_, which, settings, memory_); });
    phases_.enter(Phase::motion);
    ++step_;
    time_ = static_cast<double>(step_) * time_step_;
    soil::impose_velocities(particles_, boundary_nodes_, setup_.conditions, time_);
    soil::advance_face_stress(particles_, stencils_, settings, memory_);
    if (setup_.dimension == 1) soil::impose_end_stress(particles_, boundary_nodes_, setup_.conditions, time_);
    soil::displace(particles_, stencils_, time_step_);
}

void SoilSimulation::advance_pore_pressure(const std::array<double, 3>& body_force) {
    phases_.enter(Phase::pressure);
    const double yielding = setup_.free_tight_faces ? soil::FreeFaces::enough_yielding : 0;
    const soil::PorePressure::Settings settings{.time_step = time_step_,
                                                .spacing = setup_.spacing,
                                                .stabilisation = setup_.pressure_smoothing,
                                                .tolerance = setup_.pressure_tolerance,
                                                .materials = setup_.materials,
                                                .faces = {.any = any_free_face_,
                                                          .free_axes = free_axes_.of_row,
                                                          .memory = &memory_,
                                                          .hourglass = setup_.hourglass,
                                                          .body_force = body_force,
                                                          .extra_yielding = yielding}};
    const std::vector<std::uint32_t> imposed =
        soil::impose_pore_pressures(particles_, boundary_nodes_, setup_.conditions, time_ + time_step_);
    Halo& halo = decomposition_.halo();
    if (any_free_face_)
        halo.begin(particles_, {&soil_field::velocity, &soil_field::stress});
    else
        halo.begin(particles_, {&soil_field::velocity});
    halo.finish();
    try {
        pore_pressure_->advance(particles_, stencils_, imposed, settings);
    } catch (const AgreedError&) {
        refuse_what_broke(soil::no_id);  // a particle that is not finite says more
        throw;
    }
    halo.begin(particles_, {&soil_field::pore_pressure});
    halo.finish();
    soil::PorePressure::correct_elements(particles_, stencils_.to_elements, settings);
}

std::uint64_t SoilSimulation::first_runaway() const {
    constexpr double most = 10;  // waves' speeds: strains are long not small then
    const std::uint8_t* body = particles_.data(field::body);
    std::uint64_t first = soil::no_id;
    stencils_.for_each_node([&](std::uint32_t i) {
        double square = 0;
        for (int a = 0; a < setup_.dimension; ++a)
            square += std::pow(particles_.data(soil_field::velocity, a)[i], 2);
        if (square > std::pow(most * setup_.materials[body[i]].wave_speed(), 2))
            first = std::min(first, particles_.data(field::id)[i]);
    });
    return first;
}

void SoilSimulation::refuse_what_broke(std::uint64_t too_fast) {
    const NotFinite found = find_not_finite(particles_);
    const std::uint64_t not_finite = found.field ? found.id : soil::no_id, runaway = first_runaway();
    const std::uint64_t mine = std::min({not_finite, too_fast, runaway});
    phases_.enter(Phase::wait);
    const std::uint64_t first = comm_.all_min(mine);
    if (first == soil::no_id) return;
    std::string message;
    if (mine == first) {
        message = fmt::format("step {}, time {} s: ", step_, time_);
        if (first == not_finite)
            message += fmt::format("{} of particle {} in set '{}' is not finite", found.field->name, first,
                                   particles_.name());
        else if (first == too_fast)
            message += fmt::format(
                "the stress of particle {} returns to its yield surface too fast for "
                "10000 steps within {} s: choose a smaller 'fluidity' or 'exponent' in its "
                "material's table 'yield'",
                first, time_step_);
        else
            message += fmt::format(
                "particle {} moves at more than 10 times the speed of waves in it; the run "
                "has blown up, or the soil has failed",
                first);
    }
    comm_.all_agree(1, message);
}

void SoilSimulation::add_force(const soil::BoundaryNode& node, std::span<ExactSum> sums) const {
    const std::uint32_t i = node.index;
    soil::Tensor stress = soil::stress_at(particles_, i);
    if (setup_.saturated)
        for (std::size_t a = 0; a < 3; ++a) stress[a] -= particles_.data(soil_field::pore_pressure)[i];
    const double density = soil::NodeDensity(particles_, setup_.materials)[i];
    const double area = soil::face_area(particles_.data(field::mass)[i], density, setup_.spacing);
    constexpr int place[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    for (std::size_t c = 0; c < setup_.conditions.size(); ++c) {
        const soil::Face face = setup_.conditions[c].face;
        if (face < 0 || !(node.conditions >> c & 1)) continue;
        for (std::size_t b = 0; b < static_cast<std::size_t>(setup_.dimension); ++b)
            sums[3 * c + b].add(soil::outward(face) * area *
                                stress[static_cast<std::size_t>(place[soil::axis_of(face)][b])]);
    }
}

SoilTotals SoilSimulation::totals() const {
    enum Sum { mass, kinetic, elastic, plastic, px, py, pz, sum_count };
    std::vector<ExactSum> sums(sum_count + 3 * setup_.conditions.size());
    std::array<double, 5> extremes{};
    extremes[3] = extremes[4] = -std::numeric_limits<double>::infinity();
    const double* m = particles_.data(field::mass);
    const std::uint8_t* body = particles_.data(field::body);
    const soil::NodeDensity density(particles_, setup_.materials);
    const double* water = setup_.saturated ? particles_.data(soil_field::pore_pressure) : nullptr;
    const bool flows = particles_.has(soil_field::viscoplastic_strain);
    stencils_.for_each_node([&](std::uint32_t i) {
        double speed2 = 0, way2 = 0;
        for (int a = 0; a < setup_.dimension; ++a) {
            const double v = particles_.data(soil_field::velocity, a)[i];
            const double u = particles_.data(soil_field::displacement, a)[i];
            sums[static_cast<std::size_t>(px + a)].add(m[i] * v);
            speed2 += v * v;
            way2 += u * u;
        }
        const soil::Material& material = setup_.materials[body[i]];
        const double volume = m[i] / density[i];
        sums[mass].add(m[i]);
        sums[kinetic].add(0.5 * m[i] * speed2);
        sums[elastic].add(volume * material.elasticity.energy(soil::stress_at(particles_, i)));
        extremes[0] = std::max(extremes[0], std::sqrt(speed2));
        extremes[1] = std::max(extremes[1], std::sqrt(way2));
        if (water) {
            extremes[3] = std::max(extremes[3], -water[i]);
            extremes[4] = std::max(extremes[4], water[i]);
        }
        if (!flows) return;
        sums[plastic].add(volume * particles_.data(soil_field::viscoplastic_work)[i]);
        extremes[2] = std::max(extremes[2], particles_.data(soil_field::viscoplastic_strain)[i]);
    });
    for (const soil::BoundaryNode& node : boundary_nodes_)
        add_force(node, std::span<ExactSum>(sums).subspan(sum_count));
    ExactSum::all_reduce(comm_, sums);
    comm_.all_max(std::span<double>(extremes));
    SoilTotals totals{.mass = sums[mass].value(),
                      .kinetic_energy = sums[kinetic].value(),
                      .elastic_energy = sums[elastic].value(),
                      .viscoplastic_work = sums[plastic].value(),
                      .momentum = {sums[px].value(), sums[py].value(), sums[pz].value()},
                      .greatest_speed = extremes[0],
                      .greatest_displacement = extremes[1],
                      .greatest_viscoplastic_strain = extremes[2],
                      .least_pore_pressure = water ? -extremes[3] : 0,
                      .greatest_pore_pressure = water ? extremes[4] : 0,
                      .forces = {}};
    for (std::size_t c = 0; c < setup_.conditions.size(); ++c)
        totals.forces.push_back({sums[sum_count + 3 * c].value(), sums[sum_count + 3 * c + 1].value(),
                                 sums[sum_count + 3 * c + 2].value()});
    return totals;
}

}  // namespace talus
