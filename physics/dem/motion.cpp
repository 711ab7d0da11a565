#include "physics/dem/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "domain/grain_fields.hpp"

namespace talus::dem {

PeriodicPlaces::PeriodicPlaces(const Box& box) {
    constexpr int bits = 50;
    for (std::size_t a = 0; a < 3; ++a) {
        if (box.boundary[a] != Boundary::periodic) continue;
        const double farthest =
            std::max({std::abs(box.lower[a]), std::abs(box.upper[a]), box.upper[a] - box.lower[a]});
        int exponent = 0;
        std::frexp(farthest, &exponent);
        shifts_[a] = std::ldexp(1.5, exponent + 52 - bits);
    }
}

Box PeriodicPlaces::aligned(Box box) const {
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        box.lower[a] = (*this)(axis, box.lower[a]);
        box.upper[a] = (*this)(axis, box.upper[a]);
    }
    return box;
}

void drift(ParticleSet& grains, double time_step, const PeriodicPlaces& places) {
    for (int axis = 0; axis < 3; ++axis) {
        double* x = grains.data(field::position, axis);
        const double *v = grains.data(field::velocity, axis), *a = grains.data(field::acceleration, axis);
        for (std::size_t i = 0; i < grains.size(); ++i)
            x[i] += places(axis, time_step * (v[i] + 0.5 * time_step * a[i]));
    }
}

namespace {

void predict(ParticleSet& grains, double time_step, const Field<double>& velocity,
             const Field<double>& acceleration, const Field<double>& predicted) {
    for (int axis = 0; axis < 3; ++axis) {
        const double *v = grains.data(velocity, axis), *a = grains.data(acceleration, axis);
        double* p = grains.data(predicted, axis);
        for (std::size_t i = 0; i < grains.size(); ++i) p[i] = v[i] + time_step * a[i];
    }
}

/// The components of a field to change.
using Components = std::array<double*, 3>;
Components components(ParticleSet& grains, const Field<double>& field) {
    return {grains.data(field, 0), grains.data(field, 1), grains.data(field, 2)};
}

}  // namespace

void predict(ParticleSet& grains, double time_step) {
    predict(grains, time_step, field::velocity, field::acceleration, field::predicted_velocity);
    predict(grains, time_step, field::angular_velocity, field::angular_acceleration,
            field::predicted_angular_velocity);
}

double finish_step(ParticleSet& grains, std::span<const ForceSum> sums, const Responses& responses,
                   const Vector3<>& gravity, double kick_step, double time_step, double remaining) {
    const double half_kick = 0.5 * kick_step, half_step = 0.5 * time_step;
    const std::array<double, 3> g{gravity.x, gravity.y, gravity.z};
    const Components x = components(grains, field::position), v = components(grains, field::velocity),
                     dv = components(grains, field::acceleration),
                     w = components(grains, field::angular_velocity),
                     dw = components(grains, field::angular_acceleration);
    double most2 = 0, spoilt = 0;  // 0 unless a value is infinite or NaN
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const double response = responses.acceleration[i], angular = responses.angular[i];
        double moved2 = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const double now = static_cast<double>(sums[i].force[a]) * response + (response > 0 ? g[a] : 0.0);
            const double velocity = remaining * (v[a][i] + half_kick * (dv[a][i] + now));
            const double turn = static_cast<double>(sums[i].torque[a]) * angular;
            w[a][i] = remaining * (w[a][i] + half_kick * (dw[a][i] + turn));
            v[a][i] = velocity;
            dv[a][i] = now;
            dw[a][i] = turn;
            const double moved = x[a][i] + time_step * (velocity + half_step * now) - responses.start[a][i];
            moved2 += moved * moved;
            spoilt += w[a][i] * 0.0;
        }
        spoilt += moved2 * 0.0;
        most2 = std::max(most2, moved2);
    }
    return spoilt == 0 ? most2 : std::numeric_limits<double>::infinity();
}

}  // namespace talus::dem
