#pragma once
#include <vector>

#include "physics/dem/laws/materials.hpp"
#include "src/grain_simulation.hpp"

namespace talus::test {

/// One grain of a test.
struct GrainState {
    dem::Vector3<> position, velocity, angular_velocity;  ///< [m], [m/s], [rad/s]
    double radius;                                        ///< [m]
    double density;                                       ///< [kg/m3]
    std::uint8_t body = 0;
};

double mass_of(const GrainState& grain);

/// A Hertzian law of all pairs of materials, restitution taken as may_attract.
dem::AnyLawTable hertz_table(const std::vector<dem::GrainMaterial>& materials);

/// The linear law of one material, restitution taken as may_attract. `stiffness` [N/m], two sevenths of it
/// across.
dem::AnyLawTable linear_table(const dem::GrainMaterial& material, double stiffness);

/// A scene without walls, gravity or boundaries: one body for each material. The skin is a tenth of the
/// radius.
GrainSetup grain_setup(const std::vector<dem::GrainMaterial>& materials, double radius, double time_step);

/// The grains, ids in order; rank r gets those with k mod size = r.
ParticleSet grain_set(const Communicator& comm, const std::vector<GrainState>& grains);

/// Clumps of the setup's first body, ids in order; rank r gets the spheres with id mod size = r.
ParticleSet clump_set(const Communicator& comm, const GrainSetup& setup,
                      const std::vector<dem::ClumpState>& clumps);

/// State of the grain with this id, which must be on this rank.
GrainState state_of(const GrainSimulation& simulation, std::uint64_t id);
/// State of the clump of this sphere, likewise.
dem::ClumpState clump_of(const GrainSimulation& simulation, std::uint64_t id);

}  // namespace talus::test
