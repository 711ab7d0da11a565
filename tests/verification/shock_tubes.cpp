#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/exact_riemann.hpp"
#include "tests/support/scene_run.hpp"

/// Shock tubes against exact solutions, Godunov and standard SPH side by side. The tables that the tests
/// print are those of the scenes' READMEs. Bounds on errors are 1.15 to 1.25 times what was measured when
/// they were set, bounds on orders 0.1 or more below.
namespace talus::test {
namespace {

struct Errors {
    double density, velocity, pressure;
};

Errors errors_of(const GasResult& gas, const std::function<reference::GasState(double)>& exact, double low,
                 double high) {
    const auto mean = [&](auto&& error) { return gas.mean_error(error, low, high); };
    return {mean([&](std::size_t k) { return gas.density[k] - exact(gas.x[k]).density; }),
            mean([&](std::size_t k) { return gas.v[k] - exact(gas.x[k]).velocity; }),
            mean([&](std::size_t k) { return gas.pressure[k] - exact(gas.x[k]).pressure; })};
}

const std::array<std::pair<const char*, std::vector<std::string>>, 2> formulations = {
    {{"godunov", {}}, {"standard", {"sph.formulation=\"standard\""}}}};

/// The tubes in 1D are too small to share: each formulation runs on one rank, by turns.
bool is_mine(std::size_t formulation) {
    const Communicator all(MPI_COMM_WORLD);
    return formulation % static_cast<std::size_t>(all.size()) == static_cast<std::size_t>(all.rank());
}

/// Prints a row of a README's table.
void print_row(const Communicator& comm, const char* formulation, std::size_t particles, const Errors& e) {
    if (comm.is_root())
        fmt::print("| {} | {} | {:.2e} | {:.2e} | {:.2e} |\n", formulation, particles, e.density, e.velocity,
                   e.pressure);
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::filesystem::path scene(const char* name) {
    return std::filesystem::path(TALUS_SOURCE_DIR) / "runs" / name;
}

/// Every error has fallen to `finest`, in the order `least_order` at least, over `doublings` of the
/// resolution.
struct Expected {
    Errors finest;
    double least_order;
};
void expect_convergence(const std::vector<Errors>& errors, const Expected& expected, double doublings = 2) {
    const Errors &coarse = errors.front(), &fine = errors.back();
    EXPECT_LT(fine.density, expected.finest.density);
    EXPECT_LT(fine.velocity, expected.finest.velocity);
    EXPECT_LT(fine.pressure, expected.finest.pressure);
    EXPECT_GT(order_of(coarse.density, fine.density) / doublings, expected.least_order);
    EXPECT_GT(order_of(coarse.velocity, fine.velocity) / doublings, expected.least_order);
    EXPECT_GT(order_of(coarse.pressure, fine.pressure) / doublings, expected.least_order);
}

struct Tube {
    const char* name;
    reference::GasState left, right;
    std::vector<std::string> overrides;
};

std::vector<Errors> run_tube(const Communicator& comm, const Tube& tube, const std::vector<std::string>& how,
                             const char* formulation, std::array<int, 3> left, int left_to_right) {
    const reference::ExactRiemann exact(tube.left, tube.right, 1.4);
    std::vector<Errors> errors;
    for (const int n : left) {
        const GasResult gas = run_gas(
            comm, scene("sod_tube"),
            joined(joined(tube.overrides, how), {fmt::format("body[0].particles={}", n),
                                                 fmt::format("body[1].particles={}", n / left_to_right)}));
        EXPECT_LT(gas.energy_drift, 1e-13);
        EXPECT_GT(gas.least_energy, 0);
        errors.push_back(errors_of(
            gas, [&](double x) { return exact.sample(x / gas.time); }, -1, 1));
        print_row(comm, formulation, gas.x.size(), errors.back());
    }
    return errors;
}

// G. A. Sod, J. Comput. Phys. 27 (1978) 1. First order, as every method that spreads a shock over a few
// particles; the ends of the rarefaction lower the order a little.
TEST(ShockTubes, SodConvergesInFirstOrder) {
    const Communicator comm(MPI_COMM_SELF);
    const Tube sod{"sod", {1, 0, 1}, {0.125, 0, 0.1}, {}};
    const Expected expected[] = {{{4.6e-3, 1.4e-2, 4.5e-3}, 0.87}, {{5.2e-3, 2.0e-2, 5.8e-3}, 0.80}};
    for (std::size_t f = 0; f < 2; ++f)
        if (is_mine(f))
            expect_convergence(
                run_tube(comm, sod, formulations[f].second, formulations[f].first, {80, 160, 320}, 8),
                expected[f]);
}

// Toro 2009, table 4.1, test 3: a shock of Mach number 198.
TEST(ShockTubes, StrongTubeConvergesInFirstOrder) {
    const Communicator comm(MPI_COMM_SELF);
    const Tube strong{
        "strong",
        {1, 0, 1000},
        {1, 0, 0.01},
        {"body[0].pressure=1000", "body[1].density=1", "body[1].pressure=0.01", "run.end_time=0.012"}};
    const Expected expected[] = {{{2.7e-2, 0.18, 4.3}, 0.7}, {{1.6e-2, 0.12, 5.2}, 0.85}};
    for (std::size_t f = 0; f < 2; ++f)
        if (is_mine(f))
            expect_convergence(
                run_tube(comm, strong, formulations[f].second, formulations[f].first, {50, 100, 200}, 1),
                expected[f]);
}

// W. F. Noh, J. Comput. Phys. 72 (1987) 78: for p -> 0 the density jumps by (gamma + 1)/(gamma - 1) = 4, the
// pressure to 4/3, and the shock leaves the wall at (gamma - 1)/2 = 1/3. The plateau, between the heated gas
// at the wall and the shock, holds within 0.3 %.
TEST(ShockTubes, ColdGasStopsAtAWall) {
    const Communicator comm(MPI_COMM_SELF);
    const Expected expected[] = {{{2.5e-2, 7.8e-3, 7.2e-3}, 0.87}, {{3.5e-2, 7e-3, 9e-3}, 0.84}};
    for (std::size_t f = 0; f < 2; ++f) {
        if (!is_mine(f)) continue;
        std::vector<Errors> errors;
        for (const int n : {100, 200, 400}) {
            const GasResult gas =
                run_gas(comm, scene("wall_shock"),
                        joined(formulations[f].second, {fmt::format("body[0].particles={}", n)}));
            EXPECT_LT(gas.energy_drift, 1e-13);
            EXPECT_GT(gas.least_energy, 0);
            const auto exact = [&](double x) {
                return x < gas.time / 3 ? reference::GasState{4, 0, 4.0 / 3}
                                        : reference::GasState{1, -1, 1e-6};
            };
            errors.push_back(errors_of(gas, exact, 0, 0.3));
            print_row(comm, formulations[f].first, gas.x.size(), errors.back());
            const Errors plateau = errors_of(gas, exact, 0.08, 0.15);
            EXPECT_LT(plateau.density, 0.003 * 4);
            EXPECT_LT(plateau.velocity, 0.001);
            EXPECT_LT(plateau.pressure, 0.003 * 4 / 3);
        }
        expect_convergence(errors, expected[f]);
    }
}

// Sod's tube on close-packed lattices of equal masses, `cells` of them along the left half. The cross-section
// has six cells on the left, the least that the range of the kernel on the right allows. The density by
// continuity, and for standard SPH a sum over 165 partners, are exact enough on lattices, however sheared,
// for first order; other choices end at some 0.5 % in the rarefaction.
TEST(ShockTubes, SodIn3dConvergesInFirstOrder) {
    const Communicator comm(MPI_COMM_WORLD);
    const reference::ExactRiemann exact({1, 0, 1}, {0.125, 0, 0.1}, 1.4);
    const std::vector<std::string> methods[] = {{},
                                                {"sph.formulation=\"standard\"", "sph.density=\"summation\"",
                                                 "sph.kernel=\"wendland_c4\"", "sph.eta=1.7"}};
    const Expected expected[] = {{{1.0e-2, 3.2e-2, 1.3e-2}, 0.9}, {{1.0e-2, 2.6e-2, 1.1e-2}, 0.9}};
    for (std::size_t f = 0; f < 2; ++f) {
        std::vector<Errors> errors;
        for (const int n : {8, 16, 32}) {
            const double width = 6 * 0.5 / n;
            const GasResult gas =
                run_gas(comm, scene("sod_tube_3d"),
                        joined(methods[f], {fmt::format("box.upper=[0.5, {0}, {0}]", width),
                                            fmt::format("body[0].upper=[0, {0}, {0}]", width),
                                            fmt::format("body[1].upper=[0.5, {0}, {0}]", width),
                                            fmt::format("body[0].particles={}", 4 * 36 * n),
                                            fmt::format("body[1].particles={}", 4 * 9 * n / 2)}));
            EXPECT_LT(gas.energy_drift, 1e-13);
            EXPECT_GT(gas.least_energy, 0);
            EXPECT_LT(*std::max_element(gas.across.begin(), gas.across.end()), 0.03);
            errors.push_back(errors_of(
                gas, [&](double x) { return exact.sample(x / gas.time); }, -1, 1));
            print_row(comm, formulations[f].first, gas.x.size(), errors.back());
        }
        expect_convergence({errors.end() - 2, errors.end()}, expected[f], 1);
    }
}

}  // namespace
}  // namespace talus::test
