#include "physics/solid/equation_of_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/hugoniot.hpp"
#include "tests/support/solid_materials.hpp"

namespace talus {
namespace {

struct Named {
    const char* name;
    Tillotson eos;
};
std::vector<Named> all() {
    return {{"basalt", test::basalt()},   {"aluminium", test::aluminium()},
            {"granite", test::granite()}, {"iron", test::iron()},
            {"ice", test::ice()},         {"water", test::water()},
            {"nylon", test::nylon()}};
}

/// c^2 from differences of the pressure.
template <class Eos>
double numerical_c2(const Eos& eos, double density, double energy, double energy_scale) {
    const double dr = 1e-5 * density, du = 1e-5 * energy_scale;
    const double dP_drho =
        (eos.pressure(density + dr, energy) - eos.pressure(density - dr, energy)) / (2 * dr);
    const double dP_du = (eos.pressure(density, energy + du) - eos.pressure(density, energy - du)) / (2 * du);
    return dP_drho + eos.pressure(density, energy) / (density * density) * dP_du;
}

TEST(Tillotson, SoundSpeedIsThatOfThePressure) {
    for (const auto& [name, eos] : all()) {
        const double energies[] = {0.01 * eos.E_iv, 0.7 * eos.E_iv, 0.5 * (eos.E_iv + eos.E_cv),
                                   1.5 * eos.E_cv, 20 * eos.E_cv};
        for (const double ratio : {0.3, 0.6, 0.9, 0.99, 1.01, 1.3, 2.5})
            for (const double u : energies) {
                const double rho = ratio * eos.reference_density;
                const double c2 = eos.state(rho, u).sound_speed_squared;
                EXPECT_NEAR(c2, numerical_c2(eos, rho, u, eos.E_iv),
                            1e-6 * (std::abs(c2) + eos.A / eos.reference_density))
                    << name << " at " << ratio << ", " << u;
            }
    }
}

TEST(Tillotson, AtRestItHasItsBulkModulus) {
    for (const auto& [name, eos] : all()) {
        EXPECT_EQ(eos.pressure(eos.reference_density, 0), 0) << name;
        const auto state = evaluate(eos, eos.reference_density, 0);
        EXPECT_NEAR(state.sound_speed, std::sqrt(eos.bulk_modulus() / eos.reference_density), 1e-9) << name;
    }
}

TEST(Tillotson, PressureIsContinuousAcrossAllBorders) {
    for (const auto& [name, eos] : all()) {
        const double tiny = 1e-11, tolerance = 1e-8 * eos.A;
        for (const double ratio : {0.05, 0.3, 0.7, 0.95, 0.9999})
            for (const double border : {eos.E_iv, eos.E_cv}) {
                const double rho = ratio * eos.reference_density;
                EXPECT_NEAR(eos.pressure(rho, border * (1 - tiny)), eos.pressure(rho, border * (1 + tiny)),
                            tolerance)
                    << name << " at " << ratio << ", " << border;
            }
        for (const double u : {0.0, 0.5 * eos.E_iv, 1.01 * eos.E_iv, 0.9 * eos.E_cv, 5 * eos.E_cv}) {
            const double rho = eos.reference_density;
            EXPECT_NEAR(eos.pressure(rho * (1 - tiny), u), eos.pressure(rho * (1 + tiny), u), tolerance)
                << name << " at rho0, " << u;
        }
    }
}

TEST(Tillotson, SoundSpeedJumpsOnlyByTheKinkOfTheBlend) {
    for (const auto& [name, eos] : all()) {
        const double tiny = 1e-11, rho0 = eos.reference_density;
        const double width = eos.E_cv - eos.E_iv;
        for (const double ratio : {0.3, 0.7, 0.95}) {
            const double rho = ratio * rho0;
            for (const double border : {eos.E_iv, eos.E_cv}) {
                const double jump = eos.state(rho, border * (1 + tiny)).sound_speed_squared -
                                    eos.state(rho, border * (1 - tiny)).sound_speed_squared;
                const double hot = eos.hot(rho, border).pressure, cold = eos.cold(rho, border).pressure;
                const double kink = eos.pressure(rho, border) * (hot - cold) / (rho * rho * width);
                EXPECT_NEAR(jump, border == eos.E_iv ? kink : -kink, 1e-7 * eos.A / rho0) << name;
            }
        }
        // At rho0 the hot and the cold form meet with one slope, so there is no jump for cold matter, for hot
        // matter or at rho0 in between.
        for (const double u : {0.5 * eos.E_iv, 0.5 * (eos.E_iv + eos.E_cv), 3 * eos.E_cv})
            EXPECT_NEAR(eos.state(rho0 * (1 - tiny), u).sound_speed_squared,
                        eos.state(rho0 * (1 + tiny), u).sound_speed_squared, 1e-7 * eos.A / rho0)
                << name;
    }
}

TEST(Tillotson, HotVapourIsAnIdealGas) {
    const Tillotson eos = test::basalt();
    const double rho = 1e-3 * eos.reference_density, u = 100 * eos.E_cv;
    EXPECT_NEAR(eos.pressure(rho, u) / (eos.a * rho * u), 1, 1e-12);
    EXPECT_NEAR(eos.state(rho, u).sound_speed_squared / (eos.a * (1 + eos.a) * u), 1, 1e-12);
}

TEST(Tillotson, ColdCutIsOffUntilAsked) {
    Tillotson eos = test::basalt();
    const double rho = 0.8 * eos.reference_density;
    EXPECT_LT(eos.pressure(rho, 0), 0);
    eos.cold_cut_ratio = 0.9;
    EXPECT_EQ(eos.pressure(rho, 0), 0);
    EXPECT_LT(eos.pressure(0.95 * eos.reference_density, 0), 0);
    EXPECT_GT(eos.pressure(rho, 2 * eos.E_cv), 0);
    // The blend starts from the cut cold form, so that P stays continuous in u.
    EXPECT_NEAR(eos.pressure(rho, eos.E_iv * (1 + 1e-11)), 0, 1);
    for (const double u : {0.6 * (eos.E_iv + eos.E_cv), 1.2 * eos.E_cv})
        EXPECT_NEAR(eos.state(rho, u).sound_speed_squared, numerical_c2(eos, rho, u, eos.E_iv), 1);
}

TEST(Tillotson, FloorActsWhereTheSquareIsNegative) {
    const Tillotson eos = test::basalt();
    const double rho = 0.1 * eos.reference_density;  // cold, stretched tenfold: dP/drho < 0
    EXPECT_LT(eos.state(rho, 0).sound_speed_squared, 0);
    EXPECT_DOUBLE_EQ(evaluate(eos, rho, 0).sound_speed, 0.01 * std::sqrt(eos.A / eos.reference_density));
}

TEST(Tillotson, ScanFindsTheImaginarySoundSpeedsAndIsFast) {
    for (const auto& [name, eos] : all()) {
        const std::clock_t start = std::clock();  // of the processor: the machine may be busy
        const ScanResult result = scan(eos);
        const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        EXPECT_LT(seconds, 0.02) << name;
        EXPECT_GT(result.points, 50000u);
        EXPECT_GT(result.imaginary, 0u) << name;
        EXPECT_GE(result.floored, result.imaginary);
        EXPECT_LT(result.worst_c2, 0);
        EXPECT_EQ(result.worst_c2, eos.state(result.at_density, result.at_energy).sound_speed_squared);
        EXPECT_LT(result.densest_imaginary, eos.reference_density) << name << ": no trouble in compression";
        RecordProperty(std::string("scan_") + name,
                       std::to_string(result.imaginary) + " of " + std::to_string(result.points) +
                           " states with c2 < 0, densest at rho/rho0 = " +
                           std::to_string(result.densest_imaginary / eos.reference_density));
    }
    // Cold compressed matter alone is sound everywhere.
    EXPECT_EQ(scan(test::basalt(), {1.0, 4.0}).imaginary, 0u);
}

TEST(Tillotson, HugoniotOfBasaltAndAluminium) {
    struct Row {
        double speed, pressure, shock_speed, compression;
    };
    const Row basalt_rows[] = {{1e3, 5.27e9, 3905, 1.147},
                               {3e3, 22.20e9, 5482, 1.377},
                               {5e3, 48.13e9, 7131, 1.540},
                               {1e4, 155.2e9, 11493, 1.770},
                               {2e4, 559.5e9, 20722, 1.933}};
    const Row aluminium_rows[] = {{1e3, 8.12e9, 6016, 1.091},
                                  {3e3, 30.28e9, 7477, 1.251},
                                  {5e3, 59.88e9, 8871, 1.392},
                                  {1e4, 163.7e9, 12126, 1.702},
                                  {2e4, 493.6e9, 18283, 2.207}};
    const auto check = [](const Tillotson& eos, const Row& row) {
        const auto shock = test::symmetric_impact(eos, eos.reference_density, 0, row.speed);
        EXPECT_NEAR(shock.pressure / row.pressure, 1, 1.2e-3) << row.speed;
        EXPECT_NEAR(shock.shock_speed / row.shock_speed, 1, 2e-4) << row.speed;
        EXPECT_NEAR(shock.density / eos.reference_density, row.compression, 6e-4) << row.speed;
    };
    for (const Row& row : basalt_rows) check(test::basalt(), row);
    for (const Row& row : aluminium_rows) check(test::aluminium(), row);
}

TEST(Tillotson, HugoniotOfAluminiumIsNearTheMeasuredOne) {
    // U = 5350 + 1.34 u_p: S. P. Marsh, LASL Shock Hugoniot Data (1980), aluminium 2024.
    for (const double up : {500.0, 1500.0, 2500.0}) {
        const auto shock = test::shock_behind_piston(test::aluminium(), 2700, 0, up);
        EXPECT_NEAR(shock.shock_speed / (5350 + 1.34 * up), 1, 0.03) << up;
    }
}

TEST(IdealGas, StrongShockCompressesToItsLimit) {
    const IdealGas gas{.gamma = 1.4};
    const auto shock = test::shock_behind_piston(gas, 1, 1e-6, 1000);
    EXPECT_NEAR(shock.density, 6, 1e-6);
    EXPECT_NEAR(shock.pressure, 1.2e6, 1);
}

TEST(IdealGas, SoundSpeed) {
    const IdealGas gas{.gamma = 5.0 / 3};
    EXPECT_NEAR(gas.state(2, 3).sound_speed_squared, gas.gamma * gas.pressure(2, 3) / 2, 1e-14);
    EXPECT_EQ(evaluate(gas, 1, -1).sound_speed, 0);
}

TEST(StiffenedGas, IsTheUsualFormWithAShiftedEnergy) {
    const StiffenedGas gas{.gamma = 4.4, .reference_density = 1000, .sound_speed = 1500};
    const double P_inf = 1000 * 1500.0 * 1500.0 / 4.4;
    EXPECT_EQ(gas.pressure(1000, 0), 0);
    EXPECT_NEAR(evaluate(gas, 1000, 0).sound_speed, 1500, 1e-9);
    for (const double rho : {800.0, 1000.0, 1300.0})
        for (const double u : {0.0, 1e5, 1e6}) {
            const double e = u + 1500.0 * 1500.0 / 3.4;  // u counted from the state of no pressure at rho0
            const double usual = 3.4 * rho * e - 4.4 * P_inf;
            EXPECT_NEAR(gas.pressure(rho, u), usual, 1e-9 * P_inf);
            EXPECT_NEAR(gas.state(rho, u).sound_speed_squared, 4.4 * (usual + P_inf) / rho, 1e-3);
            EXPECT_NEAR(gas.state(rho, u).sound_speed_squared, numerical_c2(gas, rho, u, 1e6), 1);
        }
}

TEST(LinearEquationOfState, HasOneSoundSpeed) {
    const LinearEquationOfState eos{.reference_density = 1000, .sound_speed = 10};
    EXPECT_DOUBLE_EQ(pressure(eos, 1010, 5), 1000);
    EXPECT_DOUBLE_EQ(evaluate(eos, 900, 5).sound_speed, 10);
}

TEST(EquationOfState, ArraysEqualSinglesAndRespectTheMask) {
    const EquationOfState equations[] = {
        test::basalt(), IdealGas{.gamma = 1.4},
        LinearEquationOfState{.reference_density = 1000, .sound_speed = 10},
        StiffenedGas{.gamma = 4.4, .reference_density = 1000, .sound_speed = 1500}};
    const std::vector<double> density = {2700, 2000, 1500, 4000, 2600}, energy = {0, 1e5, 8e6, 3e7, 4e7};
    const std::vector<std::uint8_t> body = {0, 1, 1, 0, 1};
    for (const EquationOfState& eos : equations) {
        std::vector<double> P(5), c(5), P_some(5, -1), c_some(5, -2);
        evaluate(eos, density, energy, P, c);
        evaluate(eos, density, energy, P_some, c_some, body, 1);
        for (std::size_t i = 0; i < 5; ++i) {
            const auto one = evaluate(eos, density[i], energy[i]);
            EXPECT_EQ(P[i], one.pressure);
            EXPECT_EQ(P[i], pressure(eos, density[i], energy[i]));
            EXPECT_EQ(c[i], one.sound_speed);
            EXPECT_EQ(P_some[i], body[i] == 1 ? P[i] : -1);
            EXPECT_EQ(c_some[i], body[i] == 1 ? c[i] : -2);
        }
    }
}

}  // namespace
}  // namespace talus
