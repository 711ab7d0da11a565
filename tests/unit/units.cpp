#include "io/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace talus {
namespace {

std::string failure_of(std::string_view text, std::string_view unit) {
    try {
        convert_to_si(text, unit);
    } catch (const UnitError& failure) {
        return failure.what();
    }
    return "accepted";
}

TEST(Units, ConvertToSi) {
    EXPECT_DOUBLE_EQ(convert_to_si("3.2 km/s", "m s-1"), 3200);
    EXPECT_DOUBLE_EQ(convert_to_si("2.7 g/cm^3", "kg m-3"), 2700);
    EXPECT_DOUBLE_EQ(convert_to_si("50 km", "m"), 50e3);
    EXPECT_DOUBLE_EQ(convert_to_si(" -7mm ", "m"), -7e-3);
    EXPECT_DOUBLE_EQ(convert_to_si("+1e2 µs", "s"), 1e-4);
    EXPECT_DOUBLE_EQ(convert_to_si("26.7 GPa", "Pa"), 26.7e9);
    EXPECT_DOUBLE_EQ(convert_to_si("4.87e8 J/kg", "J kg-1"), 4.87e8);
    EXPECT_DOUBLE_EQ(convert_to_si("20 degC", "K"), 293.15);
}

TEST(Units, AsAstronomersWriteThem) {
    EXPECT_DOUBLE_EQ(convert_to_si("1e12 kg", "kg"), 1e12);
    EXPECT_DOUBLE_EQ(convert_to_si("3e21 g", "kg"), 3e18);
    EXPECT_DOUBLE_EQ(convert_to_si("100 m/s", "m/s"), 100);
    EXPECT_DOUBLE_EQ(convert_to_si("2 h", "s"), 7200);
    EXPECT_DOUBLE_EQ(convert_to_si("6 hours", "s"), 21600);
    EXPECT_DOUBLE_EQ(convert_to_si("1.5 d", "s"), 129600);
    EXPECT_DOUBLE_EQ(convert_to_si("2 days", "s"), 172800);
    EXPECT_DOUBLE_EQ(convert_to_si("10 min", "s"), 600);
    EXPECT_DOUBLE_EQ(convert_to_si("1 yr", "s"), 31556925.9747);  // tropical
    EXPECT_DOUBLE_EQ(convert_to_si("1 Myr", "s"), 31556925.9747e6);
    EXPECT_DOUBLE_EQ(convert_to_si("2 au", "m"), 2 * 149597870700.0);  // IAU 2012, exact
    EXPECT_DOUBLE_EQ(convert_to_si("4 turns/d", "rad/s"), 8 * std::numbers::pi / 86400);
    EXPECT_DOUBLE_EQ(convert_to_si("360 deg/h", "rad/s"), 2 * std::numbers::pi / 3600);
    EXPECT_DOUBLE_EQ(convert_to_si("2 rpm", "rad/s"), 4 * std::numbers::pi / 60);
    EXPECT_DOUBLE_EQ(convert_to_si("2700 kg/m3", "kg/m3"), 2700);
    EXPECT_DOUBLE_EQ(convert_to_si("10 Mt", "kg"), 1e10);
}

// The double nearest to the decimal number, as if it had been written in SI units.
TEST(Units, PowersOfTenAreExact) {
    EXPECT_EQ(convert_to_si("50 us", "s"), 50e-6);
    EXPECT_EQ(convert_to_si("0.3 us", "s"), 0.3e-6);
    EXPECT_EQ(convert_to_si("-7 mm", "m"), -7e-3);
    EXPECT_EQ(convert_to_si("2.2E+1 ns", "s"), 22e-9);
    EXPECT_EQ(convert_to_si("1.1e-3 km", "m"), 1.1);
    EXPECT_EQ(convert_to_si("26.7 GPa", "Pa"), 26.7e9);
    EXPECT_EQ(convert_to_si("2.33 g/cm^3", "kg m-3"), 2330);
    EXPECT_EQ(convert_to_si("7 %", "1"), 0.07);
    EXPECT_EQ(convert_to_si("0 km", "m"), 0);
    EXPECT_FALSE(std::isfinite(convert_to_si("1e306 km", "m")));
}

TEST(Units, AnglesAreRadians) {
    EXPECT_DOUBLE_EQ(convert_to_si("30 deg", "rad"), std::numbers::pi / 6);
    EXPECT_DOUBLE_EQ(convert_to_si("30 degree", "rad"), std::numbers::pi / 6);
    EXPECT_DOUBLE_EQ(convert_to_si("30°", "rad"), std::numbers::pi / 6);
    EXPECT_DOUBLE_EQ(convert_to_si("2 rad", "rad"), 2);
}

TEST(Units, PureNumbers) {
    EXPECT_DOUBLE_EQ(convert_to_si("30 %", "1"), 0.3);
    EXPECT_DOUBLE_EQ(convert_to_si("0.25", "1"), 0.25);
}

TEST(Units, ErrorsSayFoundAndExpected) {
    EXPECT_EQ(failure_of("3 kg", "m"), "'3 kg' is a mass; expected: length [m]");
    EXPECT_EQ(failure_of("3", "m"), "'3' has no unit; expected: length [m]");
    EXPECT_EQ(failure_of("3 parsnips", "m s-1"), "unknown unit 'parsnips'; expected: velocity [m s-1]");
    EXPECT_EQ(failure_of("fast", "m s-1"), "'fast' does not begin with a number; expected: velocity [m s-1]");
    EXPECT_EQ(failure_of("3 kg7", "rad"), "'3 kg7' is of another dimension; expected: angle [rad]");
    EXPECT_EQ(failure_of("nan m", "m"), "'nan m' does not begin with a number; expected: length [m]");
    EXPECT_EQ(failure_of("", "m"), "'' does not begin with a number; expected: length [m]");
}

}  // namespace
}  // namespace talus
