#include "src/water/wall_gap.hpp"

#include <algorithm>
#include <cmath>

#include "domain/water_fields.hpp"

namespace talus {

WallGap find_wall_gap(const WaterSimulation& simulation, double searched) {
    const ParticleSet& particles = simulation.particles();
    const std::uint8_t* body = particles.data(field::body);
    const float* volume =
        particles.data(water_field::partner_volume);  // less than 0 of walls, copies included
    const auto coordinate = [&](std::uint32_t i, int axis) {
        return axis < particles.dimension() ? particles.data(field::position, axis)[i] : 0.0;
    };
    double least2 = searched * searched;
    std::uint64_t within = 0;
    simulation.decomposition().table().for_each_own(
        Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            for (std::uint32_t a = cell.begin; a < cell.end; ++a) {
                if (!simulation.is_water(body[a])) continue;
                double nearest2 = searched * searched;
                for (const Run& run : runs)
                    for (std::uint32_t b = run.begin; b < run.end; ++b) {
                        if (!(volume[b] < 0)) continue;
                        double r2 = 0;
                        for (int axis = 0; axis < 3; ++axis) {
                            const double apart = coordinate(a, axis) - coordinate(b, axis);
                            r2 += apart * apart;
                        }
                        nearest2 = std::min(nearest2, r2);
                    }
                if (nearest2 < searched * searched) ++within;
                least2 = std::min(least2, nearest2);
            }
        });
    return {simulation.comm().all_min(std::sqrt(least2)), simulation.comm().all_sum(within)};
}

}  // namespace talus
