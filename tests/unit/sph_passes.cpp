#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "physics/sph/godunov_pair.hpp"
#include "tests/support/sph_sample.hpp"

namespace talus {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;
using sph::Interpolation;
using test::SampleChoice, test::SphSample;

/// The equations written once more, plainly: every pair in a double loop, vectors of three components of
/// which the first D are used, kernel constants by quadrature.
struct Plain {
    Vector3d x = Vector3d::Zero(), v = Vector3d::Zero(), grad_p = Vector3d::Zero(), grad_v = Vector3d::Zero();
    Matrix3d stress = Matrix3d::Zero(), velocity_gradient = Matrix3d::Zero(), curvature = Matrix3d::Zero();
    double m, rho, p, c, h;
    int body;

    // Sums and, for the tolerance, the sums of their terms' sizes.
    Vector3d acceleration = Vector3d::Zero();
    double power = 0, acceleration_size = 0, power_size = 0;
    double grad_p_size = 0, grad_v_size = 0, velocity_gradient_size = 0, curvature_size = 0;
};

class Reference {
  public:
    Reference(const SphSample& sample) : D_(sample.particles.dimension()), settings_(sample.settings) {
        const ParticleSet& set = sample.particles;
        for (std::size_t i = 0; i < set.size(); ++i) {
            Plain q;
            for (int a = 0; a < D_; ++a) {
                q.x[a] = set.data(field::position, a)[i];
                q.v[a] = set.data(field::predicted_velocity, a)[i];
            }
            if (set.has(field::predicted_stress)) q.stress = symmetric(set, field::predicted_stress, i);
            q.m = set.data(field::mass)[i];
            q.rho = set.data(field::predicted_density)[i];
            q.p = set.data(field::pressure)[i];
            q.c = set.data(field::sound_speed)[i];
            q.h = set.data(field::smoothing_length)[i];
            q.body = set.data(field::body)[i];
            all.push_back(q);
        }
        const int steps =
            4000;  // Simpson's rule for the integral of exp(-q^2) - exp(-cutoff^2) over the ball
        double integral = 0;
        const double cut = settings_.cutoff, width = cut / steps;
        for (int k = 0; k <= steps; ++k) {
            const double q = k * width, surface = D_ == 1 ? 2 : D_ == 2 ? 2 * M_PI * q : 4 * M_PI * q * q;
            const double weight = k == 0 || k == steps ? 1 : k % 2 == 1 ? 4 : 2;
            integral += weight * width / 3 * surface * (std::exp(-q * q) - std::exp(-cut * cut));
        }
        norm_ = 1 / integral;
        gradients();
        if (set.has(field::volume_curvature)) curvatures();
        forces(set.has(field::predicted_stress));
    }

    Matrix3d symmetric(const ParticleSet& set, const Field<double>& field, std::size_t i) const {
        Matrix3d tensor = Matrix3d::Zero();
        for (int c = 0; c < component_count(Shape::symmetric_tensor, D_); ++c) {
            const AxisPair axes = symmetric_axes(c, D_);
            tensor(axes.first, axes.second) = tensor(axes.second, axes.first) = set.data(field, c)[i];
        }
        return tensor;
    }

    std::vector<Plain> all;

  private:
    Vector3d grad_w(const Vector3d& r, double h) const {
        if (r.norm() >= settings_.cutoff * h)
            return 0 * r;  // of the pair, the narrower kernel may have ended
        return -2 * norm_ / std::pow(h, D_ + 2) * std::exp(-r.squaredNorm() / (h * h)) * r;
    }

    void gradients() {
        for (Plain& i : all) {
            Matrix3d moment = Matrix3d::Zero(), velocity = Matrix3d::Zero();
            Vector3d pressure = Vector3d::Zero(), raw = Vector3d::Zero();
            for (const Plain& j : all) {
                const Vector3d r = i.x - j.x;
                if (&i == &j || r.norm() >= settings_.cutoff * i.h) continue;
                const Vector3d gw = grad_w(r, i.h);
                moment -= j.m / (0.5 * (i.rho + j.rho)) * r * gw.transpose();
                velocity += j.m / (0.5 * (i.rho + j.rho)) * (j.v - i.v) * gw.transpose();
                pressure += j.m / (0.5 * (i.rho + j.rho)) * (j.p - i.p) * gw;
                raw += j.m * gw;
                i.velocity_gradient_size +=
                    (j.m / (0.5 * (i.rho + j.rho)) * (j.v - i.v) * gw.transpose()).norm();
                i.grad_p_size += (j.m / (0.5 * (i.rho + j.rho)) * (j.p - i.p) * gw).norm();
                i.grad_v_size += (j.m * gw).norm() / (i.rho * i.rho);
            }
            for (int a = D_; a < 3; ++a) moment(a, a) = 1;
            const Matrix3d correction =
                moment.determinant() > 0.01 ? Matrix3d(moment.inverse()) : Matrix3d(Matrix3d::Identity());
            i.velocity_gradient = velocity * correction;
            i.grad_p = correction * pressure;
            i.grad_v = -raw / (i.rho * i.rho);
            i.velocity_gradient_size *= correction.norm();
            i.grad_p_size *= correction.norm();
        }
    }

