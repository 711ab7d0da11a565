#include "src/water/gauges.hpp"

#include <algorithm>
#include <cmath>

#include "domain/coupling_fields.hpp"
#include "physics/sph/kernels.hpp"

namespace talus {

namespace {

/// A particle of water near a gauge or the line above it.
struct Sample {
    std::uint64_t id;
    std::size_t gauge;
    Point from_gauge, velocity;
    double volume, density, pressure;
};

/// Against gravity, as far as water bears it; zero if there is none.
Point upwards(const water::Settings& settings) {
    const Point& g = settings.bearing;
    const double strength = norm(g);
    return strength > 0 ? times(-1 / strength, g) : Point{};
}

class Sampling {
  public:
    explicit Sampling(const WaterSimulation& simulation)
        : settings_(simulation.setup().settings), up_(upwards(settings_)), box_(simulation.setup().box) {}

    std::vector<Sample> near(const WaterSimulation& simulation, std::span<const WaterGauge> gauges) const {
        const ParticleSet& particles = simulation.particles();
        const double* solid = particles.has(coupling_field::solid_fraction)
                                  ? particles.data(coupling_field::solid_fraction)
                                  : nullptr;
        std::vector<Sample> found;
        for (std::size_t i = 0; i < particles.size(); ++i) {
            if (!simulation.is_water(particles.data(field::body)[i])) continue;
            for (std::size_t k = 0; k < gauges.size(); ++k) {
                const Point offset = from_gauge(particles, i, gauges[k].place);
                if (!is_near(offset)) continue;
                const double density = particles.data(field::density)[i],
                             share = water::share_of_water(solid ? solid[i] : 0);
                Sample sample{particles.data(field::id)[i],
                              k,
                              offset,
                              {},
                              particles.data(field::mass)[i] / density,
                              density / share,
                              settings_.state.pressure(density / share)};
                for (int a = 0; a < particles.dimension(); ++a)
                    sample.velocity[static_cast<std::size_t>(a)] = particles.data(field::velocity, a)[i];
                found.push_back(sample);
            }
        }
        return found;
    }

    template <int D>
    WaterReading reading(std::span<const Sample> samples, const WaterGauge& gauge) const {
        const sph::WendlandC2<D> kernel;
        const double inverse_h = 1 / settings_.smoothing_length;
        double weights = 0;
        WaterReading found;
        Point velocity{};
        for (const Sample& s : samples) {
            const double weight = s.volume * kernel.value(dot(s.from_gauge, s.from_gauge), inverse_h);
            weights += weight;
            found.pressure += weight * (s.pressure - s.density * dot(settings_.bearing, s.from_gauge));
            velocity = plus(velocity, times(weight, s.velocity));
        }
        found.pressure = weights > 0 ? found.pressure / weights : 0;
        if (weights > 0) found.velocity = times(1 / weights, velocity);
        found.level = dot(up_, gauge.place) + height_of_surface<D>(samples);
        return found;
    }

  private:
    Point from_gauge(const ParticleSet& particles, std::size_t i, const Point& gauge) const {
        Point offset{};
        for (int axis = 0; axis < particles.dimension(); ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            offset[a] = particles.data(field::position, axis)[i] - gauge[a];
            const double length = box_.upper[a] - box_.lower[a];
            if (box_.boundary[a] == Boundary::periodic)
                offset[a] -= length * std::nearbyint(offset[a] / length);
        }
        return offset;
    }

    bool is_near(const Point& offset) const {
        const double above = std::max(dot(up_, offset), 0.0), reach = settings_.radius();
        const Point aside = minus(offset, times(above, up_));
        return dot(aside, aside) < reach * reach;
    }

    /// Above the gauge.
    template <int D>
    double height_of_surface(std::span<const Sample> samples) const {
        constexpr double dry = 0.25;  // more than a drop, less than a film of one particle
        const sph::WendlandC2<D> kernel;
        const double inverse_h = 1 / settings_.smoothing_length, step = settings_.smoothing_length / 8;
        double top = 0;
        for (const Sample& s : samples) top = std::max(top, dot(up_, s.from_gauge));
        if (norm(up_) == 0 || samples.empty()) return 0;
        std::vector<double> water;  // share of the kernel that is filled, from the gauge up
        for (double z = 0; z < top + settings_.radius() + step; z += step) {
            double filled = 0;
            for (const Sample& s : samples) {
                const Point r = minus(s.from_gauge, times(z, up_));
                filled += s.volume * kernel.value(dot(r, r), inverse_h);
            }
            water.push_back(filled);
        }
        const double half = 0.5 * *std::max_element(water.begin(), water.end());
        if (half < 0.5 * dry) return 0;
        std::size_t k = water.size() - 1;  // where there is none
        while (water[k] < half) --k;
        return step * (static_cast<double>(k) + (water[k] - half) / (water[k] - water[k + 1]));
    }

    const water::Settings& settings_;
    const Point up_;
    const Box& box_;
};

}  // namespace

std::vector<WaterReading> read_gauges(const WaterSimulation& simulation, std::span<const WaterGauge> gauges) {
    const Sampling sampling(simulation);
    const std::vector<Sample> mine = sampling.near(simulation, gauges);
    std::vector<Sample> all = simulation.comm().all_gather(std::span<const Sample>(mine));
    std::sort(all.begin(), all.end(), [](const Sample& a, const Sample& b) {
        return a.gauge != b.gauge ? a.gauge < b.gauge : a.id < b.id;
    });
    std::vector<WaterReading> readings;
    auto begin = all.begin();
    for (std::size_t k = 0; k < gauges.size(); ++k) {
        const auto end = std::find_if(begin, all.end(), [k](const Sample& s) { return s.gauge != k; });
        const std::span<const Sample> near(begin, end);
        readings.push_back(simulation.particles().dimension() == 2 ? sampling.reading<2>(near, gauges[k])
                                                                   : sampling.reading<3>(near, gauges[k]));
        begin = end;
    }
    return readings;
}

}  // namespace talus
