#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "domain/random.hpp"
#include "tests/support/lattice_simulation.hpp"

/// The tensile instability: stretched (or, for some interpolations, compressed) lattices that clump.
/// K. Sugiura, S. Inutsuka, J. Comput. Phys. 308 (2016) 171.
namespace talus::test {
namespace {

using sph::Interpolation;
constexpr Interpolation interpolations[] = {Interpolation::linear, Interpolation::cubic,
                                            Interpolation::quintic};
constexpr const char* names[] = {"linear", "cubic", "quintic"};
const char* name_of(Interpolation kind) { return names[static_cast<int>(kind)]; }

/// Waves run along x; the other sides need no more than one period.
constexpr int length = 12;
Point box_size(int dimension) { return {length, dimension > 1 ? 5.0 : 0.0, dimension > 2 ? 5.0 : 0.0}; }
double wavenumber(int mode) { return 2 * std::numbers::pi * mode / length; }

Point nothing(std::uint64_t, const Point&) { return {}; }
LatticeSimulation::Field sine_along_x(double amplitude, double k) {
    return [=](std::uint64_t, const Point& site) { return Point{amplitude * std::sin(k * site[0]), 0, 0}; };
}

LatticeCase with_interpolation(int dimension, Interpolation kind, double pressure) {
    return {.dimension = dimension,
            .size = box_size(dimension),
            .pressure = pressure,
            .compressed = kind,
            .stretched = kind};
}

class TensileInstability : public testing::TestWithParam<int> {};

TEST_P(TensileInstability, AccelerationsFollowTheDispersionRelationOverTheWholeBand) {
    const Communicator world(MPI_COMM_WORLD);
    constexpr double amplitude = 1e-6;
    for (const Interpolation kind : interpolations)
        for (const double pressure : {1.0, 0.3, 0.1, -0.1, -0.3, -1.0}) {
            LatticeCase lattice = with_interpolation(GetParam(), kind, pressure);
            lattice.density = sph::DensityMethod::summation;
            for (int mode = 1; mode <= length / 2; ++mode) {
                const double k = wavenumber(mode), theory = omega_squared(lattice, k);
                const LatticeSimulation wave(world, lattice, sine_along_x(amplitude, k), nothing);
                const double measured = -wave.acceleration(k) / amplitude;
                EXPECT_NEAR(measured, theory, 1e-3 * std::abs(theory) + 1e-5)
                    << name_of(kind) << ", P = " << pressure << ", mode " << mode;
            }
        }
}

/// Solves sinh(x)/x = ratio, or sin(x)/x = ratio in the first half period where that is below 1.
double growth_argument(double ratio) {
    double low = 0, high = 50;
    for (int i = 0; i < 200; ++i) {
        const double x = 0.5 * (low + high);
        (std::sinh(x) < ratio * x ? low : high) = x;
    }
    return low;
}

/// Growth rate of a mode given by its velocity, from its amplitude e^5/2 times larger.
double measured_growth_rate(const Communicator& comm, const LatticeCase& lattice, double k, double expected) {
    constexpr double speed = 1e-8;
    LatticeSimulation wave(comm, lattice, nothing, sine_along_x(speed, k));
    while (wave.run().time() * expected < 5) wave.run().step();
    const double time = wave.run().time();
    return growth_argument(wave.displacement(k) / (speed * time)) / time;
}

/// Frequency of a stable mode given by its velocity, from the time of three whole periods.
double measured_frequency(const Communicator& comm, const LatticeCase& lattice, double k) {
    LatticeSimulation wave(comm, lattice, nothing, sine_along_x(1e-8, k));
    double before = wave.displacement(k), passage = 0;
    for (int passages = 0; passages < 6;) {
        const double start = wave.run().time();
        wave.run().step();
        const double now = wave.displacement(k);
        if (before * now < 0) {
            passage = start + (wave.run().time() - start) * before / (before - now);
            ++passages;
        }
        before = now;
    }
    return 6 * std::numbers::pi / passage;
}

/// The mode of the box that the relation says grows fastest.
int fastest_mode(const LatticeCase& lattice) {
    int fastest = 1;
    for (int mode = 2; mode <= length / 2; ++mode)
        if (omega_squared(lattice, wavenumber(mode)) < omega_squared(lattice, wavenumber(fastest)))
            fastest = mode;
    return fastest;
}

TEST_P(TensileInstability, ModesGrowAndSwingAtTheRatesOfTheDispersionRelation) {
    const Communicator world(MPI_COMM_WORLD);
    const int dimension = GetParam();
    for (const Interpolation kind : interpolations)
        for (const double pressure : {1.0, -1.0}) {
            LatticeCase lattice = with_interpolation(dimension, kind, pressure);
            if (dimension == 3) lattice.courant = 0.2;
            const int mode = fastest_mode(lattice);
            const double k = wavenumber(mode), theory = omega_squared(lattice, k);
            const double rate = std::sqrt(std::abs(theory));
            const double measured = theory < 0 ? measured_growth_rate(world, lattice, k, rate)
                                               : measured_frequency(world, lattice, k);
            EXPECT_NEAR(measured / rate, 1, 0.01) << name_of(kind) << ", P = " << pressure;
            if (world.is_root())
                fmt::print("| {} | {} | {:+.0f} | {:.3f} | {} | {:.5f} | {:.5f} | {:+.2f} % |\n", dimension,
                           name_of(kind), pressure, k / std::numbers::pi, theory < 0 ? "grows" : "swings",
                           measured, rate, 100 * (measured / rate - 1));
        }
}

/// Root mean square distance from the lattice after some sound crossings of a slightly disordered box, in
/// units of that at the start; less time if it has grown a hundredfold.
double disorder_after(const Communicator& comm, const LatticeCase& lattice, double crossings) {
    static constexpr RandomStream noise{.seed = 3};
    constexpr double amplitude = 1e-4;
    LatticeSimulation box(
        comm, lattice,
        [](std::uint64_t id, const Point&) {
            Point d{};
            for (std::uint32_t a = 0; a < 3; ++a) d[a] = amplitude * (2 * noise.uniform(id, a) - 1);
            return d;
        },
        nothing);
    const double before = box.distance_from_sites();
    double most = 1;
    while (box.run().time() < crossings * lattice.size[0] && most < 100) {
        box.run().step();
        most = std::max(most, box.distance_from_sites() / before);
    }
    return most;
}

TEST_P(TensileInstability, TheAutomaticChoiceIsStableForBothSignsOfPressure) {
    const Communicator world(MPI_COMM_WORLD);
    const int dimension = GetParam();
    const Interpolation squeezed = sph::stable_compressed(dimension),
                        pulled = sph::stable_stretched(dimension);
    for (const double pressure : {0.3, -0.3}) {
        LatticeCase lattice{.dimension = dimension,
                            .lattice = Lattice::close_packed,  // others shear: fluids do not hold them
                            .pressure = pressure,
                            .compressed = squeezed,
                            .stretched = pulled,
                            .cutoff = dimension == 3 ? 2.0 : 3.0,
                            .courant = 0.5};
        const double edge = dimension == 3 ? std::cbrt(4.0) : 1;
        lattice.size = {10, 10, 10};
        if (dimension == 3) lattice.size = {6 * edge, 6 * edge, 6 * edge};
        const double chosen = disorder_after(world, lattice, dimension == 3 ? 15 : 30);
        EXPECT_LT(chosen, 1.5) << "P = " << pressure;
        // The other interpolation: that of the other sign, where linear does for neither's opposite.
        lattice.compressed = dimension == 1 ? Interpolation::quintic : pulled;
        lattice.stretched = Interpolation::linear;
        const double wrong = disorder_after(world, lattice, 30);
        EXPECT_GE(wrong, 100) << "P = " << pressure;
        if (world.is_root())
            fmt::print("| {} | {:+.1f} | {} | {:.2f} | {} | {:.0f} |\n", dimension, pressure,
                       name_of(pressure > 0 ? squeezed : pulled), chosen,
                       name_of(pressure > 0 ? lattice.compressed : lattice.stretched), wrong);
    }
}

INSTANTIATE_TEST_SUITE_P(Lattices, TensileInstability, testing::Values(1, 2, 3),
                         [](const auto& dimension) { return std::to_string(dimension.param) + "D"; });

}  // namespace
}  // namespace talus::test
