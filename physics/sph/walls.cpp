#include "physics/sph/walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_tensors.hpp"

namespace talus::sph {

namespace {

using Vector3 = dem::Vector3<>;

template <int D>
Vector3 vector_at(const std::array<const double*, D>& components, std::size_t i) {
    Vector3 v{};
    v.x = components[0][i];
    if constexpr (D > 1) v.y = components[1][i];
    if constexpr (D > 2) v.z = components[2][i];
    return v;
}

/// R s R with the mirror R = 1 - 2 n n: shear on planes along the wall changes sign.
template <int D>
void mirror(std::array<double, symmetric_count<D>>& stress, const std::array<double, 3>& n) {
    std::array<double, std::size_t{D} * D> r{}, full{};
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) {
            r[a * D + b] = (a == b ? 1.0 : 0.0) - 2 * n[a] * n[b];
            full[a * D + b] = stress[symmetric_index<D>(std::min(a, b), std::max(a, b))];
        }
    for (int a = 0; a < D; ++a)
        for (int b = a; b < D; ++b) {
            double sum = 0;
            for (int c = 0; c < D; ++c)
                for (int d = 0; d < D; ++d) sum += r[a * D + c] * full[c * D + d] * r[d * D + b];
            stress[symmetric_index<D>(a, b)] = sum;
        }
}

/// Mean of the matter around a wall particle, weighed by the kernel.
template <int D>
struct Mean {
    double weight = 0, pressure = 0, density = 0;
    Vector3 velocity;
    std::array<double, symmetric_count<D>> stress{};
};

template <int D, class Kernel>
class WallPass {
  public:
    WallPass(ParticleSet& particles, const Kernel& kernel, double widening, std::span<const WallNow> walls)
        : kernel_(kernel),
          widening_(widening),
          walls_(walls),
          body_(particles.data(field::body)),
          h_(particles.data(field::smoothing_length)),
          x_(components<D>(particles, field::position)),
          v_(components_to_write<D>(particles, field::predicted_velocity)),
          density_(particles.data(field::predicted_density)),
          pressure_(particles.data(field::pressure)),
          has_stress_(particles.has(field::predicted_stress)),
          partners_(x_, h_, kernel.support() * widening) {
        if (has_stress_)
            stress_ = components_to_write<symmetric_count<D>>(particles, field::predicted_stress);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        const auto is_wall = [this](std::uint8_t body) { return walls_[body].is_wall; };
        if (std::none_of(body_ + cell.begin, body_ + cell.end, is_wall)) return;
        partners_.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            if (!is_wall(body_[i])) continue;
            partners_.find(i, kernel_.support() * widening_);
            store(i, mean_around(i));
        }
    }

  private:
    Vector3 velocity(std::size_t i) const {
        std::array<const double*, D> v;
        std::copy(v_.begin(), v_.end(), v.begin());
        return vector_at<D>(v, i);
    }

    Mean<D> mean_around(std::uint32_t i) const {
        const double inverse_h = 1 / (widening_ * h_[i]);
        const Vector3 x = vector_at<D>(x_, i), weight = walls_[body_[i]].weight;
        Mean<D> sum;
        for (const std::uint32_t j : partners_.index()) {
            if (walls_[body_[j]].is_wall) continue;
            const Vector3 r = x - vector_at<D>(x_, j);
            const double w = kernel_.value(dot(r, r), inverse_h);
            sum.weight += w;
            sum.pressure += w * (pressure_[j] + density_[j] * dot(weight, r));
            sum.density += w * density_[j];
            sum.velocity = sum.velocity + w * velocity(j);
            for (int c = 0; has_stress_ && c < symmetric_count<D>; ++c) sum.stress[c] += w * stress_[c][j];
        }
        return sum;
    }

