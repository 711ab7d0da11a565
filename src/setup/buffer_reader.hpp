#pragma once
#include <vector>

#include "domain/box.hpp"
#include "io/scene.hpp"
#include "physics/water/buffers.hpp"
#include "src/setup/bodies.hpp"

namespace talus {

/// Speeds of an inflow by the place along another axis, linear between those given and even beyond.
struct InflowProfile {
    int across = 0;              ///< axis
    std::vector<double> places;  ///< rising [m]; none: one speed
    std::vector<double> speeds;  ///< along the direction of the inflow [m/s]

    double speed(const Point& x) const;
};

/// A body of water as an inflow or an outflow, if its table has [body.inflow] or [body.outflow].
struct OpenEnd {
    water::Buffer buffer;  ///< of the kind water if it is neither; without its particles' volume
    InflowProfile profile;
};

/// Reads it. Faults are recorded in the scene.
OpenEnd read_open_end(const Section& table, const Body& body, const Box& box);

}  // namespace talus
