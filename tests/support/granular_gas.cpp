#include "tests/support/granular_gas.hpp"

#include <cmath>
#include <numbers>

#include "domain/random.hpp"

namespace talus::test {

namespace {
constexpr double steps_a_contact = 20;
constexpr double density = 6 / std::numbers::pi;  // mass 1
}  // namespace

double GranularGas::number() const { return std::pow(static_cast<double>(grains_along_edge), 3); }

double GranularGas::edge() const { return std::cbrt(number() / (density * volume_fraction)); }

/// omega^2 = k/m* (1 - damping^2/4), half a period in a contact, m* = 1/2.
double GranularGas::stiffness() const {
    const double frequency = std::numbers::pi / contact_time;
    const double share = dem::linear_damping(restitution, dem::EndOfContact::may_attract);
    return 0.5 * frequency * frequency / (1 - 0.25 * share * share);
}

double GranularGas::damping() const {
    return dem::linear_damping(restitution, dem::EndOfContact::may_attract) * std::sqrt(0.5 * stiffness());
}

GrainSetup GranularGas::setup() const {
    return {
        .box = {3,
                {},
                {edge(), edge(), edge()},
                {Boundary::periodic, Boundary::periodic, Boundary::periodic}},
        .laws = linear_table({.name = "ball", .density = density, .restitution = restitution}, stiffness()),
        .material = {0},
        .held = {0},
        .walls = {},
        .gravity = {},
        .time_step = contact_time / steps_a_contact,
        .skin = 0.3};
}

std::vector<GrainState> GranularGas::lattice() const {
    std::vector<GrainState> grains;
    const double spacing = edge() / static_cast<double>(grains_along_edge);
    for (std::size_t k = 0; k < grains_along_edge; ++k)
        for (std::size_t j = 0; j < grains_along_edge; ++j)
            for (std::size_t i = 0; i < grains_along_edge; ++i)
                grains.push_back(
                    {{(static_cast<double>(i) + 0.5) * spacing, (static_cast<double>(j) + 0.5) * spacing,
                      (static_cast<double>(k) + 0.5) * spacing},
                     {},
                     {},
                     0.5,
                     density});
    return grains;
}

void heat(std::vector<GrainState>& grains, double temperature) {
    const RandomStream random{1, RandomPurpose::velocities};
    dem::Vector3<> mean{};
    for (std::size_t k = 0; k < grains.size(); ++k) {
        grains[k].velocity = {random.uniform(k, 0), random.uniform(k, 1), random.uniform(k, 2)};
        mean = mean + (1 / static_cast<double>(grains.size())) * grains[k].velocity;
    }
    double square = 0;
    for (GrainState& grain : grains) {
        grain.velocity = grain.velocity - mean;
        square += dot(grain.velocity, grain.velocity) / static_cast<double>(grains.size());
    }
    for (GrainState& grain : grains) grain.velocity = std::sqrt(3 * temperature / square) * grain.velocity;
}

}  // namespace talus::test