    void store(std::uint32_t i, Mean<D> sum) {
        const WallNow& wall = walls_[body_[i]];
        const Vector3 own = wall.pose.velocity_at(vector_at<D>(x_, i));
        Vector3 v = own;
        if (sum.weight > 0) {
            const double share = 1 / sum.weight;
            const Vector3 relative = share * sum.velocity - own;
            v = wall.slips ? own + relative - 2 * dot(relative, wall.normal) * wall.normal : own - relative;
            density_[i] = share * sum.density;
            for (double& s : sum.stress) s *= share;
            if (wall.slips) mirror<D>(sum.stress, {wall.normal.x, wall.normal.y, wall.normal.z});
        }
        pressure_[i] = sum.weight > 0 ? std::max(0.0, sum.pressure / sum.weight) : 0.0;
        const std::array<double, 3> velocity{v.x, v.y, v.z};
        for (int d = 0; d < D; ++d) v_[d][i] = velocity[d];
        for (int c = 0; has_stress_ && c < symmetric_count<D>; ++c) stress_[c][i] = sum.stress[c];
    }

    const Kernel kernel_;
    const double widening_;
    std::span<const WallNow> walls_;
    const std::uint8_t* body_;
    const double* h_;
    std::array<const double*, D> x_;
    std::array<double*, D> v_;
    double *density_, *pressure_;
    const bool has_stress_;
    std::array<double*, symmetric_count<D>> stress_{};
    Partners<D> partners_;
};

}  // namespace

WallNow at_time(const Wall& wall, double time, const dem::Vector3<>& gravity) {
    const dem::WallMotion& motion = wall.motion;
    dem::Vector3<> acceleration;
    if (time >= motion.begin && time < motion.end) {
        const double omega = 2 * std::numbers::pi * motion.translation_oscillation.frequency,
                     angle = omega * (time - motion.begin) + motion.translation_oscillation.phase;
        acceleration = -omega * omega * std::sin(angle) * motion.amplitude;
    }
    return {.is_wall = true,
            .slips = wall.slip == WallSlip::free_slip,
            .normal = wall.normal,
            .pose = wall.motion.pose(time),
            .weight = gravity - acceleration};
}

namespace {

template <class Change>
void for_each_wall_particle(const ParticleSet& particles, std::span<const WallNow> walls, Change&& change) {
    if (walls.empty()) return;
    const std::uint8_t* body = particles.data(field::body);
    for (std::size_t i = 0; i < particles.size(); ++i)
        if (walls[body[i]].is_wall) change(i, walls[body[i]]);
}

}  // namespace

void move_walls(ParticleSet& particles, std::span<const WallNow> walls) {
    with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension;
        const auto x = components<D>(particles, field::position);
        const auto v = components_to_write<D>(particles, field::velocity);
        for_each_wall_particle(particles, walls, [&](std::size_t i, const WallNow& wall) {
            if (wall.moves_freely) return;
            const Vector3 velocity = wall.pose.velocity_at(vector_at<D>(x, i));
            const std::array<double, 3> all{velocity.x, velocity.y, velocity.z};
            for (int d = 0; d < D; ++d) v[d][i] = all[d];
        });
    });
}

void keep_walls(ParticleSet& particles, std::span<const WallNow> walls) {
    move_walls(particles, walls);
    const int dimension = particles.dimension();
    double* power = particles.data(field::specific_power);
    for_each_wall_particle(particles, walls, [&](std::size_t i, const WallNow&) {
        power[i] = 0;
        for (int a = 0; a < dimension; ++a) particles.data(field::acceleration, a)[i] = 0;
        if (!particles.has(field::velocity_gradient)) return;
        for (int c = 0; c < dimension * dimension; ++c) particles.data(field::velocity_gradient, c)[i] = 0;
    });
}

void wall_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
               std::span<const WallNow> walls) {
    const double widening = settings.force_support() / settings.kernel_support();
    with_dimension(particles, [&](auto dimension) {
        constexpr int D = dimension;
        with_kernel<D>(settings, [&]<class Kernel>(const Kernel& kernel) {
            WallPass<D, Kernel> pass(particles, kernel, widening, walls);
            table.for_each_own(which, [&pass](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
                pass.visit(cell, runs);
            });
        });
    });
}

}  // namespace talus::sph
