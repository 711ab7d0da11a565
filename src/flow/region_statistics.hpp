#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "physics/dem/clumps/clump_motion.hpp"
#include "physics/dem/contact_loads.hpp"
#include "src/setup/shapes.hpp"

namespace talus {

/// A part of space whose grains are counted.
struct WatchedRegion {
    std::string name;
    BodyShape shape;
    bool stress = true;  ///< whether the stress is asked for
};

/// The grains whose centre is in a region, a clump being one grain; exact sums, rounded once.
struct RegionState {
    std::uint64_t count = 0;
    std::vector<std::uint64_t> of_body;  ///< number of each body's
    double mass = 0;                     ///< [kg]
    double solid_fraction = 0;           ///< volume of these grains over that of the region [1]; of a clump
                                         ///< that of the union of its spheres
    std::array<double, 3> velocity{};    ///< of their centre of mass [m/s]
    /// xx, yy, zz, xy, yz, xz, compression positive [Pa]: the symmetric part of
    /// (sum m v'v' - sum r f) / V, v' of a grain's centre relative to the mean velocity, r from that centre
    /// to each of its contacts and f the force there. A. E. H. Love, A Treatise on the Mathematical Theory of
    /// Elasticity, 4th ed. (1927), note B; J. Weber, Bull. Liaison Ponts Chauss. 20 (1966).
    std::array<double, 6> stress{};
};

/// `contacts` need not be known (empty) if no region asks for the stress. Collective.
std::vector<RegionState> region_states(const Communicator& comm, const ParticleSet& grains, const Box& box,
                                       const dem::ClumpMotion& clumps, std::size_t bodies,
                                       std::span<const WatchedRegion> regions,
                                       std::span<const dem::LoadedContact> contacts);

}  // namespace talus
