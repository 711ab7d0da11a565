#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/dem/laws/time_step.hpp"
#include "tests/support/grain_collision.hpp"
#include "tests/support/wall_touch.hpp"

namespace talus::dem {
namespace {

constexpr double pi = std::numbers::pi;

template <class Real, class Elasticity>
using Everything = ContactLaw<Real, Elasticity, CoulombFriction<Real>, ElasticPlasticRolling<Real>,
                              ContactAreaTwisting<Real>, PullOff<Real>>;
template <class Real, class Elasticity>
using WithConstantTorque = ContactLaw<Real, Elasticity, CoulombFriction<Real>, ConstantRollingTorque<Real>,
                                      ContactAreaTwisting<Real>, NoSurfaceForce<Real>>;
using PullingHertz = Everything<double, HertzMindlin<double>>;
using PullingLinear = Everything<double, LinearSpring<double>>;
using RollingHertz = WithConstantTorque<double, HertzMindlin<double>>;
using StickyJkr = WithConstantTorque<double, JohnsonKendallRoberts<double>>;

PairProperties glass(double restitution, double friction) {
    PairProperties pair = equal_pair(5e7, 0.25, restitution, friction);
    pair.rolling_friction = 0.1;
    pair.rolling_damping = 0.3;
    pair.twisting_friction = friction;
    pair.work_of_adhesion = 0.5;
    return pair;
}

template <class Law>
Law make_law(const PairProperties& p, EndOfContact end = EndOfContact::cut_at_zero) {
    Law law;
    if constexpr (std::is_same_v<decltype(law.elasticity), LinearSpring<double>>)
        law.elasticity = linear_spring(p, 1e5, 2.0 / 7, end);
    else if constexpr (std::is_same_v<decltype(law.elasticity), HertzMindlinDisplacement<double>>)
        law.elasticity = {p.effective_modulus, p.effective_shear_modulus, 0, 0, 0};
    else if constexpr (std::is_same_v<decltype(law.elasticity), JohnsonKendallRoberts<double>>)
        law.elasticity = johnson_kendall_roberts(p);
    else
        law.elasticity = hertz_mindlin(p, end);
    law.friction = {p.friction};
    if constexpr (std::is_same_v<decltype(law.rolling), ElasticPlasticRolling<double>>)
        law.rolling = {p.rolling_friction, p.rolling_damping};
    if constexpr (std::is_same_v<decltype(law.rolling), ConstantRollingTorque<double>>)
        law.rolling = {p.rolling_friction};
    if constexpr (std::is_same_v<decltype(law.twisting), ContactAreaTwisting<double>>)
        law.twisting = {p.twisting_friction};
    if constexpr (std::is_same_v<decltype(law.surface_force), PullOff<double>>)
        law.surface_force = {2 * pi * p.work_of_adhesion, 1e-6, 1e-5};
    return law;
}

struct RandomPair {
    Grain<double> first, second;
    Vector3<double> separation;
};
RandomPair random_pair(RandomValues& random) {
    const auto grain = [&] {
        return Grain<double>{random.vector(1), random.vector(200), random(2e-3, 6e-3), random(1e-4, 1e-3)};
    };
    RandomPair pair{grain(), grain(), random.vector(1)};
    const double distance = (pair.first.radius + pair.second.radius) * random(0.97, 1.005);
    pair.separation = (distance / norm(pair.separation)) * pair.separation;
    return pair;
}

void expect_negated(const Vector3<double>& a, const Vector3<double>& b) {
    EXPECT_EQ(a.x, -b.x);
    EXPECT_EQ(a.y, -b.y);
    EXPECT_EQ(a.z, -b.z);
}

template <class Law>
class EveryLaw : public testing::Test {};
using Laws = testing::Types<WithFriction<LinearSpring<double>>, WithFriction<HertzMindlin<double>>,
                            RollingHertz, PullingHertz, PullingLinear, StickyJkr>;
TYPED_TEST_SUITE(EveryLaw, Laws, );

TYPED_TEST(EveryLaw, SecondSideSeesTheNegativeToTheBit) {
    RandomValues random(5);
    const auto law = make_law<TypeParam>(glass(0.6, 0.4));
    for (int sample = 0; sample < 300; ++sample) {
        RandomPair pair = random_pair(random);
        typename TypeParam::History history{}, reversed{};
        const Vector3<double> drift = random.vector(1e-5);
        for (int step = 0; step < 5; ++step) {  // with a history
            const double distance = norm(pair.separation), dt = 1e-6;
            const auto k = grain_kinematics(pair.separation, distance, pair.first, pair.second, dt);
            const auto l = grain_kinematics(-pair.separation, distance, pair.second, pair.first, dt);
            const ContactLoad<double> one = law(k, history), other = law(l, reversed);
            expect_negated(one.force, other.force);
            expect_negated(one.couple, other.couple);
            EXPECT_EQ(TypeParam::reversed(reversed), history);
            pair.separation += drift;
        }
    }
}

TYPED_TEST(EveryLaw, NoTouchNoForceAndNoHistory) {
    RandomValues random(5);
    const auto law = make_law<TypeParam>(glass(0.6, 0.4));
    RandomPair pair = random_pair(random);
    typename TypeParam::History history;
    history.fill(1e-7);
    pair.separation =
        (1.1 * (pair.first.radius + pair.second.radius) / norm(pair.separation)) * pair.separation;
    const auto load =
        law(grain_kinematics(pair.separation, norm(pair.separation), pair.first, pair.second, 1e-6), history);
    EXPECT_EQ(norm(load.force), 0);
    EXPECT_EQ(norm(load.couple), 0);
    EXPECT_EQ(history, typename TypeParam::History{});
}

TYPED_TEST(EveryLaw, PlaneWallIsAGrainOfInfiniteRadiusAndMass) {
    RandomValues random(5);
    const auto law = make_law<TypeParam>(glass(0.6, 0.4));
    for (int sample = 0; sample < 100; ++sample) {
        const Grain<double> grain{random.vector(1), random.vector(100), 3e-3, 2e-4};
        const Vector3<double> normal{0.6, 0, 0.8};
        const double overlap = random(1e-6, 5e-5), far = 1e5;
        const Grain<double> huge{{}, {}, far, 1e25};
        auto k = wall_kinematics<double>(normal, overlap, grain, {}, {}, 1e-6);
        auto g = grain_kinematics<double>((grain.radius + far - overlap) * normal,
                                          grain.radius + far - overlap, grain, huge, 1e-6);
        g.overlap = overlap;  // the difference of great numbers has no digits left
        typename TypeParam::History on_wall{}, on_grain{};
        const auto a = law(k, on_wall), b = law(g, on_grain);
        EXPECT_LE(norm(a.force - b.force), 1e-6 * norm(a.force));  // 3e-8 of the radius is missing
        EXPECT_LE(norm(a.couple - b.couple), 1e-6 * norm(a.couple));
    }
}

TYPED_TEST(EveryLaw, EnergyNeverGrowsAtAnyAngle) {
    // The leapfrog over the kink where a linear spring begins: (omega dt)^2/8 = 1.3e-5.
    constexpr double tolerance = 2e-5;
    for (const double restitution : {1.0, 0.9, 0.4})
        for (const double friction : {0.0, 0.1, 0.5, 10.0}) {
            const auto law = make_law<TypeParam>(glass(restitution, friction));
            Ball ball = make_ball(3e-3, 2500);
            ball.position = {0, 0, ball.radius};
            const double speed = 2,
                         dt = hertz_collision_time(glass(1, 0).effective_modulus, 3e-3, ball.mass, speed) /
                              600;
            for (int angle = 0; angle < 90; angle += 5) {
                const double radians = angle * pi / 180;
                ball.velocity = {speed * std::sin(radians), 0, -speed * std::cos(radians)};
                for (const double spin : {0.0, 1.0, -1.0}) {
                    ball.angular_velocity = {0, spin * speed / ball.radius, 0.3 * spin * speed / ball.radius};
                    const BallOnPlane<TypeParam> on_wall{.law = law, .ball = ball};
                    const auto w = collide(on_wall, dt);
                    EXPECT_TRUE(w.ended || norm(w.after.ball.velocity) < speed) << angle;
                    EXPECT_LT(kinetic_energy(w.after) / kinetic_energy(on_wall), 1 + tolerance)
                        << "wall, " << angle << " degrees, spin " << spin << ", e " << restitution << ", mu "
                        << friction;

                    TwoBalls<TypeParam> pair{.law = law, .first = ball, .second = make_ball(2e-3, 5000)};
                    pair.second.position = {0, 0, -pair.second.radius};
                    const auto g = collide(pair, dt);
                    EXPECT_LT(kinetic_energy(g.after) / kinetic_energy(pair), 1 + tolerance)
                        << "grain, " << angle << " degrees, spin " << spin << ", e " << restitution << ", mu "
                        << friction;
                }
            }
        }
}

/// Greatest kinetic energy at any time of elastic impacts of all angles, of what there was before.
template <class Law>
double greatest_energy_of_sticking_impacts() {
    BallOnPlane<Law> s{.law = make_law<Law>(glass(1, 10)), .ball = make_ball(3e-3, 2500)};
    s.ball.position = {0, 0, s.ball.radius};
    double greatest = 0;
    for (double angle = 0; angle < pi / 2; angle += 0.02) {
        s.ball.velocity = {2 * std::sin(angle), 0, -2 * std::cos(angle)};
        greatest = std::max(greatest, collide(s, 5e-7).greatest_energy / kinetic_energy(s));
    }
    return greatest;
}

TEST(ContactLaws, DisplacementHistoryGainsEnergyWhileItSticks) {
    EXPECT_GT(greatest_energy_of_sticking_impacts<WithFriction<HertzMindlinDisplacement<double>>>(), 1.1);
    EXPECT_LT(greatest_energy_of_sticking_impacts<WithFriction<HertzMindlin<double>>>(), 1 + 2e-5);
}

TYPED_TEST(EveryLaw, MomentumAndAngularMomentumStay) {
    const auto law = make_law<TypeParam>(glass(0.7, 0.4));
    TwoBalls<TypeParam> s{.law = law, .first = make_ball(3e-3, 2500), .second = make_ball(2e-3, 5000)};
    s.first.position = {1e-3, 0, 3e-3};
    s.second.position = {0, -1e-3, -2e-3};
    s.first.velocity = {0.2, 0.3, -1};
    s.first.angular_velocity = {100, -30, 50};
    s.second.angular_velocity = {20, 80, -200};
    const auto angular = [](const TwoBalls<TypeParam>& t) {
        const auto of = [](const Ball& b) {
            return b.mass * cross(b.position, b.velocity) + b.inertia() * b.angular_velocity;
        };
        return of(t.first) + of(t.second);
    };
    const Vector3<double> before = angular(s);
    const auto c = collide(s, 1e-7);
    EXPECT_LT(norm(angular(c.after) - before), 1e-12 * norm(before));
    EXPECT_LT(norm(s.first.mass * s.first.velocity - c.after.first.mass * c.after.first.velocity -
                   c.after.second.mass * c.after.second.velocity),
              1e-14 * s.first.mass);
}

TYPED_TEST(EveryLaw, StoredDisplacementsTurnWithTheContact) {
    // A pair that bears friction, rolling and twisting turns as a whole, once round its normal and once round
    // an axis across it: what it bears turns with it. 1e-3: first order in the angle of a step.
    const auto law = make_law<TypeParam>(glass(1, 1e3));
    const double dt = 1e-6;
    for (const Vector3<double>& axis :
         {Vector3<double>{0, 0, 1}, Vector3<double>{1, 0, 0}, Vector3<double>{0.6, 0, 0.8}}) {
        ContactKinematics<double> k{.overlap = 1e-5,
                                    .normal = {0, 0, 1},
                                    .velocity = {0.1, 0.05, 0},
                                    .angular_velocity = {3, 5, 2},
                                    .summed_angular_velocity = {},
                                    .effective_radius = 1e-3,
                                    .effective_mass = 1e-4,
                                    .effective_inertia = 1e-10,
                                    .time_step = dt};
        typename TypeParam::History history{};
        for (int step = 0; step < 10; ++step) law(k, history);
        k.velocity = k.angular_velocity = {};
        const ContactLoad<double> before = law(k, history);
        constexpr int steps = 20000;
        const double angle = 2 * pi / steps;
        k.summed_angular_velocity = (2 * angle / dt) * axis;
        ContactLoad<double> after;
        for (int step = 1; step <= steps; ++step) {
            const Vector3<double> n{0, 0, 1};
            const double turned = step * angle;
            k.normal = std::cos(turned) * n + std::sin(turned) * cross(axis, n) +
                       (1 - std::cos(turned)) * dot(axis, n) * axis;
            after = law(k, history);
            if (step == steps / 3) {
                EXPECT_GT(norm(after.force - before.force), 0.1 * norm(tangential_part(before.force, n)));
            }
        }
        EXPECT_LT(norm(after.force - before.force), 1e-3 * norm(before.force));
        EXPECT_LE(norm(after.couple - before.couple), 1e-3 * norm(before.couple));
    }
}

template <template <class> class Law>
void expect_lanes_agree() {
    RandomValues random(5);
    const auto law = make_law<Law<double>>(glass(0.6, 0.4));
    const auto wide = in_all_lanes<Law<Lanes>>(law);
    std::vector<RandomPair> pairs;
    std::array<typename Law<double>::History, lane_count> histories{};
    typename Law<Lanes>::History wide_history{};
    for (std::size_t lane = 0; lane < lane_count; ++lane) pairs.push_back(random_pair(random));
    const auto lanes_of = [&](auto&& value) { return Lanes([&](auto lane) { return value(pairs[lane]); }); };
    const auto vector_of = [&](auto&& value) {
        return Vector3<Lanes>{lanes_of([&](const RandomPair& p) { return value(p).x; }),
                              lanes_of([&](const RandomPair& p) { return value(p).y; }),
                              lanes_of([&](const RandomPair& p) { return value(p).z; })};
    };
    const auto grain_of = [&](auto&& side) {
        return Grain<Lanes>{vector_of([&](const RandomPair& p) { return side(p).velocity; }),
                            vector_of([&](const RandomPair& p) { return side(p).angular_velocity; }),
                            lanes_of([&](const RandomPair& p) { return side(p).radius; }),
                            lanes_of([&](const RandomPair& p) { return side(p).mass; })};
    };
    for (int step = 0; step < 20; ++step) {
        const Vector3<Lanes> separation = vector_of([](const RandomPair& p) { return p.separation; });
        const auto k = grain_kinematics(separation, norm(separation),
                                        grain_of([](const RandomPair& p) { return p.first; }),
                                        grain_of([](const RandomPair& p) { return p.second; }), Lanes(1e-6));
        const ContactLoad<Lanes> together = wide(k, wide_history);
        for (std::size_t lane = 0; lane < lane_count; ++lane) {
            RandomPair& p = pairs[lane];
            const auto load = law(grain_kinematics(p.separation, norm(p.separation), p.first, p.second, 1e-6),
                                  histories[lane]);
            EXPECT_EQ(load.force, (Vector3<double>{together.force.x[lane], together.force.y[lane],
                                                   together.force.z[lane]}));
            EXPECT_EQ(load.couple, (Vector3<double>{together.couple.x[lane], together.couple.y[lane],
                                                    together.couple.z[lane]}));
            for (std::size_t c = 0; c < histories[lane].size(); ++c)
                EXPECT_EQ(histories[lane][c], wide_history[c][lane]);
            p.separation += random.vector(1e-5);
        }
    }
}
template <class Real>
using WidePulling = Everything<Real, HertzMindlin<Real>>;
template <class Real>
using WideLinear = WithConstantTorque<Real, LinearSpring<Real>>;
template <class Real>
using WideJkr = WithConstantTorque<Real, JohnsonKendallRoberts<Real>>;
TEST(ContactLaws, LanesGiveTheBitsOfSingles) {
    expect_lanes_agree<WidePulling>();
    expect_lanes_agree<WideLinear>();
    expect_lanes_agree<WideJkr>();
}

TEST(ContactLaws, FrictionIsCappedAndKeepsWhatItBears) {
    const auto law = make_law<WithFriction<HertzMindlin<double>>>(glass(0.6, 0.4));
    ContactKinematics<double> k{.overlap = 1e-5,
                                .normal = {0, 0, 1},
                                .velocity = {0.5, 0, 0},
                                .angular_velocity = {},
                                .summed_angular_velocity = {},
                                .effective_radius = 1e-3,
                                .effective_mass = 1e-4,
                                .effective_inertia = 1e-10,
                                .time_step = 1e-6};
    std::array<double, 3> history{};
    for (int step = 0; step < 1000; ++step) {
        const auto load = law(k, history);
        EXPECT_LE(std::abs(load.force.x), 0.4 * load.force.z * (1 + 1e-12));
    }
    const double gamma_t = law.elasticity.tangential_damping *
                           std::sqrt(4.0 / 3 * law.elasticity.effective_modulus * 1e-4 * k.effective_mass);
    for (const double speed :
         {0.01, 0.002}) {  // the spring bears what the dashpot leaves of the cap, and keeps it
        k.velocity = {speed, 0, 0};
        for (int step = 0; step < 20000; ++step) law(k, history);
        k.velocity = {};
        const auto at_rest = law(k, history);
        EXPECT_NEAR(-at_rest.force.x / (0.4 * at_rest.force.z - gamma_t * speed), 1, 0.02);
    }
}

TEST(Cohesion, JkrPullsOffAtThePublishedForceAndTearsAtThePublishedGap) {
    PairProperties pair = glass(1, 0);
    const auto law = make_law<StickyJkr>(pair);
    const double R = 1e-3, E = pair.effective_modulus, w = pair.work_of_adhesion;
    StickyJkr::History history{};
    ContactKinematics<double> k{.overlap = -1e-9,
                                .normal = {0, 0, 1},
                                .velocity = {},
                                .angular_velocity = {},
                                .summed_angular_velocity = {},
                                .effective_radius = R,
                                .effective_mass = 1e-4,
                                .effective_inertia = 1e-10,
                                .time_step = 0};
    EXPECT_EQ(norm(law(k, history).force), 0);  // not before they touch
    k.overlap = 1e-12;
    EXPECT_NEAR(law(k, history).force.z / (-8.0 / 9 * 1.5 * pi * w * R), 1,
                1e-3);  // at zero overlap: 8/9 F_c
    const double reach = law.reach(R);
    EXPECT_NEAR(reach / (0.75 * std::cbrt(pi * pi * w * w * R / (E * E))), 1, 1e-12);  // K. L. Johnson (1985)
    double strongest = 0;
    for (int step = 0; step < 10000; ++step) {
        k.overlap = 2e-5 - (2e-5 + reach) * step / 10000.0;
        const double force = law(k, history).force.z;
        strongest = std::min(strongest, force);
        if (step == 0) {
            EXPECT_GT(force, 0);
        }
    }
    EXPECT_NEAR(strongest / (-1.5 * pi * w * R), 1, 1e-6);
    k.overlap = -(1 - 1e-8) * reach;
    EXPECT_NEAR(law(k, history).force.z / (-5.0 / 9 * 1.5 * pi * w * R), 1, 1e-3);  // when it tears: 5/9 F_c
    k.overlap = -1.0001 * reach;
    EXPECT_EQ(norm(law(k, history).force), 0);
    k.overlap = -0.5 * reach;  // and does not come back across the gap
    EXPECT_EQ(norm(law(k, history).force), 0);
}

TEST(Cohesion, ElasticJkrImpactLosesTheWorkOfTheNeck) {
    // 7.09 (w^5 R^4/E^2)^(1/3): C. Thornton, Z. Ning, Powder Technol. 99 (1998) 154, eq. 33.
    const PairProperties pair = glass(1, 0);
    const auto law = make_law<StickyJkr>(pair);
    const double R = 1e-3, w = pair.work_of_adhesion;
    const double work =
        7.09 * std::cbrt(std::pow(w, 5) * std::pow(R, 4) / (pair.effective_modulus * pair.effective_modulus));
    BallOnPlane<StickyJkr> s{.law = law, .ball = make_ball(R, 2500)};
    s.ball.position = {0, 0, 1.0001 * R};
    for (const double times : {1.1, 4.0}) {
        s.ball.velocity = {0, 0, -std::sqrt(2 * times * work / s.ball.mass)};
        const auto c = collide(s, 1e-8);
        ASSERT_TRUE(c.ended);
        EXPECT_NEAR((kinetic_energy(s) - kinetic_energy(c.after)) / work, 1, 0.01);
    }
    s.ball.velocity = {0, 0, -std::sqrt(2 * 0.9 * work / s.ball.mass)};
    for (int step = 0; step < 30000; ++step) s.step(1e-7);  // 3 ms, it swings to and fro in 0.2 ms
    EXPECT_GT(s.overlap, -law.reach(R));
}

TEST(Cohesion, PullOffHoldsAcrossTheGapAndPressesFriction) {
    const PullOff<double> pull{.force_per_radius = 3, .separation = 1e-6, .greatest_gap = 5e-6};
    ContactKinematics<double> k{};
    k.effective_radius = 2e-3;
    k.overlap = 1e-6;
    EXPECT_DOUBLE_EQ(pull(k), 6e-3);
    k.overlap = -1e-6;
    EXPECT_DOUBLE_EQ(pull(k), 1.5e-3);
    k.overlap = -5.1e-6;
    EXPECT_EQ(pull(k), 0);

    // A weightless grain held by its pull bears friction up to mu times the pull.
    const auto law = make_law<PullingHertz>(glass(0.5, 0.4));
    BallOnPlane<PullingHertz> s{.law = law, .ball = make_ball(1e-3, 2500)};
    s.ball.position = {0, 0, s.ball.radius};
    const double held = 2 * pi * 0.5 * 1e-3;
    for (const double share : {0.9, 1.1}) {
        BallOnPlane<PullingHertz> t = s;
        t.law.rolling.coefficient = 10;  // slides, does not roll
        for (int step = 0; step < 20000; ++step) t.step(1e-7);
        t.gravity = {share * 0.4 * held / t.ball.mass, 0, 0};
        for (int step = 0; step < 20000; ++step) t.step(1e-7);
        const double fallen = 0.5 * norm(t.gravity) * 2e-3 * 2e-3;
        EXPECT_EQ(t.ball.position.x > 0.02 * fallen, share > 1) << t.ball.position.x / fallen;
    }
}

TEST(Lubrication, FilmTakesTheSpeedThatItsIntegralSays) {
    // m dv/dh = c (1/h - 1/H): v - v_0 = -(c/m) (ln(H/h) - (H - h)/H), c = 6 pi eta R^2.
    const Lubrication<double> film{.viscosity = 1e-3, .roughness = 1e-8, .greatest_gap = 1e-4};
    Ball ball = make_ball(1e-3, 2500);
    ball.velocity = {0, 0, -0.1};
    double gap = 1e-4;
    const double dt = 1e-8;
    while (gap > 1e-6) {
        const auto k = wall_kinematics<double>({0, 0, 1}, -gap, ball, {}, {}, dt);
        ball.kick({0, 0, -film(k)}, {}, dt);
        gap += ball.velocity.z * dt;
    }
    const double c = 6 * pi * 1e-3 * 1e-6;
    const double expected = -0.1 + c / ball.mass * (std::log(1e-4 / gap) - (1e-4 - gap) / 1e-4);
    EXPECT_NEAR(ball.velocity.z / expected, 1, 1e-3);
    EXPECT_LT(std::abs(ball.velocity.z), 0.097);
}

}  // namespace
}  // namespace talus::dem
