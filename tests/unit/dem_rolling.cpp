#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/grain_collision.hpp"

// A ball of 5 mm on a plane under gravity (the case of J. Ai, J.-F. Chen, J. M. Rotter, J. Y. Ooi, Powder
// Technol. 206 (2011) 269), against rigid-body motion: the sphere rolls with 5/7 of what pulls it. The
// contact's depth of 4e-6 m = 8e-4 of the radius is what the tolerances allow for.

namespace talus::dem {
namespace {

constexpr double g = 9.81, radius = 5e-3, time_step = 1e-5;

template <class Rolling>
using RollingLaw = ContactLaw<double, HertzMindlin<double>, CoulombFriction<double>, Rolling,
                              TwistsFreely<double>, NoSurfaceForce<double>>;
using Free = RollingLaw<RollsFreely<double>>;
using Constant = RollingLaw<ConstantRollingTorque<double>>;
using ElasticPlastic = RollingLaw<ElasticPlasticRolling<double>>;

/// A ball that rests on a plane inclined by `slope` [rad] towards +x, pressed in as its weight says.
template <class Rolling>
BallOnPlane<RollingLaw<Rolling>> resting(const Rolling& rolling, double friction, double slope = 0) {
    const PairProperties pair = with_rigid_plane(1e7, 0.3, 0.3, friction);
    BallOnPlane<RollingLaw<Rolling>> s{
        .law = {hertz_mindlin(pair, EndOfContact::cut_at_zero), {friction}, rolling, {}, {}},
        .ball = make_ball(radius, 2500),
        .gravity = {g * std::sin(slope), 0, -g * std::cos(slope)}};
    const double weight = s.ball.mass * g * std::cos(slope);
    const double depth = std::pow(0.75 * weight / (pair.effective_modulus * std::sqrt(radius)), 2.0 / 3);
    s.ball.position = {0, 0, radius - depth};
    s.load.force = {0, 0, weight};
    return s;
}

/// Rolling along x without slip at `speed`.
template <class System>
void roll(System& s, double speed) {
    s.ball.velocity = {speed, 0, 0};
    s.ball.angular_velocity = {0, speed / radius, 0};
}

template <class System>
void advance(System& s, double duration) {
    const int steps = static_cast<int>(std::lround(duration / time_step));
    for (int step = 0; step < steps; ++step) s.step(time_step);
}

template <class System>
void expect_stops_by_rolling_resistance(System s) {
    // 0.7 v^2/(mu_r g) = 0.7136 m after v/(5/7 mu_r g) = 1.4271 s; at half of that time half as fast.
    roll(s, 1);
    advance(s, 1.4271 / 2);
    EXPECT_NEAR(s.ball.velocity.x, 0.5, 2e-3);
    EXPECT_NEAR(s.ball.angular_velocity.y * radius, 0.5, 2e-3);
    advance(s, 1.4271 / 2 + 0.05);
    EXPECT_NEAR(s.ball.position.x / 0.7136, 1, 3e-3);
}

TEST(Rolling, StopsAfterTheDistanceOfAConstantTorque) {
    expect_stops_by_rolling_resistance(resting(ConstantRollingTorque<double>{0.1}, 0.8));
    expect_stops_by_rolling_resistance(resting(ElasticPlasticRolling<double>{0.1, 0.3}, 0.8));
}

TEST(Rolling, ElasticPlasticModelComesToRestConstantTorqueSwings) {
    auto elastic_plastic = resting(ElasticPlasticRolling<double>{0.1, 0.3}, 0.8);
    auto constant = resting(ConstantRollingTorque<double>{0.1}, 0.8);
    roll(elastic_plastic, 0.2);
    roll(constant, 0.2);
    advance(elastic_plastic, 0.6);
    advance(constant, 0.6);
    EXPECT_LT(std::abs(elastic_plastic.ball.angular_velocity.y), 1e-6);
    EXPECT_LT(std::abs(elastic_plastic.ball.velocity.x), 1e-8);
    const double cap = 0.1 * radius * constant.ball.mass * g;
    EXPECT_LT(norm(elastic_plastic.load.couple), 1e-4 * cap);
    int turns = 0;  // the whole torque all the time, now one way, now the other
    for (int step = 0; step < 100; ++step) {
        const double before = constant.load.couple.y;
        constant.step(time_step);
        EXPECT_NEAR(norm(constant.load.couple) / cap, 1, 2e-3);
        turns += before * constant.load.couple.y < 0 ? 1 : 0;
    }
    EXPECT_GT(turns, 10);
}

TEST(Rolling, SlidingBallRollsWithoutSlipFromTheTextbookTime) {
    // mu = 0.3, 1 m/s: after 2 v/(7 mu g) = 0.09708 s and 12/49 v^2/(mu g) = 0.08321 m it rolls, at 5/7 of
    // its speed.
    auto s = resting(RollsFreely<double>{}, 0.3);
    s.ball.velocity = {1, 0, 0};
    advance(s, 0.95 * 0.09708);
    EXPECT_GT(s.ball.velocity.x - radius * s.ball.angular_velocity.y, 0.03);
    advance(s, 0.05 * 0.09708);
    EXPECT_NEAR(s.ball.position.x / 0.08321, 1, 3e-3);
    advance(s, 0.05);
    EXPECT_NEAR(s.ball.velocity.x, 5.0 / 7, 2e-3);
    EXPECT_NEAR(s.ball.velocity.x - radius * s.ball.angular_velocity.y, 0, 2e-3);
    EXPECT_NEAR(s.ball.position.x, 0.08321 + 0.05 * 5 / 7, 4e-4);
}

TEST(Rolling, FreeBallSlipsDownAnInclineSteeperThanThreeAndAHalfFrictions) {
    for (const double tangent : {0.5, 1.0, 1.1, 1.5}) {  // of 3.5 mu = 1.05
        const double slope = std::atan(tangent), duration = 0.1;
        auto s = resting(RollsFreely<double>{}, 0.3, slope);
        advance(s, duration);
        const double slip = s.ball.velocity.x - radius * s.ball.angular_velocity.y;
        const bool slips = tangent > 1.05;
        const double expected =
            slips ? g * (std::sin(slope) - 0.3 * std::cos(slope)) : 5.0 / 7 * g * std::sin(slope);
        EXPECT_NEAR(s.ball.velocity.x / (expected * duration), 1, 3e-3) << tangent;
        const double expected_slip = slips ? expected - 2.5 * 0.3 * g * std::cos(slope) : 0;
        EXPECT_NEAR(slip / duration, expected_slip, 0.03) << tangent;
    }
}

TEST(Rolling, InclineHoldsABallUpToRollingFrictionAndLetsItRollBeyond) {
    for (const double tangent : {0.05, 0.095, 0.105, 0.2}) {  // of mu_r = 0.1
        const double slope = std::atan(tangent), duration = 0.2;
        auto s = resting(ElasticPlasticRolling<double>{0.1, 0.3}, 0.8, slope);
        advance(s, 0.1);  // let go, the spring of rolling gives first
        const double before = s.ball.velocity.x;
        advance(s, duration);
        const double expected = tangent > 0.1 ? 5.0 / 7 * g * (std::sin(slope) - 0.1 * std::cos(slope)) : 0;
        EXPECT_NEAR((s.ball.velocity.x - before) / duration, expected, 1e-3 * g * tangent) << tangent;
        if (tangent < 0.1) {
            EXPECT_LT(std::abs(s.ball.velocity.x), 1e-7);
            EXPECT_LT(s.ball.position.x, 0.05 * radius);
        }
    }
}

}  // namespace
}  // namespace talus::dem
