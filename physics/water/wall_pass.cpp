#include <algorithm>
#include <array>
#include <cmath>

#include "domain/coupling_fields.hpp"
#include "domain/water_fields.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/water/neighbourhood.hpp"
#include "physics/water/passes.hpp"

namespace talus::water {

namespace {

template <int D>
class WallPass {
  public:
    WallPass(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls)
        : settings_(settings),
          walls_(walls),
          position_(sph::components<D>(particles, field::position)),
          velocity_(sph::components_to_write<D>(particles, field::predicted_velocity)),
          density_(particles.data(density_of_fluid(particles))),
          mass_(particles.data(field::mass)),
          pressure_(particles.data(field::pressure)),
          volume_(particles.data(water_field::partner_volume)),
          body_(particles.data(field::body)),
          inverse_h_(1 / settings.smoothing_length) {}

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        const auto is_wall = [](double volume) { return volume < 0; };
        if (std::none_of(volume_ + cell.begin, volume_ + cell.end, is_wall)) return;
        gather(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i)
            if (is_wall(volume_[i])) extrapolate(i);
    }

  private:
    static constexpr std::size_t at_position = 0, at_velocity = D, at_pressure = 2 * D,
                                 at_density = 2 * D + 1, value_count = 2 * D + 2;

    void gather(const CellEntry& cell, std::span<const Run> runs) {
        water_.clear(count_of(runs));
        for_each_near<D>(
            cell, runs, position_, settings_.radius(),
            [this](std::uint32_t k, std::size_t number, const std::array<Lanes, D>& x, const Lanes& excess) {
                const LaneMask is_water = load_first(volume_ + k, number) > 0;
                if (none_of(is_water)) return;
                std::array<Lanes, value_count> values;
                for (int d = 0; d < D; ++d) {
                    values[at_position + d] = x[d];
                    values[at_velocity + d] = load_first(velocity_[d] + k, number);
                }
                values[at_pressure] = load_first(pressure_ + k, number);
                values[at_density] = load_first(density_ + k, number);
                water_.append(select(is_water, excess, Lanes(1.0)), values);
            });
        std::array<double, value_count> nobody{};
        nobody[0] = far_away;
        water_.pad(nobody);
    }

    void extrapolate(std::uint32_t i) {
        const sph::WallNow& wall = walls_[body_[i]];
        const std::array<double, 3> weight{wall.weight.x, wall.weight.y, wall.weight.z};
        std::array<const double*, value_count> from;
        for (std::size_t c = 0; c < value_count; ++c) from[c] = water_.column(c);
        LaneSum all, pressure;
        std::array<LaneSum, D> velocity{};
        for (std::size_t k = 0; k < water_.size(); k += lane_count) {
            Lanes r2 = 0, depth = 0;
            for (int d = 0; d < D; ++d) {
                const Lanes r = position_[d][i] - load(from[at_position + d] + k);
                r2 += r * r;
                depth += weight[d] * r;
            }
            const Lanes share = sph::WendlandC2<D>::shape(sqrt(r2) * inverse_h_);
            all.add(k, share);
            pressure.add(k, share * (load(from[at_pressure] + k) + load(from[at_density] + k) * depth));
            for (int d = 0; d < D; ++d) velocity[d].add(k, share * load(from[at_velocity + d] + k));
        }
        const double total = all.total();
        std::array<double, D> mean{};
        for (int d = 0; d < D; ++d) mean[d] = total > 0 ? velocity[d].total() / total : 0;
        store(i, wall, total > 0, total > 0 ? pressure.total() / total : 0, mean);
    }

    void store(std::uint32_t i, const sph::WallNow& wall, bool wet, double pressure,
               const std::array<double, D>& water) {
        dem::Vector3<> place;
        place.x = position_[0][i];
        place.y = position_[1][i];
        if constexpr (D > 2) place.z = position_[2][i];
        const dem::Vector3<> moves = wall.pose.velocity_at(place);
        const std::array<double, 3> own{moves.x, moves.y, moves.z};
        for (int d = 0; d < D; ++d) velocity_[d][i] = wet && !wall.slips ? 2 * own[d] - water[d] : own[d];
        pressure_[i] = std::max(0.0, pressure);
        volume_[i] = -mass_[i] / settings_.state.density(pressure_[i]);
    }

    const Settings& settings_;
    std::span<const sph::WallNow> walls_;
    std::array<const double*, D> position_;
    std::array<double*, D> velocity_;
    const double *density_, *mass_;
    double *pressure_, *volume_;
    const std::uint8_t* body_;
    double inverse_h_;
    Block<value_count> water_;
};

}  // namespace

const Field<double>& density_of_fluid(const ParticleSet& particles) {
    return particles.has(coupling_field::fluid_density) ? coupling_field::fluid_density
                                                        : field::predicted_density;
}

namespace {

/// Of water with grains in it: more of them than this in a volume count as so many.
constexpr double most_solid = 0.8;

void find_density_of_fluid(ParticleSet& particles) {
    const double *density = particles.data(field::predicted_density),
                 *solid = particles.data(coupling_field::solid_fraction);
    double* of_fluid = particles.data(coupling_field::fluid_density);
    for (std::size_t i = 0; i < particles.size(); ++i)
        of_fluid[i] = density[i] / (1 - std::min(solid[i], most_solid));
}

}  // namespace

void find_pressure(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls) {
    const double *density = particles.data(field::predicted_density), *mass = particles.data(field::mass);
    double *pressure = particles.data(field::pressure), *volume = particles.data(water_field::partner_volume);
    const std::uint8_t* body = particles.data(field::body);
    if (particles.has(coupling_field::fluid_density)) find_density_of_fluid(particles);
    const double* of_fluid = particles.data(density_of_fluid(particles));
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool is_wall = !walls.empty() && walls[body[i]].is_wall;
        volume[i] = (is_wall ? -1 : 1) * mass[i] / density[i];
        pressure[i] = settings.state.pressure(of_fluid[i]);
    }
}

void wall_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
               std::span<const sph::WallNow> walls) {
    const auto run = [&](auto pass) {
        table.for_each_own(which, [&pass](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            pass.visit(cell, runs);
        });
    };
    if (particles.dimension() == 2)
        run(WallPass<2>(particles, settings, walls));
    else
        run(WallPass<3>(particles, settings, walls));
}

}  // namespace talus::water
