#include "physics/dem/motion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "domain/grain_fields.hpp"
#include "physics/dem/rate_lanes.hpp"

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

namespace {

/// The components of a field to change.
using Components = std::array<double*, 3>;
Components components(ParticleSet& grains, const Field<double>& field) {
    return {grains.data(field, 0), grains.data(field, 1), grains.data(field, 2)};
}

}  // namespace

void drift(ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
           const PeriodicPlaces& places) {
    const Components x = components(grains, field::position), v = components(grains, field::velocity);
    for (std::size_t i = 0; i < grains.size(); i += lane_count) {
        const std::size_t count = std::min(lane_count, grains.size() - i);
        const LanesOfRates rate = load_rates(rates, i, count);
        for (std::size_t a = 0; a < 3; ++a) {
            const Lanes moved = time_step * (load_first(v[a] + i, count) + 0.5 * time_step * rate[a]);
            store_first(x[a] + i, count, load_first(x[a] + i, count) + places(static_cast<int>(a), moved));
        }
    }
}

void begin_kick(ParticleSet& grains, std::span<ForceSum> rates, double time_step, std::size_t begin,
                std::size_t end) {
    const double half = 0.5 * time_step;
    const Components v = components(grains, field::velocity), w = components(grains, field::angular_velocity);
    for (std::size_t i = begin; i < end; i += lane_count) {
        const std::size_t count = std::min(lane_count, end - i);
        const LanesOfRates rate = load_rates(rates, i, count);
        for (std::size_t a = 0; a < 3; ++a) {
            store_first(v[a] + i, count, load_first(v[a] + i, count) + half * rate[a]);
            store_first(w[a] + i, count, load_first(w[a] + i, count) + half * rate[3 + a]);
        }
    }
    std::fill(rates.begin() + static_cast<std::ptrdiff_t>(begin),
              rates.begin() + static_cast<std::ptrdiff_t>(end), ForceSum{});
}

void keep_half_step(ParticleSet& grains) {
    const auto copy = [&](const Field<double>& from, const Field<double>& to) {
        for (int axis = 0; axis < 3; ++axis) std::ranges::copy(grains.own(from, axis), grains.data(to, axis));
    };
    copy(field::velocity, field::half_step_velocity);
    copy(field::angular_velocity, field::half_step_angular_velocity);
}

void put_rates(const ParticleSet& grains, std::span<ForceSum> rates) {
    for (int axis = 0; axis < 3; ++axis) {
        const double *a = grains.data(field::acceleration, axis),
                     *dw = grains.data(field::angular_acceleration, axis);
        for (std::size_t i = 0; i < grains.size(); ++i) {
            Rates of_grain = rates_in(rates[i]);
            of_grain.acceleration[axis] = a[i];
            of_grain.angular_acceleration[axis] = dw[i];
            rates[i] = in_place_of_sum(of_grain);
        }
    }
}

void put_accelerations(std::span<const ForceSum> rates, ParticleSet& grains) {
    for (int axis = 0; axis < 3; ++axis) {
        double *a = grains.data(field::acceleration, axis),
               *dw = grains.data(field::angular_acceleration, axis);
        for (std::size_t i = 0; i < grains.size(); ++i) {
            const Rates of_grain = rates_in(rates[i]);
            a[i] = of_grain.acceleration[axis];
            dw[i] = of_grain.angular_acceleration[axis];
        }
    }
}

double finish_step(ParticleSet& grains, std::span<ForceSum> sums, const Responses& responses,
                   const Vector3<>& gravity, const Impulse& impulse, double kick_step, double time_step,
                   double remaining) {
    const double half_kick = 0.5 * kick_step, half_step = 0.5 * time_step;
    const std::array<double, 3> g{gravity.x, gravity.y, gravity.z};
    const Components x = components(grains, field::position), v = components(grains, field::velocity),
                     w = components(grains, field::angular_velocity);
    const double* radius = grains.data(field::radius);
    const bool is_given = impulse.next > 0;
    Lanes most2 = 0, spoilt = 0;  // 0 unless a value is infinite or NaN
    for (std::size_t i = 0; i < grains.size(); i += lane_count) {
        const std::size_t count = std::min(lane_count, grains.size() - i);
        const auto values = [&](const double* from) { return load_first(from + i, count); };
        const LanesOfRates summed = load_rates(sums, i, count);  // whole numbers
        LanesOfRates rates;
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
            const Lanes velocity = remaining * (values(v[a]) + half_kick * now) + impulse.now * given;
            const Lanes turn = sum(3 + a) * angular;
            const Lanes spin = remaining * (values(w[a]) + half_kick * turn);
            store_first(v[a] + i, count, velocity);
            store_first(w[a] + i, count, spin);
            rates[a] = now;
            rates[3 + a] = turn;
            const Lanes moved = values(x[a]) +
                                time_step * (velocity + impulse.next * given + half_step * now) -
                                values(responses.start[a].data());
            moved2 += moved * moved;
            spoilt += spin * 0.0;
        }
        store_rates(sums, i, count, rates);
        spoilt += moved2 * 0.0;
        most2 = max(most2, moved2);
    }
    return all_of(spoilt == 0) ? hmax(most2) : std::numeric_limits<double>::infinity();
}

}  // namespace talus::dem
