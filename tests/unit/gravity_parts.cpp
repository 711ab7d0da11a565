#include <gtest/gtest.h>

#include <cmath>

#include "domain/random.hpp"
#include "physics/gravity/group_forces.hpp"
#include "physics/sph/pass_support.hpp"

/// Parts of self-gravity, each against its definition.
namespace talus {
namespace {

constexpr RandomStream random_numbers{.seed = 3};

sph::Settings with(sph::KernelKind kind, double cutoff = 2) {
    sph::Settings settings;
    settings.kernel = kind;
    settings.cutoff = cutoff;
    return settings;
}

/// Mass of the kernel within q smoothing lengths, by the trapezoidal rule.
double mass_within(const sph::Settings& settings, double q) {
    double total = 0;
    constexpr int steps = 20000;
    sph::with_kernel<3>(settings, [&](const auto& kernel) {
        for (int k = 1; k <= steps; ++k) {
            const double s = q * k / steps;
            total += (k == steps ? 0.5 : 1.0) * 4 * M_PI * s * s * kernel.value(s * s, 1.0) * q / steps;
        }
    });
    return total;
}

struct KernelCase {
    sph::Settings settings;
    double tolerance;  ///< of the fit, see softening.hpp
};

TEST(GravitySoftening, IsTheFieldOfTheKernel) {
    using enum sph::KernelKind;
    for (const KernelCase& c : {KernelCase{with(gaussian, 2), 1e-6}, KernelCase{with(gaussian, 2.5), 1e-6},
                                KernelCase{with(gaussian, 4), 2e-4}, KernelCase{with(cubic_spline), 2e-4},
                                KernelCase{with(wendland_c2), 1e-6}, KernelCase{with(wendland_c4), 1e-6},
                                KernelCase{with(wendland_c6), 1e-6}}) {
        const auto softening = gravity::softening_of(c.settings);
        const double s = c.settings.kernel_support();
        EXPECT_EQ(softening.support, s);
        for (double q = 0.05 * s; q < s; q += 0.05 * s)
            EXPECT_NEAR(softening.force(q) * q * q * q, mass_within(c.settings, q), c.tolerance)
                << "kernel " << static_cast<int>(c.settings.kernel) << ", q = " << q;
        EXPECT_NEAR(softening.force(s) * s * s * s, 1, 1e-12) << "a point's beyond";
        EXPECT_NEAR(softening.potential(s) * s, 1, 1e-12);
        const double step = 1e-4;  // central difference: rounding 1e-12, truncation below 1e-7
        for (double q = 0.1 * s; q < 0.95 * s; q += 0.1 * s)
            EXPECT_NEAR((softening.potential(q + step) - softening.potential(q - step)) / (2 * step),
                        -q * softening.force(q), 1e-6);
    }
}

TEST(GravityKeys, OrderAndLevels) {
    using namespace gravity;
    for (const Cell cell : {Cell{0, 0, 0}, Cell{-1, 5, -70000}, Cell{cell_limit, -cell_limit, 3}})
        EXPECT_EQ(cell_of_morton(morton_of(cell)), cell);
    const TreeKey a{morton_of({6, 2, 4}), 0}, neighbour{morton_of({7, 2, 4}), 0},
        far{morton_of({-1, 2, 4}), 0}, within{a.cell, std::uint64_t{1} << 60};
    EXPECT_EQ(common_level(a, a), last_level);
    EXPECT_EQ(common_level(a, neighbour), cell_level - 1);
    EXPECT_EQ(common_level(a, far), 0);
    EXPECT_EQ(common_level(a, within), cell_level);
    EXPECT_EQ(digit(a, cell_level), 0u);
    EXPECT_EQ(digit(within, cell_level), 1u);
    EXPECT_EQ(digit(neighbour, cell_level - 1), digit(a, cell_level - 1) + 1);
    EXPECT_LT(far, a);
    EXPECT_EQ(cells_of(a, cell_level).first, a.cell);
    EXPECT_EQ(cells_of(a, cell_level).last, a.cell);
    EXPECT_EQ(cells_of(a, 0).first, 0u);
}

std::vector<gravity::Source> lump(std::size_t count) {
    std::vector<gravity::Source> sources(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::uint32_t a = 0; a < 3; ++a)
            sources[i].position[a] = (a == 0 ? 1.0 : 0.6) * (random_numbers.uniform(i, a) - 0.5);
        sources[i].mass = 1 + random_numbers.uniform(i, 3);
        sources[i].softening = 1e-3;
    }
    return sources;
}

gravity::Moments moments_of(std::span<const gravity::Source> sources) {
    gravity::Moments moments;
    for (const auto& source : sources) {
        moments.mass += source.mass;
        for (std::size_t a = 0; a < 3; ++a) moments.centre[a] += source.mass * source.position[a];
    }
    for (double& x : moments.centre) x /= moments.mass;
    for (const auto& source : sources) moments.add_part({source.mass, source.position, {}, {}});
    return moments;
}

TEST(GravityMoments, OfPartsAreThoseOfTheWhole) {
    const std::vector<gravity::Source> sources = lump(20);
    const gravity::Moments whole = moments_of(sources), one = moments_of({sources.data(), 7}),
                           other = moments_of({sources.data() + 7, 13});
    gravity::Moments both{whole.mass, whole.centre, {}, {}};
    both.add_part(one);
    both.add_part(other);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(both.second[k], whole.second[k], 1e-13);
    for (std::size_t k = 0; k < 10; ++k) EXPECT_NEAR(both.third[k], whole.third[k], 1e-13);
    const auto q = gravity::quadrupole_of(whole);
    EXPECT_NEAR(q[0] + q[1] + q[2], 0, 1e-13);
    const auto o = gravity::octupole_of(whole);
    EXPECT_NEAR(o[0] + o[5] + o[7], 0, 1e-13);
    EXPECT_NEAR(o[3] + o[1] + o[8], 0, 1e-13);
    EXPECT_NEAR(o[4] + o[6] + o[2], 0, 1e-13);
}

/// Greatest error of a lump's acceleration and potential by its multipoles at some distance, relative.
template <int order>
std::array<double, 2> far_error(double distance) {
    const std::vector<gravity::Source> sources = lump(20);
    const gravity::Moments moments = moments_of(sources);
    gravity::Targets<double> direct, multipole;
    direct.resize(8);
    for (std::size_t k = 0; k < 8; ++k) {
        std::array<double, 3> n{};
        double size = 0;
        for (std::uint32_t a = 0; a < 3; ++a) {
            n[a] = random_numbers.uniform(100 + k, a) - 0.5;
            size = std::hypot(size, n[a]);
        }
        for (std::size_t a = 0; a < 3; ++a)
            direct.position[a][k] = moments.centre[a] + distance * n[a] / size;
    }
    multipole = direct;
    std::vector<gravity::PointSource<double>> points;
    for (const auto& source : sources) points.push_back({source.position, source.mass});
    gravity::add_points(direct, points);
    gravity::add_nodes<order>(multipole, std::vector<gravity::NodeSource<double>>{
                                             {moments.centre, moments.mass, gravity::quadrupole_of(moments),
                                              gravity::octupole_of(moments)}});
    std::array<double, 2> error{};
    for (std::size_t k = 0; k < 8; ++k) {
        double error2 = 0;
        for (std::size_t a = 0; a < 3; ++a)
            error2 += std::pow(multipole.acceleration[a][k] - direct.acceleration[a][k], 2);
        error[0] = std::max(error[0], std::sqrt(error2) * distance * distance / moments.mass);
        error[1] = std::max(error[1], std::abs(multipole.potential[k] / direct.potential[k] - 1));
    }
    return error;
}

TEST(GravityMoments, ErrorFallsByThePowerOfTheOrder) {
    // The first multipole left out, l = order + 1, is (1/d)^l of the whole: doubling d divides by 2^l.
    const auto expect_order = [](auto far_error_at, int l) {
        const auto near = far_error_at(20.0), far = far_error_at(40.0);
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_NEAR(std::log2(near[k] / far[k]), l, 0.2) << "order " << l - 1;
    };
    expect_order(far_error<1>, 2);
    expect_order(far_error<2>, 3);
    expect_order(far_error<3>, 4);
    EXPECT_LT(far_error<3>(20.0)[0], 1e-5);
}

/// J. K. Salmon, M. S. Warren, J. Comput. Phys. 111 (1994) 136, section 5: the mass of a cell may lie in one
/// corner and a target next to a light particle in the opposite one; with cell size over distance as
/// criterion the error is then unbounded for theta > 1/sqrt(3).
TEST(GravityOpening, TakesNoLopsidedCellTogether) {
    gravity::OpeningTest opening{
        .relative = false, .theta2 = 0.81, .half_support = 1, .constant = 1, .accuracy = 1e-3, .order = 3};
    gravity::Node node{};  // of a cell of size 1, the light particle at (1, 1, 1)
    node.moments.mass = 1;
    node.radius = std::sqrt(3.0);
    const auto at = [](double x, double h) { return gravity::Target{{{x, x, x}, {x, x, x}}, h, 1e-2}; };
    EXPECT_FALSE(opening.accepts(node, at(1.05, 0.01))) << "1/(1.05 sqrt(3)) < 0.9 by the cell's size";
    EXPECT_FALSE(opening.accepts(node, at(1.11, 0.01)));
    EXPECT_TRUE(opening.accepts(node, at(1.12, 0.01)));
    EXPECT_FALSE(opening.accepts(node, at(1.12, 0.3))) << "within softening of what may be in it";
    EXPECT_FALSE(opening.accepts(node, at(-1.05, 0.01))) << "what is in it may be anywhere";
    opening.relative = true;  // (radius/d)^4 / d^2 < 1e-5
    EXPECT_FALSE(opening.accepts(node, at(4.6, 0.01)));
    EXPECT_TRUE(opening.accepts(node, at(6.0, 0.01)));
}

TEST(GravityGap, IsFoundNotPassedOver) {
    using namespace gravity;
    Tree tree;
    tree.sources = {{{0, 0, 0}, 1, 0.01}, {{0.1, 0, 0}, 1, 0.01}};
    Node node{};
    node.moments = moments_of(tree.sources);
    node.target = {{{0, 0, 0}, {0.1, 0, 0}}, 0.01, 0};
    node.radius = 0.05;
    node.count = 2;
    node.is_leaf = node.is_here = true;
    tree.nodes = {node};
    const Group group{0, 2, node.target};
    const OpeningTest opening{
        .relative = false, .theta2 = 0.25, .half_support = 1, .constant = 1, .accuracy = 1e-3, .order = 3};
    const auto softening = softening_of(with(sph::KernelKind::gaussian));
    GroupForces<double> whole(tree, opening, softening, {1, 1});
    EXPECT_EQ(whole.evaluate(group).softened, 4u);
    EXPECT_FALSE(whole.found_gap());
    EXPECT_NEAR(whole.acceleration(0, 0), 100, 1e-10);
    tree.nodes[0].is_here = false;
    GroupForces<double> holed(tree, opening, softening, {1, 1});
    holed.evaluate(group);
    EXPECT_TRUE(holed.found_gap());
}

TEST(GravityPairs, ForcesAreOppositeAndSelfIsLeftOut) {
    const auto softening = gravity::softening_of(with(sph::KernelKind::gaussian));
    for (const double distance : {0.0, 0.3, 1.1, 2.4, 5.0}) {
        const std::vector<gravity::SoftSource<double>> sources{{{0, 0, 0}, 3, 1}, {{distance, 0, 0}, 2, 1.4}};
        gravity::Targets<double> targets;
        targets.resize(2);
        for (std::size_t k = 0; k < 2; ++k) {
            targets.position[0][k] = sources[k].position[0];
            targets.softening[k] = sources[k].softening;
        }
        targets.pad(2);
        gravity::add_softened(targets, sources, softening);
        EXPECT_DOUBLE_EQ(3 * targets.acceleration[0][0], -2 * targets.acceleration[0][1])
            << "at " << distance;
        EXPECT_DOUBLE_EQ(3 * targets.potential[0], 2 * targets.potential[1]) << "at " << distance;
        if (distance > 2.4) {
            EXPECT_NEAR(targets.acceleration[0][0], 2 / (distance * distance), 1e-15);
            EXPECT_NEAR(targets.potential[1], -3 / distance, 1e-15);
        }
    }
}

}  // namespace
}  // namespace talus