    void curvatures() {
        for (Plain& i : all)
            for (const Plain& j : all) {
                const Vector3d r = i.x - j.x;
                if (&i == &j || r.norm() >= settings_.cutoff * i.h) continue;
                const Matrix3d term = j.m / j.rho * j.grad_v * grad_w(r, i.h).transpose();
                i.curvature += 0.5 * (term + term.transpose());
                i.curvature_size += term.norm();
            }
    }

    /// Coefficients of V(s), constant term first.
    static std::array<double, 6> polynomial(Interpolation kind, double d, double V_i, double V_j, double s_i,
                                            double s_j, double k_i, double k_j) {
        const double dV = V_i - V_j, mean = (V_i + V_j) / 2;
        if (kind == Interpolation::linear) return {mean, dV / d, 0, 0, 0, 0};
        if (kind == Interpolation::cubic)
            return {mean - (s_i - s_j) * d / 8,
                    1.5 * dV / d - (s_i + s_j) / 4,
                    (s_i - s_j) / (2 * d),
                    (s_i + s_j) / (d * d) - 2 * dV / (d * d * d),
                    0,
                    0};
        return {mean - 5.0 / 32 * (s_i - s_j) * d + (k_i + k_j) * d * d / 64,
                15.0 / 8 * dV / d - 7.0 / 16 * (s_i + s_j) + (k_i - k_j) * d / 32,
                0.75 * (s_i - s_j) / d - (k_i + k_j) / 8,
                -5 * dV / (d * d * d) + 2.5 * (s_i + s_j) / (d * d) - (k_i - k_j) / (4 * d),
                -(s_i - s_j) / (2 * d * d * d) + (k_i + k_j) / (4 * d * d),
                6 * dV / std::pow(d, 5) - 3 * (s_i + s_j) / std::pow(d, 4) + (k_i - k_j) / (2 * d * d * d)};
    }

    /// <V^2> and s* = <s V^2>/<V^2> from the moments of a Gaussian of variance h^2/4.
    static std::array<double, 2> moments(const std::array<double, 6>& v, double h) {
        std::array<double, 12> gauss{};  // <s^n>
        gauss[0] = 1;
        for (std::size_t n = 2; n < 12; n += 2)
            gauss[n] = gauss[n - 2] * static_cast<double>(n - 1) * h * h / 4;
        double square = 0, first = 0;
        for (std::size_t a = 0; a < 6; ++a)
            for (std::size_t b = 0; b < 6; ++b) {
                square += v[a] * v[b] * gauss[a + b];
                first += v[a] * v[b] * gauss[a + b + 1];
            }
        return {square, first / square};
    }

    static std::array<double, 2> riemann(double rho_l, double p_l, double v_l, double c_l, double rho_r,
                                         double p_r, double v_r, double c_r, double s) {
        const double z_l = rho_l * c_l, z_r = rho_r * c_r;
        const double v_acoustic = (z_l * v_l + z_r * v_r + p_l - p_r) / (z_l + z_r);
        double w_l = std::max(rho_l * (c_l + s / 2 * (v_l - v_acoustic)), std::sqrt(0.1) * z_l);
        double w_r = std::max(rho_r * (c_r + s / 2 * (v_acoustic - v_r)), std::sqrt(0.1) * z_r);
        const auto pressure = [&] { return (p_l / w_l + p_r / w_r + v_l - v_r) / (1 / w_l + 1 / w_r); };
        const double p = pressure();
        w_l = std::sqrt(std::max(rho_l * (rho_l * c_l * c_l + s * (p - p_l)), 0.1 * z_l * z_l));
        w_r = std::sqrt(std::max(rho_r * (rho_r * c_r * c_r + s * (p - p_r)), 0.1 * z_r * z_r));
        return {pressure(), (w_l * v_l + w_r * v_r + p_l - p_r) / (w_l + w_r)};
    }

