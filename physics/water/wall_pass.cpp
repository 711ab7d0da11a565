#include <algorithm>
#include <array>
#include <cmath>

#include "domain/water_fields.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/water/neighbourhood.hpp"
#include "physics/water/passes.hpp"

namespace talus::water {

namespace {

std::array<double, 3> array_of(const dem::Vector3<>& v) { return {v.x, v.y, v.z}; }

/// Water in a half space as a particle of the wall sees it, `distance` from the mean place of what it sees,
/// both in units of the radius of interaction: how many times deeper in the wall it is than that is in the
/// water. The mean distance grows from `at_surface` to 1 with the depth, nearly in a straight line; water is
/// no nearer to the wall than half a spacing.
template <int D>
double depth_ratio(double distance, double spacing) {
    constexpr double at_surface = D == 2 ? 0.2122 : 0.2083;
    const double depth = std::min((distance - at_surface) / (1 - at_surface), distance - spacing / 2);
    return depth > 0 ? depth / (distance - depth) : 0;
}

/// `linearly`: walls that do not slip have the velocity that water with an even rate of shear would have
/// there, else that of the water in front.
template <int D, bool linearly>
class WallPass {
  public:
    WallPass(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls)
        : settings_(settings),
          walls_(walls),
          frame_(sph::components<D>(particles, field::position), settings.radius()),
          body_(particles.data(field::body)),
          velocity_(sph::components_to_write<D>(particles, water_field::partner_velocity)),
          volume_(particles.data(water_field::partner_volume)),
          partner_pressure_(particles.data(water_field::partner_pressure)),
          pressure_(particles.data(field::pressure)) {}

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        const auto is_wall = [](float volume) { return volume < 0; };
        if (std::none_of(volume_ + cell.begin, volume_ + cell.end, is_wall)) return;
        gather(cell, runs);
        if (water_.size() == 0) return;
        for (std::uint32_t i = cell.begin; i < cell.end; ++i)
            if (is_wall(volume_[i]) && walls_[body_[i]].is_wall) extrapolate(i);  // not an open end
    }

  private:
    static constexpr std::size_t at_velocity = D, at_pressure = 2 * D, value_count = 2 * D + 1;

    void gather(const CellEntry& cell, std::span<const Run> runs) {
        gather_water(
            frame_, cell, runs, volume_, water_,
            [this](std::uint32_t k, std::size_t number, std::array<FloatLanes, value_count>& values) {
                for (int d = 0; d < D; ++d) values[at_velocity + d] = load_first(velocity_[d] + k, number);
                values[at_pressure] = load_first(partner_pressure_ + k, number);
            });
    }

    void extrapolate(std::uint32_t i) {
        const sph::WallNow& wall = walls_[body_[i]];
        const Tait& state = settings_.state;
        const double sound2 = state.sound_speed * state.sound_speed;
        const std::array<double, 3> weight = array_of((settings_.radius() / sound2) * wall.weight);
        const auto at_rest =
            static_cast<float>(1 - background());  // rho/rho0 = 1 + (p - p0)/(rho0 c0^2), nearly
        const std::array<const float*, value_count> from = water_.columns();
        FloatLaneSum all, pressure;
        std::array<FloatLaneSum, D> velocity{}, distance{};
        for (std::size_t k = 0; k < water_.size(); k += float_lane_count) {
            FloatLanes r2 = 0, depth = 0;
            std::array<FloatLanes, D> away;
            for (int d = 0; d < D; ++d) {
                const FloatLanes r = frame_.place(d, i) - load(from[d] + k);
                r2 += r * r;
                if constexpr (linearly) away[d] = r;
                depth += static_cast<float>(weight[d]) * r;
            }
            const FloatLanes q = sqrt(r2), x = max(1 - q, FloatLanes(0.0F)), x2 = x * x;
            const FloatLanes share = x2 * x2 * (1 + 4 * q), p = load(from[at_pressure] + k);
            all.add(k, share);
            pressure.add(k, share * (p + (at_rest + p) * depth));
            for (int d = 0; d < D; ++d) {
                velocity[d].add(k, share * load(from[at_velocity + d] + k));
                if constexpr (linearly) distance[d].add(k, share * away[d]);
            }
        }
        const double total = all.total();
        if (total == 0) return;
        const double scale = state.reference_density * sound2 / total;
        pressure_[i] = std::max(0.0, scale * pressure.total());
        double ratio = 1;
        if constexpr (linearly) {
            double distance2 = 0;
            for (int d = 0; d < D; ++d) distance2 += std::pow(distance[d].total() / total, 2);
            ratio = depth_ratio<D>(std::sqrt(distance2), 1 / settings_.radius_in_spacings);
        }
        for (int d = 0; d < D && !wall.slips; ++d)
            velocity_[d][i] = static_cast<float>((1 + ratio) * static_cast<double>(velocity_[d][i]) -
                                                 ratio * velocity[d].total() / total);
        partner_pressure_[i] = static_cast<float>(pressure_[i] / (state.reference_density * sound2));
    }
    /// p0/(rho0 c0^2).
    double background() const {
        const Tait& state = settings_.state;
        return state.background_pressure / (state.reference_density * state.sound_speed * state.sound_speed);
    }

    const Settings& settings_;
    std::span<const sph::WallNow> walls_;
    LocalFrame<D> frame_;
    const std::uint8_t* body_;
    std::array<float*, D> velocity_;
    float *volume_, *partner_pressure_;
    double* pressure_;
    Block<value_count> water_;
};

}  // namespace

void wall_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
               std::span<const sph::WallNow> walls) {
    const auto run = [&](auto&& pass) {
        table.for_each_own(which, [&pass](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            pass.visit(cell, runs);
        });
    };
    const auto in_dimension = [&]<int D>() {
        if (settings.rheology)
            run(WallPass<D, true>(particles, settings, walls));
        else
            run(WallPass<D, false>(particles, settings, walls));
    };
    if (particles.dimension() == 2)
        in_dimension.template operator()<2>();
    else
        in_dimension.template operator()<3>();
}

}  // namespace talus::water
