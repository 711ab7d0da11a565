#pragma once
#include <cstdint>
#include <vector>

#include "domain/random.hpp"
#include "io/scene.hpp"

namespace talus {

/// How the radii of a body of grains are distributed.
struct GrainSizes {
    enum class Kind : std::uint8_t {
        uniform,         ///< as many grains in each interval of the radius
        volume_uniform,  ///< as much volume in each interval of the radius
        lognormal,       ///< the logarithm of the radius is normal, by number, cut off at the bounds
        table            ///< a few radii, each with its share of the volume
    };
    Kind kind = Kind::uniform;
    double least = 0, greatest = 0;    ///< radii [m]
    double median = 0, deviation = 0;  ///< of the lognormal: [m], and of the logarithm [1]
    std::vector<double> radii;         ///< of the table [m]
    std::vector<double> up_to;         ///< share of the grains with this radius or one before [1]

    /// Radius of a grain [m], the same whoever asks; draws the stream's numbers from `counter` on.
    double radius(const RandomStream& random, std::uint64_t id, std::uint32_t counter) const;
};

/// Reads `radius`, or `radii` and `distribution`.
GrainSizes read_grain_sizes(const Section& table);

}  // namespace talus
