#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "domain/soil_fields.hpp"
#include "tests/support/scene_run.hpp"
#include "tests/support/soil_run.hpp"

/// Waves in bars of soil against d'Alembert's solution. The tables printed are those of the scenes' READMEs.
namespace talus::test {
namespace {

const std::filesystem::path runs = std::filesystem::path(TALUS_SOURCE_DIR) / "runs";
constexpr double length = 1, wave_speed = 200, load = 1e4, end_time = 3.3 * length / wave_speed;

/// Stress of a bar fixed at 0 whose end is loaded at once: images of the load.
double exact_stress(double x, double time) {
    double stress = 0;
    for (int k = 0; k < 20; ++k) {
        const double sign = k % 2 == 0 ? 1 : -1, way = wave_speed * time - 2 * k * length;
        stress += sign * load * ((way > length - x) + (way > length + x));
    }
    return stress;
}

/// Of the stress at the end, over the load; overshoot: beyond 0 and the load, which bound it then.
struct Errors {
    double mean, overshoot;
};

Errors errors_of(const std::vector<double>& x, const std::vector<double>& stress) {
    Errors errors{0, 0};
    for (std::size_t k = 0; k < x.size(); ++k) {
        errors.mean += std::abs(stress[k] - exact_stress(x[k], end_time)) / load;
        errors.overshoot = std::max({errors.overshoot, stress[k] / load - 1, -stress[k] / load});
    }
    errors.mean /= static_cast<double>(x.size());
    return errors;
}

Errors taylor_sph(int elements, double courant) {
    const Communicator alone(MPI_COMM_SELF);
    const SoilScene scene = soil_scene(
        alone, runs / "bar_sudden_load",
        {fmt::format("soil.spacing={}", length / elements), fmt::format("soil.courant={}", courant),
         fmt::format("run.end_time={}", end_time * (1 - 1e-9))});
    std::vector<double> x, stress;
    run_soil(alone, scene, [&](const SoilSimulation& simulation) {
        if (simulation.time() < end_time * (1 - 1e-9)) return;
        for (const std::size_t i : soil_nodes(simulation.particles())) {
            x.push_back(simulation.particles().data(field::position)[i]);
            stress.push_back(simulation.particles().data(soil_field::stress)[i]);
        }
    });
    return errors_of(x, stress);
}

/// Linear finite elements with a consistent mass and Newmark's average acceleration (beta = 1/4, gamma =
/// 1/2), the usual scheme of structural dynamics; the stress is that of the elements.
Errors newmark(int elements, double courant) {
    const auto n = static_cast<std::size_t>(elements);
    const double h = length / elements, density = 2000, stiffness = density * wave_speed * wave_speed;
    const auto steps = static_cast<int>(std::ceil(end_time / (courant * h / wave_speed)));
    const double dt = end_time / steps;
    std::vector<double> u(n + 1), v(n + 1), a(n + 1);
    for (int step = 0; step <= steps; ++step) {
        // (M + beta dt^2 K) a = f - K (u + dt v + dt^2/4 a): tridiagonal; the first step only finds a.
        const double share = step == 0 ? 0 : 0.25 * dt * dt;
        std::vector<double> predicted(n + 1), lower(n + 1), middle(n + 1), upper(n + 1), right(n + 1);
        for (std::size_t i = 0; i <= n; ++i)
            predicted[i] = step == 0 ? u[i] : u[i] + dt * v[i] + 0.25 * dt * dt * a[i];
        for (std::size_t e = 0; e < n; ++e) {
            const double mass = density * h / 6, spring = stiffness / h;
            const double force = spring * (predicted[e + 1] - predicted[e]);
            middle[e] += 2 * mass + share * spring;
            middle[e + 1] += 2 * mass + share * spring;
            upper[e] += mass - share * spring;
            lower[e + 1] += mass - share * spring;
            right[e] += force;
            right[e + 1] -= force;
        }
        right[n] += load;
        middle[0] = 1;
        upper[0] = right[0] = 0;
        for (std::size_t i = 1; i <= n; ++i) {
            const double factor = lower[i] / middle[i - 1];
            middle[i] -= factor * upper[i - 1];
            right[i] -= factor * right[i - 1];
        }
        std::vector<double> next(n + 1);
        for (std::size_t i = n + 1; i-- > 0;)
            next[i] = (right[i] - (i < n ? upper[i] * next[i + 1] : 0)) / middle[i];
        if (step > 0)
            for (std::size_t i = 0; i <= n; ++i) {
                u[i] = predicted[i] + 0.25 * dt * dt * next[i];
                v[i] += 0.5 * dt * (a[i] + next[i]);
            }
        a = next;
    }
    std::vector<double> x, stress;
    for (std::size_t e = 0; e < n; ++e) {
        x.push_back((static_cast<double>(e) + 0.5) * h);
        stress.push_back(stiffness / h * (u[e + 1] - u[e]));
    }
    return errors_of(x, stress);
}

bool is_root() { return Communicator(MPI_COMM_WORLD).is_root(); }

TEST(SoilBar, SuddenLoadIsCarriedToRoundingAtTheLargestStep) {
    const Communicator alone(MPI_COMM_SELF);
    double worst = 0;
    run_soil(alone, soil_scene(alone, runs / "bar_sudden_load", {}, true),
             [&](const SoilSimulation& simulation) {
                 for (const std::size_t i : soil_nodes(simulation.particles())) {
                     const double x = simulation.particles().data(field::position)[i], t = simulation.time();
                     const double before = exact_stress(x, t - 1e-7), after = exact_stress(x, t + 1e-7);
                     if (before != after) continue;  // a front is just there
                     const double stress = simulation.particles().data(soil_field::stress)[i];
                     worst = std::max(worst, std::abs(stress - before) / load);
                 }
             });
    EXPECT_LT(worst, 1e-10);  // of rounding, over the 400 steps
}

TEST(SoilBar, SuddenLoadConvergesWithLittleOvershootAtSmallerSteps) {
    // Stands beside the linear finite element with Newmark's method. A front smeared over h^(2/3) (a scheme
    // of second order, P. D. Lax) makes an L1 error of the order 2/3.
    std::vector<Errors> ours, theirs;
    for (const int n : {50, 100, 200}) {
        ours.push_back(taylor_sph(n, 0.9));
        theirs.push_back(newmark(n, 0.9));
        if (is_root())
            fmt::print("| {} | {:.4f} | {:.1f} % | {:.4f} | {:.1f} % |\n", n, ours.back().mean,
                       100 * ours.back().overshoot, theirs.back().mean, 100 * theirs.back().overshoot);
    }
    for (std::size_t k = 0; k < ours.size(); ++k) {
        EXPECT_LT(ours[k].mean, theirs[k].mean);
        EXPECT_LT(ours[k].overshoot, theirs[k].overshoot);
    }
    EXPECT_GT(order_of(ours[0].mean, ours[2].mean) / 2, 0.55);
}

TEST(SoilBar, TensionLeavesTheBarOfDykaAndIngelStable) {
    // d'Alembert: the middle of the bar sees +-rho c v0 / 2 = 1.006e8 Pa, the wall twice that.
    const Communicator alone(MPI_COMM_SELF);
    const double expected = 0.5 * std::sqrt(7833 * 2.068e11) * 5;
    std::array<double, 2> greatest{}, least{};
    double first_energy = 0, last_energy = 0;
    run_soil(alone, soil_scene(alone, runs / "bar_tension", {}), [&](const SoilSimulation& simulation) {
        const double x_middle = 20 * 0.0033325;
        for (const std::size_t i : soil_nodes(simulation.particles())) {
            const double x = simulation.particles().data(field::position)[i];
            const double stress = simulation.particles().data(soil_field::stress)[i];
            for (const auto& [place, k] : {std::pair{0.0, 0}, {x_middle, 1}})
                if (std::abs(x - place) < 1e-6) {
                    const auto p = static_cast<std::size_t>(k);
                    greatest[p] = std::max(greatest[p], stress);
                    least[p] = std::min(least[p], stress);
                }
        }
        const SoilTotals totals = simulation.totals();
        last_energy = totals.kinetic_energy + totals.elastic_energy;
        if (simulation.step_count() == 0) first_energy = last_energy;
    });
    if (is_root())
        fmt::print("middle {:.4g} to {:.4g} Pa, wall {:.4g} to {:.4g} Pa, energy {:.3f} of its start\n",
                   least[1], greatest[1], least[0], greatest[0], last_energy / first_energy);
    EXPECT_NEAR(greatest[1], expected, 1e-9 * expected);
    EXPECT_NEAR(least[1], -expected, 1e-9 * expected);
    EXPECT_NEAR(greatest[0], 2 * expected, 1e-9 * 2 * expected);
    EXPECT_NEAR(last_energy, first_energy, 0.05 * first_energy);  // the jump lies between two nodes
}

}  // namespace
}  // namespace talus::test
