#include <gtest/gtest.h>

#include "physics/coupling/drag.hpp"
#include "physics/coupling/lift.hpp"
#include "tests/support/root_of.hpp"

namespace talus::coupling {
namespace {

constexpr double gravity = 9.81;
using std::numbers::pi;
using test::root_of;

/// Total force of the fluid, with the part of the pressure gradient, over that of Stokes at the superficial
/// velocity.
template <class Law>
double total(const Law& law, double fluid_fraction, double reynolds) {
    return law.resistance({fluid_fraction, reynolds}) / fluid_fraction;
}

// The forces below were worked out from the papers' formulas by a program of its own (Python, double
// precision).
TEST(Drag, TotalForcesOfPackedBedsAndSuspensions) {
    struct Row {
        double fraction, reynolds, di_felice, gidaspow, koch_hill, beetstra;
    };
    constexpr Row rows[] = {
        {0.40, 0.1, 75.257, 78.277, 93.873, 94.615},     {0.40, 10, 84.307, 93.316, 106.051, 102.986},
        {0.40, 100, 225.157, 230.035, 216.756, 224.474}, {0.60, 0.1, 11.323, 15.477, 18.541, 19.688},
        {0.60, 10, 15.821, 19.933, 20.771, 22.440},      {0.60, 100, 42.254, 60.442, 41.041, 51.236},
        {0.70, 0.1, 5.511, 7.317, 9.451, 10.022},        {0.70, 10, 8.375, 10.123, 10.782, 11.828},
        {0.70, 100, 22.368, 35.633, 22.884, 28.126},     {0.99, 0.1, 1.091, 1.080, 1.274, 1.249},
        {0.99, 10, 2.004, 1.812, 1.738, 1.892},          {0.99, 100, 5.351, 4.767, 5.960, 5.718}};
    constexpr double printed = 0.00051;  // three digits behind the point
    for (const Row& r : rows) {
        EXPECT_NEAR(total(DiFelice{}, r.fraction, r.reynolds), r.di_felice, printed);
        EXPECT_NEAR(total(Gidaspow{}, r.fraction, r.reynolds), r.gidaspow, printed);
        EXPECT_NEAR(total(KochHill{}, r.fraction, r.reynolds), r.koch_hill, printed);
        EXPECT_NEAR(total(Beetstra{}, r.fraction, r.reynolds), r.beetstra, printed);
    }
}

// Drag coefficient (4/3) d beta/(rho |u - v|) of the blend, with the Reynolds number of the interstitial
// slip.
TEST(Drag, BlendOfHuilinAndGidaspow) {
    constexpr double reynolds[] = {0.1, 1, 10, 100, 1000};
    struct Row {
        double fraction, coefficient[5];
    };
    constexpr Row rows[] = {{0.4, {3001.62, 302.308, 32.3499, 5.34101, 2.63376}},
                            {0.8, {473.668, 50.6327, 7.19111, 2.29338, 1.53434}},
                            {0.9, {325.166, 36.0164, 5.31705, 1.37916, 0.563197}}};
    for (const Row& row : rows)
        for (std::size_t k = 0; k < 5; ++k) {
            const double found = 24 / reynolds[k] * row.fraction *
                                 HuilinGidaspow{}.resistance({row.fraction, row.fraction * reynolds[k]});
            EXPECT_NEAR(found / row.coefficient[k], 1, 1e-5) << row.fraction << ' ' << reynolds[k];
        }
    EXPECT_DOUBLE_EQ(HuilinGidaspow::share(0.8), 0.5);
    EXPECT_NEAR(HuilinGidaspow::share(0.79), 1 - 0.884142, 1e-6);
    EXPECT_NEAR(HuilinGidaspow::share(0.99), 1 - 0.006381, 1e-6);
}

TEST(Drag, OneSphereAlone) {
    for (const double reynolds : {1e-3, 0.1, 5.0, 400.0}) {
        EXPECT_DOUBLE_EQ(Stokes{}.resistance({1, reynolds}), 1);
        EXPECT_DOUBLE_EQ(SchillerNaumann{}.resistance({1, reynolds}),
                         WenYu{}.resistance({1, reynolds}));  // the same coefficient
        EXPECT_NEAR(SchillerNaumann{}.resistance({1, reynolds}), 1 + 0.15 * std::pow(reynolds, 0.687), 1e-12);
    }
    EXPECT_DOUBLE_EQ(SchillerNaumann{}.resistance({1, 5000}), 0.44 * 5000 / 24);
    EXPECT_NEAR(KochHill{}.resistance({1, 0}), 1, 1e-15);
    EXPECT_NEAR(Beetstra{}.resistance({1, 1e-9}), 1, 1e-6);
}

struct Fluid {
    double density, viscosity;
};
constexpr Fluid air{1.1839, 1.86e-5}, water{1000, 8.9e-4}, glycerol{1150, 8.9e-3};

/// Of a sphere [m/s].
double terminal_velocity(const DragLaw& law, const Fluid& f, double diameter, double density) {
    const double weight = pi / 6 * diameter * diameter * diameter * (density - f.density) * gravity;
    return root_of(
        [&](double v) {
            const Surroundings around{f.density, f.viscosity, 1};
            return v * drag_coefficient(law, PressureModel::a, around, diameter, v) - weight;
        },
        0, 100);
}

// Roots of the balance of weight, buoyancy and drag, to the digits given.
TEST(Drag, TerminalVelocities) {
    constexpr double sand = 2500;
    EXPECT_NEAR(terminal_velocity(DiFelice{}, air, 1e-4, sand), 0.500624, 1e-6);
    EXPECT_NEAR(terminal_velocity(DiFelice{}, water, 1e-4, sand), 7.60916e-3, 1e-8);
    EXPECT_NEAR(terminal_velocity(DiFelice{}, glycerol, 1e-4, sand), 8.38081e-4, 1e-9);
    EXPECT_NEAR(terminal_velocity(DiFelice{}, air, 1e-3, sand), 6.00074, 1e-5);
    EXPECT_NEAR(terminal_velocity(DiFelice{}, water, 1e-3, sand), 0.137922, 1e-6);
    EXPECT_NEAR(terminal_velocity(DiFelice{}, glycerol, 1e-3, sand), 0.0487297, 1e-7);
    EXPECT_NEAR(terminal_velocity(SchillerNaumann{}, air, 1e-4, sand), 0.541891, 1e-6);
    EXPECT_NEAR(terminal_velocity(SchillerNaumann{}, water, 1e-4, sand), 8.05676e-3, 1e-8);
    EXPECT_NEAR(terminal_velocity(SchillerNaumann{}, glycerol, 1e-4, sand), 8.21262e-4, 1e-9);
    EXPECT_NEAR(terminal_velocity(SchillerNaumann{}, water, 1e-3, sand), 0.150688, 1e-6);
    EXPECT_NEAR(terminal_velocity(Stokes{}, water, 1e-4, sand),
                (sand - 1000) * gravity * 1e-8 / (18 * 8.9e-4), 1e-9);
    EXPECT_NEAR(terminal_velocity(SchillerNaumann{}, {1.2, 1.8e-5}, 1e-4, 2000), 0.457536, 1e-6);
}

/// Pressure gradient of a flow through a bed at rest, of the total force on its grains [Pa/m].
double pressure_gradient(const DragLaw& law, const Fluid& f, double diameter, double fluid_fraction,
                         double superficial) {
    const Surroundings around{f.density, f.viscosity, fluid_fraction};
    const double slip = superficial / fluid_fraction;
    const double grains = (1 - fluid_fraction) / (pi / 6 * diameter * diameter * diameter);
    return grains * slip * drag_coefficient(law, PressureModel::b, around, diameter, slip);
}

// S. Ergun, Chem. Eng. Prog. 48 (1952) 89: 150 mu (1-e)^2 U/(e^3 d^2) + 1.75 rho (1-e) U^2/(e^3 d).
TEST(Drag, PressureDropOfPackedBed) {
    EXPECT_NEAR(pressure_gradient(Ergun{}, {1, 1e-5}, 1e-3, 0.4, 0.2), 2343.75, 1e-9);
    EXPECT_NEAR(0.0156 * pressure_gradient(Ergun{}, {10, 1.5e-3}, 1e-3, 0.451335, 0.01), 115.0906, 1e-4);
    EXPECT_NEAR(pressure_gradient(Gidaspow{}, {1, 1e-5}, 1e-3, 0.4, 0.2), 2343.75, 1e-9);
}

// Where the pressure bears the weight of the bed.
TEST(Drag, LeastVelocityOfFluidisation) {
    const auto velocity = [](const DragLaw& law, const Fluid& f, double diameter, double density,
                             double fraction) {
        return root_of(
            [&](double u) {
                return pressure_gradient(law, f, diameter, fraction, u) -
                       (1 - fraction) * (density - f.density) * gravity;
            },
            0, 10);
    };
    constexpr Fluid gas{1.2, 1.8e-5};
    EXPECT_NEAR(velocity(Ergun{}, gas, 1e-3, 2500, 0.42), 0.629066, 1e-6);
    EXPECT_NEAR(velocity(Ergun{}, gas, 5e-4, 2500, 0.42), 0.248521, 1e-6);
    EXPECT_NEAR(velocity(Ergun{}, {998, 1e-3}, 3e-3, 1390, 0.42), 0.0153265, 1e-7);
    EXPECT_NEAR(velocity(Ergun{}, {10, 1.5e-3}, 1e-3, 2000, 0.451335), 0.0145090, 1e-7);
}

// Superficial settling velocity of grains at even spacing in a closed column: total force = weight in water,
// so that the drag of model A is epsilon times that.
TEST(Drag, HinderedSettling) {
    const auto velocity = [](const Fluid& f, double diameter, double fraction) {
        const double weight = pi / 6 * diameter * diameter * diameter * (2500 - f.density) * gravity;
        const double slip = root_of(
            [&](double w) {
                return w * drag_coefficient(DiFelice{}, PressureModel::b, {f.density, f.viscosity, fraction},
                                            diameter, w) -
                       weight;
            },
            0, 10);
        return fraction * slip;
    };
    constexpr double fractions[] = {0.6, 0.7, 0.8, 0.9, 0.99};
    constexpr double fine_water[] = {8.130e-4, 1.635e-3, 2.957e-3, 4.912e-3, 7.304e-3},
                     coarse_glycerol[] = {6.831e-3, 0.01304, 0.02200, 0.03387, 0.04711};
    for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_NEAR(velocity(water, 1e-4, fractions[k]) / fine_water[k], 1, 4e-4);
        EXPECT_NEAR(velocity(glycerol, 1e-3, fractions[k]) / coarse_glycerol[k], 1, 4e-4);
    }
}

TEST(Drag, NoViscosityNoDrag) {
    EXPECT_EQ(drag_coefficient(DiFelice{}, PressureModel::a, {1000, 0, 0.5}, 1e-3, 1), 0);
}

// A grain that lags in a flow along x that grows with y is lifted to faster fluid; one that spins faster than
// the fluid in the sense of a rolling ball is lifted by Magnus's force as a ball with backspin.
TEST(Lift, Directions) {
    const ShearedSphere lagging{1000, 1e-3, 1e-3, {0.01, 0, 0}, {0, 0, -2.0}};
    const dem::Vector3<> lift = saffman_mei_lift(lagging);
    EXPECT_GT(lift.y, 0);
    EXPECT_EQ(lift.x, 0);
    // Re = 10, beta = 0.1: 1.615 d^2 sqrt(rho mu/w) w u times Mei's factor.
    const double factor = (1 - 0.3314 * std::sqrt(0.1)) * std::exp(-1.0) + 0.3314 * std::sqrt(0.1);
    EXPECT_NEAR(lift.y, 1.615 * 1e-6 * std::sqrt(0.5) * 2 * 0.01 * factor, 1e-18);
    const ShearedSphere flying{1000, 1e-3, 1e-3, {-1, 0, 0}, {}};  // moves along x through fluid at rest
    EXPECT_NEAR(magnus_lift(flying, {0, 0, 50}).y, pi / 8 * 1000 * 1e-9 * 50, 1e-15);
}

}  // namespace
}  // namespace talus::coupling
