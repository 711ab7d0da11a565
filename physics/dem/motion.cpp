#include "physics/dem/motion.hpp"

#include <algorithm>
#include <cmath>

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

void kick(double* velocity, double* acceleration, double now, double half_step) {
    *velocity += half_step * (*acceleration + now);
    *acceleration = now;
}

}  // namespace

void predict(ParticleSet& grains, double time_step) {
    predict(grains, time_step, field::velocity, field::acceleration, field::predicted_velocity);
    predict(grains, time_step, field::angular_velocity, field::angular_acceleration,
            field::predicted_angular_velocity);
}

double finish_step(ParticleSet& grains, std::span<const ForceSum> sums, const Responses& responses,
                   const Vector3<>& gravity, double kick_step, double time_step) {
    const double half_step = 0.5 * kick_step;
    const std::array<double, 3> g{gravity.x, gravity.y, gravity.z};
    std::vector<double> moved2(grains.size(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double *x = grains.data(field::position, axis), *start = responses.start[a].data();
        double *v = grains.data(field::velocity, axis), *dv = grains.data(field::acceleration, axis);
        double *w = grains.data(field::angular_velocity, axis),
               *dw = grains.data(field::angular_acceleration, axis);
        for (std::size_t i = 0; i < grains.size(); ++i) {
            const double response = responses.acceleration[i];
            kick(v + i, dv + i,
                 static_cast<double>(sums[i].force[a]) * response + (response > 0 ? g[a] : 0.0), half_step);
            kick(w + i, dw + i, static_cast<double>(sums[i].torque[a]) * responses.angular[i], half_step);
            const double moved = x[i] + time_step * (v[i] + 0.5 * time_step * dv[i]) - start[i];
            moved2[i] += moved * moved;
        }
    }
    double most = 0;
    for (const double m : moved2) most = std::max(most, m);
    return most;
}

}  // namespace talus::dem
