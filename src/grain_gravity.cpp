#include "src/grain_gravity.hpp"

#include "domain/clump_fields.hpp"
#include "domain/fields.hpp"

namespace talus {

namespace {

/// Of the kernels' mass all but 1e-16 lies within 0.99 of this one's reach: light contacts soften nothing.
sph::Settings softening_kernel() {
    sph::Settings settings;
    settings.formulation = sph::Formulation::standard;
    settings.kernel = sph::KernelKind::wendland_c6;
    return settings;
}

/// Softening ends at half the support times the sum of both lengths, which is the sum of radii.
gravity::Settings of_spheres(gravity::Settings settings, bool clumps) {
    if (clumps) settings.mass_field = &field::attracting_mass;
    settings.softening_field = &field::radius;
    settings.softening_factor = 2 / softening_kernel().kernel_support();
    return settings;
}

}  // namespace

GrainGravity::GrainGravity(const Communicator& comm, const SelfGravity& plan, double time_step,
                           const dem::ClumpMotion& clumps)
    : plan_(plan),
      half_block_(0.5 * plan.interval * time_step),
      clumps_(clumps),
      gravity_(comm, of_spheres(plan.settings, clumps.exists()), softening_kernel()) {}

void GrainGravity::add_fields(ParticleSet& grains) {
    grains.add(field::gravity_acceleration);
    grains.add(field::gravity_potential);
}

dem::Impulse GrainGravity::start(ParticleSet& grains, const CellGrid& grid, Decomposition& decomposition) {
    if (clumps_.exists()) clumps_.share_masses(grains);
    return evaluate(grains, grid, decomposition, 0);
}

/// To the copies, for all that own a sphere of a clump to move the whole of it.
void GrainGravity::share_attraction(ParticleSet& grains, Decomposition& decomposition) const {
    if (!clumps_.exists()) return;
    clumps_.take_attraction(grains);
    decomposition.halo().begin(grains, {&field::sphere_attraction});
    decomposition.halo().finish();
}

void GrainGravity::begin_step(ParticleSet& grains, const dem::Responses& responses,
                              Decomposition& decomposition) const {
    if (!is_synchronous()) return;
    share_attraction(grains, decomposition);
    if (clumps_.exists()) clumps_.kick_by_attraction(grains, half_block_);
    for (int axis = 0; axis < 3; ++axis) {
        double* v = grains.data(field::velocity, axis);
        const double* g = grains.data(field::gravity_acceleration, axis);
        for (std::size_t i = 0; i < grains.size(); ++i)
            if (responses.acceleration[i] > 0) v[i] += half_block_ * g[i];
    }
}

dem::Impulse GrainGravity::end_step(ParticleSet& grains, const CellGrid& grid, Decomposition& decomposition) {
    if (++steps_in_block_ < plan_.interval) return {};
    steps_in_block_ = 0;
    return evaluate(grains, grid, decomposition, half_block_);
}

dem::Impulse GrainGravity::evaluate(ParticleSet& grains, const CellGrid& grid, Decomposition& decomposition,
                                    double now) {
    work_of_cell_.assign(decomposition.own_cells().size(), 0.0);
    gravity_.evaluate(grains, grid, decomposition, work_of_cell_);
    share_attraction(grains, decomposition);
    dem::Impulse impulse{{}, now, half_block_};
    for (int axis = 0; axis < 3; ++axis)
        impulse.acceleration[static_cast<std::size_t>(axis)] = grains.data(field::gravity_acceleration, axis);
    return impulse;
}

}  // namespace talus
