#include "physics/dem/grain_rows.hpp"

#include "domain/grain_fields.hpp"

namespace talus::dem {

void GrainRows::reset(const ParticleSet& grains, std::span<const double> units) {
    values_.resize(grains.size_with_halo() * width);
    const double *radius = grains.data(field::radius), *mass = grains.data(field::mass);
    for (std::size_t i = 0; i < grains.size_with_halo(); ++i) {
        double* row = values_.data() + i * width;
        row[3] = radius[i];
        row[7] = mass[i];
        row[11] = 1 / units[i];
    }
}

void GrainRows::update(const ParticleSet& grains, std::size_t begin, std::size_t end) {
    std::array<const double*, 3> x, v, w;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        x[a] = grains.data(field::position, axis);
        v[a] = grains.data(field::predicted_velocity, axis);
        w[a] = grains.data(field::predicted_angular_velocity, axis);
    }
    for (std::size_t i = begin; i < end; ++i) {
        double* row = values_.data() + i * width;
        for (std::size_t a = 0; a < 3; ++a) {
            row[a] = x[a][i];
            row[4 + a] = v[a][i];
            row[8 + a] = w[a][i];
        }
    }
}

}  // namespace talus::dem
