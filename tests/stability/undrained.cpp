#include <gtest/gtest.h>

#include <Eigen/SparseLU>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "domain/soil_fields.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/soil_run.hpp"
#include "tests/support/stability_row.hpp"

/// Pressures of water that cannot drain and can hardly be compressed.
namespace talus::test {
namespace {

/// Part of the pressures within the load's bulb that changes sign from node to node: the mean of |p - mean of
/// the four neighbours along the axes| over the mean of |p|, from the third layer down.
double roughness(std::map<std::pair<long, long>, double> pressure) {
    double rough = 0, size = 0;
    for (const auto& [at, p] : pressure) {
        const auto [x, y] = at;
        if (x < 2 || y < 2 || !pressure.contains({x + 2, y}) || !pressure.contains({x, y + 3})) continue;
        const double around =
            (pressure[{x - 1, y}] + pressure[{x + 1, y}] + pressure[{x, y - 1}] + pressure[{x, y + 1}]) / 4;
        rough += std::abs(p - around);
        size += std::abs(p);
    }
    return rough / size;
}

std::map<std::pair<long, long>, double> pore_pressures(const SoilSimulation& simulation, double spacing) {
    const ParticleSet& soil = simulation.particles();
    std::map<std::pair<long, long>, double> pressure;
    for (const std::size_t i : soil_nodes(soil))
        pressure[{std::lround(soil.data(field::position, 0)[i] / spacing),
                  std::lround(soil.data(field::position, 1)[i] / spacing)}] =
            soil.data(soil_field::pore_pressure)[i];
    return pressure;
}

/// Pore pressures of the same stratum at rest by bilinear elements for displacement and pressure alike, with
/// 2 x 2 points of Gauss and nothing against the checkerboard, `storage` [1/Pa] of the water: [K -B; -B'
/// -M/Q] (u, p) = (f, 0).
std::map<std::pair<long, long>, double> equal_order_pressures(long columns, long rows, double spacing,
                                                              double storage) {
    const double shear = 30e6 / (2 * 1.2), lame = 30e6 * 0.2 / (1.2 * 0.6);
    const auto node = [=](long x, long y) { return static_cast<int>(y * (columns + 1) + x); };
    const int nodes = node(columns, rows) + 1;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * nodes);
    std::vector<bool> held(static_cast<std::size_t>(3 * nodes));
    for (long y = 0; y <= rows; ++y)
        for (long x = 0; x <= columns; ++x) {
            const auto n = static_cast<std::size_t>(3 * node(x, y));
            held[n] = y == 0 || x == 0 || x == columns;
            held[n + 1] = y == 0;
            held[n + 2] = y == rows;
            const double load = y < rows                               ? 0
                                : static_cast<double>(x) * spacing < 1 ? 1
                                : x * spacing == 1                     ? 0.5
                                                                       : 0;
            right[static_cast<long>(n) + 1] = -10e3 * spacing * load * (x == 0 ? 0.5 : 1);
        }
    const auto add = [&](int row, int column, double value) {
        if (!held[static_cast<std::size_t>(row)] && !held[static_cast<std::size_t>(column)])
            entries.emplace_back(row, column, value);
    };
    for (long y = 0; y < rows; ++y)
        for (long x = 0; x < columns; ++x)
            for (const double s : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)})
                for (const double t : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {
                    std::array<int, 4> at{};
                    std::array<std::array<double, 3>, 4> shape{};  // value, d/dx, d/dy
                    for (std::size_t k = 0; k < 4; ++k) {
                        const double a = k % 2 == 0 ? -1 : 1, b = k < 2 ? -1 : 1;
                        at[k] = 3 * node(x + (a > 0), y + (b > 0));
                        shape[k] = {(1 + a * s) * (1 + b * t) / 4, a * (1 + b * t) / (2 * spacing),
                                    b * (1 + a * s) / (2 * spacing)};
                    }
                    const double area = spacing * spacing / 4;
                    for (std::size_t i = 0; i < 4; ++i)
                        for (std::size_t j = 0; j < 4; ++j) {
                            const double both = shape[i][1] * shape[j][1] + shape[i][2] * shape[j][2];
                            for (int a = 0; a < 2; ++a) {
                                const auto da = static_cast<std::size_t>(a + 1);
                                for (int b = 0; b < 2; ++b) {
                                    const auto db = static_cast<std::size_t>(b + 1);
                                    add(at[i] + a, at[j] + b,
                                        area * (lame * shape[i][da] * shape[j][db] +
                                                shear * (shape[i][db] * shape[j][da] + (a == b ? both : 0))));
                                }
                                add(at[i] + a, at[j] + 2, -area * shape[i][da] * shape[j][0]);
                                add(at[j] + 2, at[i] + a, -area * shape[i][da] * shape[j][0]);
                            }
                            add(at[i] + 2, at[j] + 2, -area * storage * shape[i][0] * shape[j][0]);
                        }
                }
    for (int n = 0; n < 3 * nodes; ++n)
        if (held[static_cast<std::size_t>(n)]) {
            entries.emplace_back(n, n, 1);
            right[n] = 0;
        }
    Eigen::SparseMatrix<double> matrix(3 * nodes, 3 * nodes);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd found = Eigen::SparseLU<Eigen::SparseMatrix<double>>(matrix).solve(right);
    std::map<std::pair<long, long>, double> pressure;
    for (long y = 0; y <= rows; ++y)
        for (long x = 0; x <= columns; ++x) pressure[{x, y}] = found[3 * node(x, y) + 2];
    return pressure;
}

/// The load of saturated_stratum after 0.6 s, and at once. With interpolations of equal order for
/// displacement and pressure a checkerboard is more than half of the pressure where the water is a thousandth
/// as compressible as the soil, and gone where it is as compressible; the scheme of the program has 5 % at
/// most, all of it the curvature of the pressure itself, in water that is hardly compressible.
TEST(SoilStratum, ElementsOfEqualOrderMakeACheckerboardAndOursDoNot) {
    const Communicator alone(MPI_COMM_SELF);
    constexpr double spacing = 0.5, stiffness = 30e6 * 0.8 / (1.2 * 0.6);  // of the soil, in one direction
    const auto row = [](const char* scene, double knob, double rough, bool smooth) {
        if (is_root())
            print({"undrained water", scene, "storage of the water over that of the soil", knob, INFINITY,
                   "roughness", rough, smooth});
    };
    for (const double share : {3e-4, 1e-3, 1.0}) {
        const double rough = roughness(equal_order_pressures(16, 10, spacing, share / stiffness));
        const bool smooth = rough < 0.05;
        EXPECT_EQ(smooth, share == 1) << rough;
        EXPECT_EQ(rough > 0.5, share < 1) << rough;
        row("elements of equal order", share, rough, smooth);
    }
    double rough = 0, pressure = 0;
    run_soil(alone,
             soil_scene(alone, std::filesystem::path(TALUS_SOURCE_DIR) / "runs" / "saturated_stratum",
                        {"soil.spacing=0.5", "run.end_time=0.6"}),
             [&](const SoilSimulation& simulation) {
                 if (simulation.time() < 0.595) return;
                 rough = roughness(pore_pressures(simulation, spacing));
                 pressure = simulation.totals().greatest_pore_pressure;
             });
    EXPECT_LT(rough, 0.05);
    EXPECT_GT(pressure, 5000);
    EXPECT_LT(pressure, 10000);  // of the load: nowhere can the water bear more
    row("saturated_stratum", 3e-4, rough, true);
}

}  // namespace
}  // namespace talus::test
