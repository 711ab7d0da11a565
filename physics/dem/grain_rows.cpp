#include "physics/dem/grain_rows.hpp"

#include <algorithm>

#include "domain/grain_fields.hpp"
#include "physics/dem/rate_lanes.hpp"

namespace talus::dem {

void GrainRows::reset(const ParticleSet& grains, std::span<const double> units,
                      std::span<const std::uint8_t> material) {
    const std::size_t all = grains.size_with_halo();
    values_.assign(all * width, 0.0);
    material_.resize(all);
    const double *radius = grains.data(field::radius), *mass = grains.data(field::mass);
    const std::uint8_t* body = grains.data(field::body);
    for (std::size_t i = 0; i < all; ++i) {
        double* row = values_.data() + i * width;
        for (int axis = 0; axis < 3; ++axis) row[axis] = grains.data(field::position, axis)[i];
        row[3] = radius[i];
        row[10] = mass[i];
        row[11] = 1 / units[i];
        material_[i] = material[body[i]];
    }
}

namespace {

/// What predict() reads.
struct MotionFields {
    explicit MotionFields(const ParticleSet& grains) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto c = static_cast<std::size_t>(axis);
            x[c] = grains.data(field::position, axis);
            v[c] = grains.data(field::velocity, axis);
            w[c] = grains.data(field::angular_velocity, axis);
        }
    }
    std::array<const double*, 3> x, v, w;
};

}  // namespace

void GrainRows::predict(const ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
                        std::span<const std::uint32_t> some) {
    const MotionFields of(grains);
    for (const std::uint32_t i : some) {
        const Rates rate = rates_in(rates[i]);
        double* row = values_.data() + i * width;
        for (std::size_t c = 0; c < 3; ++c) {
            row[c] = of.x[c][i];
            row[4 + c] = of.v[c][i] + time_step * rate.acceleration[c];
            row[7 + c] = of.w[c][i] + time_step * rate.angular_acceleration[c];
        }
    }
}

void GrainRows::predict(const ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
                        std::size_t begin, std::size_t end) {
    const auto [x, v, w] = MotionFields(grains);
    const double* radius = grains.data(field::radius);
    std::array<double, width> none;  // where lanes without a grain store
    std::array<double*, lane_count> rows;
    for (std::size_t i = begin; i < end; i += lane_count) {
        const std::size_t count = std::min(lane_count, end - i);
        for (std::size_t lane = 0; lane < lane_count; ++lane)
            rows[lane] = lane < count ? values_.data() + (i + lane) * width : none.data();
        const auto values = [&](const double* from) { return load_first(from + i, count); };
        const LanesOfRates rate = load_rates(rates, i, count);
        const auto predicted = [&](const double* now, std::size_t c) {
            return values(now) + time_step * rate[c];
        };
        store_two(rows, 0, values(x[0]), values(x[1]));
        store_two(rows, 2, values(x[2]), values(radius));
        store_two(rows, 4, predicted(v[0], 0), predicted(v[1], 1));
        store_two(rows, 6, predicted(v[2], 2), predicted(w[0], 3));
        store_two(rows, 8, predicted(w[1], 4), predicted(w[2], 5));
    }
}

}  // namespace talus::dem
