#include "physics/water/buffers.hpp"

#include <algorithm>
#include <cmath>

#include "domain/water_fields.hpp"
#include "physics/sph/pass_support.hpp"

namespace talus::water {

namespace {

template <int D>
class BufferPass {
  public:
    BufferPass(ParticleSet& particles, const Settings& settings, std::span<const Buffer> buffers)
        : settings_(settings),
          buffers_(buffers),
          body_(particles.data(field::body)),
          x_(sph::components<D>(particles, field::position)),
          v_(sph::components_to_write<D>(particles, field::velocity)),
          partner_v_(sph::components_to_write<D>(particles, water_field::partner_velocity)),
          volume_(particles.data(water_field::partner_volume)),
          partner_pressure_(particles.data(water_field::partner_pressure)),
          pressure_(particles.data(field::pressure)),
          density_(particles.data(field::density)),
          mass_(particles.data(field::mass)),
          seeing_(buffers.size(), 0) {}

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        for (std::uint32_t i = cell.begin; i < cell.end; ++i)
            if (buffers_[body_[i]].is_open()) carry(i, look(i, runs));
    }
    const std::vector<std::uint64_t>& seeing() const { return seeing_; }

  private:
    /// Means over the water in front.
    struct Front {
        double weight = 0, pressure = 0;  ///< pressure as at rest [Pa]
        double speed = 0;                 ///< along the axis [m/s]
    };

    Front look(std::uint32_t i, std::span<const Run> runs) const {
        const auto axis = static_cast<std::size_t>(buffers_[body_[i]].axis);
        const double rho0 = settings_.state.reference_density, c0 = settings_.state.sound_speed,
                     inverse = 1 / settings_.radius();
        Front front;
        for (const Run& run : runs)
            for (std::uint32_t k = run.begin; k < run.end; ++k) {
                if (!(volume_[k] > 0)) continue;
                double r2 = 0, depth = 0;
                for (std::size_t d = 0; d < D; ++d) {
                    const double r = x_[d][i] - x_[d][k];
                    r2 += r * r;
                    depth += settings_.bearing[d] * r;
                }
                const double q = std::sqrt(r2) * inverse, x = std::max(1 - q, 0.0);
                const double weight = x * x * x * x * (1 + 4 * q);
                front.weight += weight;
                front.pressure +=
                    weight * rho0 * (c0 * c0 * static_cast<double>(partner_pressure_[k]) + depth);
                front.speed += weight * c0 * static_cast<double>(partner_v_[axis][k]);
            }
        if (front.weight == 0) return front;
        front.pressure /= front.weight;
        front.speed /= front.weight;
        return front;
    }

    void carry(std::uint32_t i, const Front& front) {
        const Buffer& buffer = buffers_[body_[i]];
        const Tait& state = settings_.state;
        const auto axis = static_cast<std::size_t>(buffer.axis);
        if (front.weight > 0) ++seeing_[body_[i]];
        if (buffer.kind == Buffer::Kind::outflow && front.weight > 0) {
            v_[axis][i] = buffer.sign * std::max(0.0, buffer.sign * front.speed);
            partner_v_[axis][i] = static_cast<float>(v_[axis][i] / state.sound_speed);
        }
        if (!buffer.holds_pressure && front.weight == 0) return;  // it keeps what it has; nobody sees it
        pressure_[i] = std::max(0.0, buffer.holds_pressure ? held(buffer, i) : front.pressure);
        density_[i] = state.density(pressure_[i]);
        if (buffer.kind == Buffer::Kind::inflow) mass_[i] = density_[i] * buffer.particle_volume;
        partner_pressure_[i] = static_cast<float>(
            pressure_[i] / (state.reference_density * state.sound_speed * state.sound_speed));
        volume_[i] = -static_cast<float>(mass_[i] / (density_[i] * std::pow(settings_.radius(), D)));
    }

    double held(const Buffer& buffer, std::uint32_t i) const {
        const auto& g = settings_.bearing;
        double depth = std::hypot(g[0], g[1], g[2]) * buffer.surface.value_or(0);
        for (std::size_t d = 0; d < D; ++d) depth += g[d] * x_[d][i];
        const double weight = buffer.surface ? settings_.state.reference_density * std::max(depth, 0.0) : 0;
        return settings_.state.background_pressure + weight;
    }

    const Settings& settings_;
    std::span<const Buffer> buffers_;
    const std::uint8_t* body_;
    std::array<const double*, D> x_;
    std::array<double*, D> v_;
    std::array<float*, D> partner_v_;
    float *volume_, *partner_pressure_;
    double *pressure_, *density_, *mass_;
    std::vector<std::uint64_t> seeing_;
};

}  // namespace

void prepare_buffers(ParticleSet& particles, std::span<const Buffer> buffers) {
    const std::uint8_t* body = particles.data(field::body);
    float *volume = particles.data(water_field::partner_volume),
          *sticks = particles.data(water_field::partner_density);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!buffers[body[i]].is_open()) continue;
        volume[i] = -volume[i];
        sticks[i] = 1;
    }
}

std::vector<std::uint64_t> buffer_pass(ParticleSet& particles, const CellTable& table,
                                       const Settings& settings, std::span<const Buffer> buffers) {
    const auto run = [&](auto&& pass) {
        table.for_each_own(Cells::all, [&pass](const CellEntry& cell, std::span<const Run> runs,
                                               std::size_t) { pass.visit(cell, runs); });
        return pass.seeing();
    };
    if (particles.dimension() == 2) return run(BufferPass<2>(particles, settings, buffers));
    return run(BufferPass<3>(particles, settings, buffers));
}

}  // namespace talus::water
