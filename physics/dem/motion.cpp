#include "physics/dem/motion.hpp"

#include <algorithm>
#include <bit>
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

void predict_half_step(ParticleSet& grains, double time_step) {
    const double half = 0.5 * time_step;
    predict(grains, half, field::velocity, field::acceleration, field::half_step_velocity);
    predict(grains, half, field::angular_velocity, field::angular_acceleration,
            field::half_step_angular_velocity);
}

double finish_step(ParticleSet& grains, std::span<const ForceSum> sums, const Responses& responses,
                   const Vector3<>& gravity, const Impulse& impulse, double kick_step, double time_step,
                   double remaining) {
    static_assert(sizeof(ForceSum) == 6 * sizeof(double));
    const double half_kick = 0.5 * kick_step, half_step = 0.5 * time_step;
    const std::array<double, 3> g{gravity.x, gravity.y, gravity.z};
    const Components x = components(grains, field::position), v = components(grains, field::velocity),
                     dv = components(grains, field::acceleration),
                     w = components(grains, field::angular_velocity),
                     dw = components(grains, field::angular_acceleration);
    const double* radius = grains.data(field::radius);
    const ForceSum none{};
    const bool is_given = impulse.next > 0;
    Lanes most2 = 0, spoilt = 0;  // 0 unless a value is infinite or NaN
    for (std::size_t i = 0; i < grains.size(); i += lane_count) {
        const std::size_t count = std::min(lane_count, grains.size() - i);
        const auto values = [&](const double* from) { return load_first(from + i, count); };
        std::array<const double*, lane_count> records;
        for (std::size_t lane = 0; lane < lane_count; ++lane)
            records[lane] = reinterpret_cast<const double*>(lane < count ? &sums[i + lane] : &none);
        std::array<Lanes, 6> summed;  // whole numbers
        for (std::size_t c = 0; c < 6; c += 2) load_two(records, c, summed[c], summed[c + 1]);
        const auto sum = [&](std::size_t c) {
            return std::experimental::static_simd_cast<Lanes>(std::bit_cast<IntegerLanes>(summed[c]));
        };
        const Lanes response = values(responses.acceleration.data());
        const Lanes size = select(first_lanes(count), values(radius), Lanes(1.0));
        const Lanes angular = response * (2.5 / size);  // over 2/5 m r^2, of units of force times r
        Lanes moved2 = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            Lanes around = g[a];
            if (impulse.steady[a]) around += values(impulse.steady[a]);
            const Lanes now = sum(a) * response + select(response > 0, around, Lanes(0.0));
            const Lanes given =
                is_given ? select(response > 0, values(impulse.acceleration[a]), Lanes(0.0)) : Lanes(0.0);
            const Lanes velocity =
                remaining * (values(v[a]) + half_kick * (values(dv[a]) + now)) + impulse.now * given;
            const Lanes turn = sum(3 + a) * angular;
            const Lanes spin = remaining * (values(w[a]) + half_kick * (values(dw[a]) + turn));
            store_first(v[a] + i, count, velocity);
            store_first(w[a] + i, count, spin);
            store_first(dv[a] + i, count, now);
            store_first(dw[a] + i, count, turn);
            const Lanes moved = values(x[a]) +
                                time_step * (velocity + impulse.next * given + half_step * now) -
                                values(responses.start[a].data());
            moved2 += moved * moved;
            spoilt += spin * 0.0;
        }
        spoilt += moved2 * 0.0;
        most2 = max(most2, moved2);
    }
    return all_of(spoilt == 0) ? hmax(most2) : std::numeric_limits<double>::infinity();
}

}  // namespace talus::dem