    void forces(bool strength) {
        for (Plain& i : all)
            for (const Plain& j : all) {
                const Vector3d r = i.x - j.x;
                const double d = r.norm();
                if (&i == &j || d >= std::sqrt(2) * settings_.cutoff * std::max(i.h, j.h)) continue;
                const Vector3d e = r / d;
                const Interpolation kind = i.p + j.p > 0 ? settings_.compressed : settings_.stretched;
                const auto along_pair = [&](Interpolation k, double h) {
                    return moments(polynomial(k, d, 1 / i.rho, 1 / j.rho, i.grad_v.dot(e), j.grad_v.dot(e),
                                              e.dot(i.curvature * e), e.dot(j.curvature * e)),
                                   h);
                };
                Vector3d G = Vector3d::Zero();
                double s = 0;
                for (const double h : {i.h, j.h}) {
                    auto [V2, centre] = along_pair(kind, h);
                    if (V2 > 10 / std::pow((i.rho + j.rho) / 2, 2)) {
                        const auto line = along_pair(Interpolation::linear, h);
                        V2 = line[0];
                        centre = line[1];
                    }
                    G += V2 * grad_w(r, std::sqrt(2) * h);
                    s += 0.5 * centre;
                }
                const double u_i = i.v.dot(e), u_j = j.v.dot(e);
                double du_i = e.dot(i.velocity_gradient * e), du_j = e.dot(j.velocity_gradient * e);
                double dp_i = i.grad_p.dot(e), dp_j = j.grad_p.dot(e);
                const bool gentle = settings_.second_order && 3 * (u_j - u_i) < std::min(i.c, j.c);
                const auto limit = [gentle](double& own, double& other, double secant) {
                    const bool same_sign = own * secant > 0 && other * secant > 0;
                    own = gentle && same_sign
                              ? std::copysign(std::min(std::abs(own), std::abs(secant)), secant)
                              : 0;
                    other = gentle && same_sign
                                ? std::copysign(std::min(std::abs(other), std::abs(secant)), secant)
                                : 0;
                };
                limit(du_i, du_j, (u_i - u_j) / d);
                limit(dp_i, dp_j, (i.p - j.p) / d);
                const double to_i = s - d / 2, to_j = s + d / 2;
                const auto [p_riemann, v_riemann] =
                    riemann(j.rho, j.p + dp_j * to_j, u_j + du_j * to_j, j.c, i.rho, i.p + dp_i * to_i,
                            u_i + du_i * to_i, i.c, settings_.shock_slope);
                double p = p_riemann;
                if (p < 0 && i.p > 0 && j.p > 0) p = (i.p + j.p) / 2;
                Vector3d v = (i.v + j.v) / 2 + (i.v - j.v) * s / d;
                if (settings_.riemann_velocity) v += (v_riemann - v.dot(e)) * e;
                Matrix3d stress = (i.stress + j.stress) / 2 + (i.stress - j.stress) * s / d;
                if (settings_.several_bodies && i.body != j.body) {
                    p = std::max(p, 0.0);
                    stress.setZero();
                }
                if (!strength) stress.setZero();
                const Vector3d force = j.m * (stress * G - p * G);
                i.acceleration += force;
                i.power += force.dot(v);
                i.acceleration_size += force.norm();
                i.power_size += force.norm() * v.norm();
            }
    }

    int D_;
    sph::Settings settings_;
    double norm_ = 0;
};

void expect_like_reference(const SampleChoice& choice, bool gas = false) {
    SphSample sample(choice, 1);
    if (gas) {
        sample.settings.riemann_velocity = true;
        sample.settings.shock_slope = 1.2;
        sample.settings.compressed = Interpolation::cubic;
    }
    sample.gradients();
    const sph::PassCount count = sample.forces();
    EXPECT_GT(count.pairs, sample.particles.size());
    const Reference reference(sample);
    const int D = choice.dimension;
    const ParticleSet& set = sample.particles;
    constexpr double tolerance = 1e-11;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const Plain& q = reference.all[i];
        SCOPED_TRACE(testing::Message() << D << "D, particle " << i);
        for (int a = 0; a < D; ++a) {
            EXPECT_NEAR(set.data(field::pressure_gradient, a)[i], q.grad_p[a], tolerance * q.grad_p_size);
            EXPECT_NEAR(set.data(field::volume_gradient, a)[i], q.grad_v[a], tolerance * q.grad_v_size);
            EXPECT_NEAR(set.data(field::acceleration, a)[i], q.acceleration[a],
                        tolerance * q.acceleration_size);
            for (int b = 0; b < D; ++b)
                EXPECT_NEAR(set.data(field::velocity_gradient, a * D + b)[i], q.velocity_gradient(a, b),
                            tolerance * q.velocity_gradient_size);
        }
        EXPECT_NEAR(set.data(field::specific_power)[i], q.power, tolerance * q.power_size);
        if (!choice.quintic) continue;
        const Matrix3d curvature = reference.symmetric(set, field::volume_curvature, i);
        EXPECT_LE((curvature - q.curvature).norm(), tolerance * q.curvature_size);
    }
}

