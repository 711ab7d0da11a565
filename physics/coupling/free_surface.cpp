#include "physics/coupling/free_surface.hpp"

#include <cmath>
#include <utility>

#include "domain/coupling_fields.hpp"
#include "physics/coupling/averaging.hpp"
#include "physics/dem/vectors.hpp"
#include "physics/water/settings.hpp"

namespace talus::coupling {

namespace {

namespace of = coupling_field;

double fullness(const dem::Vectors<const ParticleSet>& position, const double* volume,
                const dem::Vector3<>& centre, std::span<const Run> runs, const WendlandWeight& weight) {
    double sum = 0;
    for (const Run& run : runs)
        for (std::uint32_t b = run.begin; b < run.end; ++b) {
            const dem::Vector3<> r = centre - position[b];
            sum += std::abs(volume[b]) * weight(dot(r, r));
        }
    return sum;
}

}  // namespace

void relieve_free_surface(ParticleSet& fluid, const CellTable& cells, double radius, double rest_density) {
    constexpr double compressed = 1.02;  // more than barely compressible fluid is unless it has no room
    const double *volume = fluid.data(of::quadrature_volume), *solid = fluid.data(of::solid_fraction);
    double* density = fluid.data(field::density);
    const dem::Vectors position(std::as_const(fluid), field::position);
    const WendlandWeight weight(radius);
    cells.for_each_own(Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        for (std::uint32_t a = cell.begin; a < cell.end; ++a) {
            if (!(volume[a] > 0)) continue;
            const double free = rest_density * water::share_of_water(solid[a]);
            const bool tense = density[a] < free;
            if (!tense && density[a] < compressed * free) continue;
            const double full = fullness(position, volume, position[a], runs, weight);
            if (full < (tense ? Fullness::surface : Fullness::drop)) density[a] = free;
        }
    });
}

}  // namespace talus::coupling
