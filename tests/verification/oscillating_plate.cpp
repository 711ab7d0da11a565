#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/support/solid_scene.hpp"
#include "tests/support/timoshenko.hpp"

/// runs/oscillating_plate: the period of its first bending mode, by the number of particles through its
/// thickness.
namespace talus::test {
namespace {

constexpr double thickness = 0.02, length = 0.2;

Cantilever plate_of(const Material& material) {
    return {length, thickness, material.reference_density, material.bulk_modulus, material.shear_modulus};
}

/// Four times the time until the plate first stands still (no angular momentum around the clamp) [s].
double measured_period(const Communicator& comm, int rows) {
    const double spacing = thickness / rows;
    const SceneSetup scene =
        solid_scene(comm, "oscillating_plate",
                    {fmt::format("body[0].spacing={}", spacing), fmt::format("body[1].spacing={}", spacing)});
    const auto run = started(comm, scene);
    const auto momentum = [&run] { return run->totals().angular_momentum[2]; };
    double now = momentum();
    while (run->time() < 0.2) {
        const double before = now, time = run->time();
        run->step();
        now = momentum();
        if (now <= 0) return 4 * (time + (run->time() - time) * before / (before - now));
    }
    return 0;
}

void print(int rows, double period, const Cantilever& plate) {
    fmt::print("| {} | {:.4f} | {:.3f} |\n", rows, period, timoshenko_period(plate) / period);
}

TEST(OscillatingPlate, PeriodTendsToTheory) {
    const Communicator comm = world(), alone(MPI_COMM_SELF);  // small plates: each rank computes its own
    const Cantilever plate = plate_of(solid_scene(comm, "oscillating_plate").simulation.materials[0]);
    std::array<int, 3> rows{3, 4, 5};
    std::array<double, 3> period{0, 0, 0};
    for (std::size_t k = 0; k < rows.size(); ++k)
        if ((k == 2 ? 0 : 1) % comm.size() == comm.rank()) period[k] = measured_period(alone, rows[k]);
    comm.all_max(std::span<double>(period));
    const double theory = timoshenko_period(plate);
    EXPECT_NEAR(thin_period(plate), 0.2541, 1e-4);
    EXPECT_NEAR(theory / thin_period(plate), 1.009, 1e-3);
    if (comm.is_root())
        for (std::size_t k = 0; k < rows.size(); ++k) print(rows[k], period[k], plate);

    // Free surfaces bear less stress over part of a smoothing length, as if the plate was thinner by 1.2
    // spacings: the frequency falls short in first order of the spacing. What is left of it at no spacing is
    // the clamp's own give.
    std::array<double, 3> frequency;
    for (std::size_t k = 0; k < 3; ++k) frequency[k] = theory / period[k];
    EXPECT_LT(frequency[0], frequency[1]);
    EXPECT_LT(frequency[1], frequency[2]);
    EXPECT_GT(frequency[2], 0.7);
    EXPECT_NEAR(frequency[2] + 4 * (frequency[2] - frequency[1]), 1, 0.06)
        << "extrapolated from 4 and 5 rows";
}

/// For the README; minutes.
TEST(OscillatingPlate, DISABLED_MoreRows) {
    const Communicator comm = world();
    const Cantilever plate = plate_of(solid_scene(comm, "oscillating_plate").simulation.materials[0]);
    std::vector<double> frequency;
    for (const int rows : {6, 8}) {
        const double period = measured_period(comm, rows);
        if (comm.is_root()) print(rows, period, plate);
        frequency.push_back(timoshenko_period(plate) / period);
    }
    EXPECT_NEAR(frequency[1] + 3 * (frequency[1] - frequency[0]), 1, 0.02)
        << "extrapolated from 6 and 8 rows";
}

}  // namespace
}  // namespace talus::test
