#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "physics/sph/pass_support.hpp"
#include "tests/support/sph_sample.hpp"

namespace talus {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using test::SampleChoice, test::SphSample;

struct Plain {
    Vector3d x = Vector3d::Zero(), v = Vector3d::Zero(), acceleration = Vector3d::Zero();
    Matrix3d sigma = Matrix3d::Zero();  ///< stress tensor, tension positive [Pa]
    double m, rho, c, h, power = 0, viscous_speed = 0, acceleration_size = 0, power_size = 0;
};

std::vector<Plain> plain_particles(const ParticleSet& set) {
    const int D = set.dimension();
    std::vector<Plain> all(set.size());
    for (std::size_t i = 0; i < set.size(); ++i) {
        Plain& q = all[i];
        for (int a = 0; a < D; ++a) {
            q.x[a] = set.data(field::position, a)[i];
            q.v[a] = set.data(field::predicted_velocity, a)[i];
            q.sigma(a, a) = -set.data(field::pressure)[i];
        }
        if (set.has(field::predicted_stress))
            for (int a = 0; a < D; ++a)
                for (int b = 0; b < D; ++b)
                    for (int c = 0; c < component_count(Shape::symmetric_tensor, D); ++c)
                        if (const AxisPair axes = symmetric_axes(c, D);
                            axes.first == std::min(a, b) && axes.second == std::max(a, b))
                            q.sigma(a, b) += set.data(field::predicted_stress, c)[i];
        q.m = set.data(field::mass)[i];
        q.rho = set.data(field::predicted_density)[i];
        q.c = set.data(field::sound_speed)[i];
        q.h = set.data(field::smoothing_length)[i];
    }
    return all;
}

/// The equations once more, every pair in a double loop: symmetric stress over density squared, with the
/// artificial viscosity of J. J. Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, eqs 4.1, 4.2, half of
/// it on either side, and the mean of both kernels' gradients. Power: kinetic and internal together.
template <class Kernel>
void sum_pairs(std::vector<Plain>& all, const Kernel& kernel, const sph::Settings& settings) {
    for (Plain& i : all)
        for (const Plain& j : all) {
            const Vector3d r = i.x - j.x;
            const double d = r.norm();
            if (&i == &j || d >= kernel.support() * std::max(i.h, j.h)) continue;
            Vector3d gradient = Vector3d::Zero();
            for (const double h : {i.h, j.h}) gradient += 0.5 * kernel.factor(d * d, 1 / h) * r;
            const double h = (i.h + j.h) / 2, c = (i.c + j.c) / 2, rho = (i.rho + j.rho) / 2;
            const double approach = (i.v - j.v).dot(r);
            double viscosity = 0;
            if (approach < 0) {
                const double mu = h * approach / (d * d + 0.01 * h * h);
                viscosity = (-settings.viscosity_alpha * c * mu + settings.viscosity_beta * mu * mu) / rho;
                i.viscous_speed = std::max(i.viscous_speed,
                                           settings.viscosity_alpha * c - 2 * settings.viscosity_beta * mu);
            }
            const Vector3d of_i = j.m * (i.sigma / (i.rho * i.rho) * gradient - viscosity / 2 * gradient),
                           of_j = j.m * (j.sigma / (j.rho * j.rho) * gradient - viscosity / 2 * gradient);
            i.acceleration += of_i + of_j;
            i.power += of_i.dot(j.v) + of_j.dot(i.v);
            i.acceleration_size += of_i.norm() + of_j.norm();
            i.power_size += of_i.norm() * j.v.norm() + of_j.norm() * i.v.norm();
        }
}

void expect_like_reference(const SampleChoice& choice, sph::KernelKind kind) {
    SphSample sample(choice);
    sample.settings.formulation = sph::Formulation::standard;
    sample.settings.kernel = kind;
    ParticleSet& set = sample.particles;
    set.add(field::viscous_speed);
    std::vector<Plain> all = plain_particles(set);
    sph::PassCount count;
    count.work_of_cell.assign(sample.decomposition.own_cells().size(), 0.0);
    sph::standard_pass(set, sample.decomposition.table(), Cells::all, sample.settings, count);
    EXPECT_GT(count.pairs, set.size());
    sph::with_dimension(set, [&](auto dimension) {
        sph::with_kernel<dimension>(sample.settings,
                                    [&](const auto& kernel) { sum_pairs(all, kernel, sample.settings); });
    });
    constexpr double tolerance = 1e-12;  // of the sums of the terms' sizes: rounding of some hundred terms
    for (std::size_t i = 0; i < set.size(); ++i) {
        const Plain& q = all[i];
        SCOPED_TRACE(testing::Message() << choice.dimension << "D, particle " << i);
        for (int a = 0; a < choice.dimension; ++a)
            EXPECT_NEAR(set.data(field::acceleration, a)[i], q.acceleration[a],
                        tolerance * q.acceleration_size);
        EXPECT_NEAR(set.data(field::specific_power)[i], q.power, tolerance * q.power_size);
        EXPECT_NEAR(set.data(field::viscous_speed)[i], q.viscous_speed, tolerance * q.viscous_speed);
    }
}

TEST(StandardPass, AgreesWithAPlainDoubleLoop) {
    constexpr std::array<int, 4> sides = {0, 60, 16, 8};
    for (const int D : {1, 2, 3})
        for (const bool strength : {false, true})
            for (const bool variable_h : {false, true})
                for (const auto kind : {sph::KernelKind::gaussian, sph::KernelKind::cubic_spline,
                                        sph::KernelKind::wendland_c2, sph::KernelKind::wendland_c6})
                    expect_like_reference({.dimension = D,
                                           .side = sides[static_cast<std::size_t>(D)],
                                           .strength = strength,
                                           .variable_h = variable_h},
                                          kind);
}

}  // namespace
}  // namespace talus