constexpr std::array<int, 4> sides = {0, 60, 16, 8};
SampleChoice small(int dimension) {
    return {.dimension = dimension, .side = sides[static_cast<std::size_t>(dimension)]};
}

TEST(SphPasses, AgreeWithAPlainDoubleLoop) {
    for (const int D : {1, 2, 3})
        for (int options = 0; options < 16; ++options) {
            SampleChoice choice = small(D);
            choice.variable_h = (options & 1) != 0;
            choice.strength = (options & 2) != 0;
            choice.bodies = (options & 4) != 0;
            choice.quintic = (options & 8) != 0;
            expect_like_reference(choice);
        }
}

TEST(SphPasses, AgreeWithAPlainDoubleLoopForAGas) {
    for (const int D : {1, 2, 3}) {
        SampleChoice choice = small(D);
        choice.strength = false;
        choice.variable_h = D == 2;
        expect_like_reference(choice, true);
    }
}

std::vector<double> results(const ParticleSet& set) {
    std::vector<double> values;
    for (const Field<double>* field : {&field::velocity_gradient, &field::pressure_gradient,
                                       &field::volume_gradient, &field::acceleration, &field::specific_power})
        for (int c = 0; c < component_count(field->shape, set.dimension()); ++c) {
            const auto own = set.own(*field, c);
            values.insert(values.end(), own.begin(), own.end());
        }
    return values;
}

/// The same bits whether cells are visited all at once or first those that need no copies; also in a cloud
/// with gaps, where what the loops keep of the set does not move on in order.
TEST(SphPasses, DoNotDependOnTheSelectionOfCells) {
    for (const int D : {1, 2, 3})
        for (const bool variable_h : {false, true}) {
            SampleChoice choice = small(D);
            choice.gaps = variable_h && D > 1;
            choice.side = D == 3 ? (choice.gaps ? 24 : 14) : D == 2 && choice.gaps ? 48 : choice.side;
            choice.boundary = Boundary::periodic;
            choice.variable_h = variable_h;
            SphSample at_once(choice, 1), in_parts(choice, 1);
            at_once.gradients();
            const std::uint64_t pairs = at_once.forces().pairs;
            in_parts.gradients(Cells::interior);
            in_parts.gradients(Cells::boundary);
            const std::uint64_t inner = in_parts.forces(Cells::interior).pairs;
            EXPECT_EQ(inner + in_parts.forces(Cells::boundary).pairs, pairs);
            EXPECT_GT(inner, 0u);
            EXPECT_LT(inner, pairs);
            EXPECT_EQ(results(at_once.particles), results(in_parts.particles));
        }
}

/// Exchanging two particles changes the sign of the force, bit for bit: momentum is exact pair by pair.
template <int D, class Options>
void expect_antisymmetric() {
    using Places = sph::GodunovPlaces<D, Options>;
    using Particle = sph::GodunovParticle<Lanes, D, Options>;
    const RandomStream random{3};
    std::uint64_t id = 0;
    const auto particle = [&] {
        Particle p;
        for (Lanes& value : p.values) value = Lanes([&](auto) { return random.uniform(++id, 0) - 0.5; });
        for (const int place : {Places::mass, Places::density, Places::sound_speed, Places::specific_volume})
            p.values[static_cast<std::size_t>(place)] += 1.5;
        if constexpr (Options::variable_h) p.values[static_cast<std::size_t>(Places::h)] += 1.5;
        return p;
    };
    const sph::Gaussian<D> kernel(2);
    sph::Settings settings;
    if (Options::quintic) settings.compressed = Interpolation::quintic;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        const Particle i = particle(), j = particle();
        const auto on_i = sph::godunov_pair<D, Options>(i, j, Lanes(1.0), kernel, settings);
        const auto on_j = sph::godunov_pair<D, Options>(j, i, Lanes(1.0), kernel, settings);
        for (std::size_t d = 0; d < D; ++d) EXPECT_TRUE(all_of(on_i.force[d] == -on_j.force[d]));
        EXPECT_TRUE(all_of(on_i.power == -on_j.power));
    }
}

TEST(SphPasses, ForcesAreAntisymmetricToTheLastBit) {
    expect_antisymmetric<1, sph::GodunovOptions<true, true, true, false>>();
    expect_antisymmetric<2, sph::GodunovOptions<true, true, false, true>>();
    expect_antisymmetric<3, sph::GodunovOptions<true, false, false, true>>();
}

}  // namespace
}  // namespace talus
