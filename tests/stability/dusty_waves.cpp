#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "comm/exact_sum.hpp"
#include "domain/coupling_fields.hpp"
#include "physics/coupling/exchange.hpp"
#include "physics/dem/vectors.hpp"
#include "tests/support/mixture.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/stability_row.hpp"

/// Sound in fluid full of grains that follow it at once.
namespace talus::test {
namespace {

namespace of = coupling_field;

constexpr int waves = 24, across = 9;  // particles of fluid along a wave and across it
constexpr double spacing = 1.0 / waves, averaging = 3 * spacing, wavenumber = 2 * std::numbers::pi;

/// A particle of fluid and a grain at each point of a lattice, a wave long.
MixtureSample sample_of_a_wave() {
    Box box;
    box.dimension = 3;
    box.upper = {1, across * spacing, across * spacing};
    box.boundary = {Boundary::periodic, Boundary::periodic, Boundary::periodic};
    std::vector<PlacedSphere> spheres;
    for (int x = 0; x < waves; ++x)
        for (int y = 0; y < across; ++y)
            for (int z = 0; z < across; ++z)
                spheres.push_back({{(x + 0.5) * spacing, (y + 0.5) * spacing, (z + 0.5) * spacing}, 1e-6});
    return {{.box = box, .spacing = spacing, .spreading = {.radius = averaging}}, spheres};
}

// Grains of as much mass as the fluid has, D = 1, that follow it within t_s, much less than a period. They
// move as the fluid's average does, g sin(kx) where it moves as sin(kx). With a drag on the fluid from its
// own velocity to the average of theirs, g^2 sin(kx), waves decay at D (1 - g^2)/(2 t_s (1 + D g^2)) beside
// the D t_s k^2 c^2/(2 (1 + D)^2) of the mixture (G. Laibe, D. J. Price, MNRAS 420 (2012) 2345 and 2365):
// more than twice as fast if the kernel's rms width sigma, with 1 - g^2 = k^2 sigma^2, is above c t_s/sqrt(1
// + D). Here the fluid feels what grains feel, by the same weights.
TEST(DustyWaves, DragOnTheFluidsOwnVelocityDampsThemWhereGrainsFollowAtOnce) {
    MixtureSample sample = sample_of_a_wave();
    for (std::size_t a = 0; a < sample.fluid.size(); ++a) {
        for (int c = 0; c < 3; ++c) sample.fluid.data(field::predicted_velocity, c)[a] = 0;
        sample.fluid.data(field::predicted_velocity, 0)[a] =
            std::sin(wavenumber * sample.fluid.data(field::position, 0)[a]);
    }
    sample.refresh_fluid({&field::predicted_velocity});
    sample.find_fractions();
    std::vector<coupling::Gathered> around(sample.grains.size());
    coupling::gather(sample.mixture(), sample.spreading, of::shared_fraction, false, around);

    // Grains held at rest pull hardest. What pulls them must take as much power from the fluid as they feel
    // in their averages, -sum F.<u>: then nothing is lost where they move with those.
    const coupling::ExchangeLaws laws{.drag = coupling::Stokes{}, .viscosity = 1e-3};
    const dem::Vectors force(sample.grains, of::exchanged_force),
        reaction(sample.fluid, of::grain_acceleration);
    for (std::size_t i = 0; i < around.size(); ++i) {
        const coupling::MovingGrain grain{sample.grains.data(field::radius)[i], 1e-9, false, {}, {}, {}};
        force.put(i, mean_force(laws, grain, around[i], 1, 1e-3));
    }
    sample.refresh_grains({&of::exchanged_force});
    spread_force(sample.mixture(), sample.spreading);
    std::vector<ExactSum> sums(4);
    for (std::size_t i = 0; i < around.size(); ++i) {
        const double sine = std::sin(wavenumber * sample.grains.data(field::position, 0)[i]);
        sums[0].add(around[i].velocity.x * sine);
        sums[1].add(sine * sine);
        sums[2].add(dem::dot(force[i], around[i].velocity));
    }
    const dem::Vectors velocity(sample.fluid, field::predicted_velocity);
    for (std::size_t a = 0; a < sample.fluid.size(); ++a)
        sums[3].add(sample.fluid.data(field::mass)[a] * dem::dot(reaction[a], velocity[a]));
    ExactSum::all_reduce(sample.comm, sums);
    const double g = sums[0].value() / sums[1].value(), power = sums[2].value(),
                 ours = std::abs(sums[3].value() / power + 1);
    EXPECT_GT(power, 0);
    EXPECT_LT(ours, 1e-12);  // rounding of sums of a thousand terms

    // Of Wendland's C2 function over the radius R, by its moments: 1/15 R^2 along an axis.
    const double sigma = averaging / std::sqrt(15.0), load = 1, threshold = 1 / std::sqrt(1 + load);
    EXPECT_NEAR((1 - g * g) / std::pow(wavenumber * sigma, 2), 1, 0.05);
    for (const double share : {0.5, 0.95, 1.05, 1.5, 4.0}) {
        const double knob = share * threshold, stopping = sigma / knob;  // c = 1
        const double spurious = load * (1 - g * g) / (2 * stopping * (1 + load * g * g)),
                     own = load * stopping * wavenumber * wavenumber / (2 * (1 + load) * (1 + load));
        EXPECT_EQ(spurious < own, share < 1) << spurious / own;
        if (!is_root()) continue;
        StabilityRow row{"damping of sound by grains",
                         "drag on the fluid's own velocity",
                         "rms averaging/(c t_s)",
                         knob,
                         threshold,
                         "damping beyond the mixture's",
                         spurious / own,
                         spurious < own};
        print(row);
        row.scene = "the grains' own force, by their weights";
        row.metric = "power of it that is lost";
        row.threshold = INFINITY;
        row.found = std::max(ours, 1e-16);
        row.stable = ours < 1e-12;
        print(row);
    }
}

}  // namespace
}  // namespace talus::test
