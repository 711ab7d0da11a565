#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "physics/gravity/gravity.hpp"

namespace talus::test {

/// A cloud of particles at random places, arranged on the ranks of `comm`, and its gravity.
///   sphere: filled evenly, radius 1; pair: two such spheres, of equal density, 4 apart; clumps: half of them
///   in five small spheres within one; ejecta: a sphere, and one in fifty up to 1e3 away.
class GravityCloud {
  public:
    GravityCloud(const Communicator& comm, const std::string& kind, std::size_t count,
                 PartitionMethod method = PartitionMethod::metis);

    /// Fills the fields of gravity. Those of the last evaluation serve Opening::relative. Collective.
    gravity::Counts evaluate(const gravity::Settings& settings);

    /// Of all particles in the order of ids, on every rank. Collective.
    struct Forces {
        std::vector<double> mass;
        std::vector<std::array<double, 3>> acceleration;
        std::vector<double> potential;
    };
    Forces forces() const;

    const Communicator& comm;
    ParticleSet particles;
    sph::Settings sph;
    std::unique_ptr<CellGrid> grid;
    Decomposition decomposition;
};

/// Against the exact accelerations: root mean square and greatest error over the mean acceleration, and the
/// sum of the forces over the sum of their sizes.
struct GravityError {
    double rms, greatest, drift, rms_potential;
};
GravityError error_of(const GravityCloud::Forces& found, const GravityCloud::Forces& exact);

}  // namespace talus::test
