#include "src/setup/geostatic.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace talus {

std::optional<GeostaticStart> read_geostatic(const Section& body, const Material& material,
                                             const std::optional<std::array<double, 3>>& gravity,
                                             const BodyShape& shape, int dimension) {
    const Section table = body.section("geostatic");
    if (!table.exists()) return {};
    GeostaticStart start;
    if (!gravity || norm(*gravity) == 0) {
        table.error("", "needs sph.gravity");
        return {};
    }
    if (!std::holds_alternative<LinearEquationOfState>(material.eos))
        table.error("", fmt::format("needs a linear equation of state, '{}' has another", material.name));
    start.up = times(-1 / norm(*gravity), *gravity);
    start.weight = material.reference_density * norm(*gravity);
    const BoxShape box = bounds(shape, dimension);
    double top = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        top += std::max(box.lower[a] * start.up[a], box.upper[a] * start.up[a]);
    start.surface = table.number("surface", "m", top);
    const double K = material.bulk_modulus, G = material.shear_modulus;
    start.lateral_ratio = table.number("lateral_ratio", "1", (K - 2.0 / 3 * G) / (K + 4.0 / 3 * G), {0, 10});
    if (G == 0 && start.lateral_ratio != 1)
        table.error("lateral_ratio", "is 1 in a fluid, which bears no shear");
    return start;
}

void put_geostatic(ParticleSet& particles, std::size_t i, const GeostaticStart& start,
                   const Material& material) {
    const int dimension = particles.dimension();
    double height = 0;
    for (int a = 0; a < dimension; ++a)
        height += start.up[static_cast<std::size_t>(a)] * particles.data(field::position, a)[i];
    const double vertical = start.weight * std::max(0.0, start.surface - height);
    const double lateral = start.lateral_ratio * vertical, pressure = (vertical + 2 * lateral) / 3;
    const double compression = 1 + pressure / material.bulk_modulus;
    particles.data(field::mass)[i] *= compression;
    if (particles.has(field::density))
        particles.data(field::density)[i] = material.reference_density * compression;
    if (!particles.has(field::deviatoric_stress)) return;
    for (int c = 0; c < component_count(Shape::symmetric_tensor, dimension); ++c) {
        const auto [a, b] = symmetric_axes(c, dimension);
        particles.data(field::deviatoric_stress, c)[i] = (lateral - vertical) *
                                                             start.up[static_cast<std::size_t>(a)] *
                                                             start.up[static_cast<std::size_t>(b)] +
                                                         (a == b ? pressure - lateral : 0.0);
    }
}

}  // namespace talus
