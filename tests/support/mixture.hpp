#pragma once
#include <array>
#include <initializer_list>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/coupling_fields.hpp"
#include "physics/coupling/passes.hpp"

namespace talus::test {

/// One grain of a MixtureSample.
struct PlacedSphere {
    std::array<double, 3> place;  ///< [m]
    double radius;                ///< [m]
};

/// Fluid on the points of a lattice in a box, and grains among it, arranged for the passes of the coupling on
/// the ranks of MPI_COMM_WORLD.
class MixtureSample {
  public:
    struct Choice {
        Box box;            ///< filled with fluid
        double spacing;     ///< of the fluid [m]
        double jitter = 0;  ///< random displacement along each axis, at most, in spacings [1]
        PartitionMethod method = PartitionMethod::slabs;
        coupling::Spreading spreading{};
        MPI_Comm ranks = MPI_COMM_WORLD;
    };
    MixtureSample(const Choice& choice, const std::vector<PlacedSphere>& spheres);

    coupling::Mixture mixture() {
        return {grains, grain_cells.table(), fluid, fluid_cells.table(), grid.reach()};
    }
    /// kernel_sum, then the fractions by both kinds.
    void find_fractions(coupling::VolumeFraction kind = coupling::VolumeFraction::normalised);
    void refresh_fluid(std::initializer_list<const FieldInfo*> fields);
    void refresh_grains(std::initializer_list<const FieldInfo*> fields);

    /// sum over the fluid of volume times `field`, over all ranks.
    double integral(const Field<double>& field) const;
    double grain_volume() const;  ///< over all ranks [m3]

    Communicator comm;
    coupling::Spreading spreading;
    CellGrid grid;
    ParticleSet fluid, grains;
    Decomposition fluid_cells, grain_cells;
};

}  // namespace talus::test
