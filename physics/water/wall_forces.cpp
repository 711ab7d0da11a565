#include "physics/water/wall_forces.hpp"

#include <algorithm>

#include "domain/water_fields.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/water/neighbourhood.hpp"
#include "physics/water/pair_force.hpp"

namespace talus::water {

namespace {

using sph::Vector;

template <int D, Viscosities terms>
class WallForces {
  public:
    WallForces(ParticleSet& particles, const Settings& settings, std::span<const std::uint8_t> feels)
        : feels_(feels),
          body_(particles.data(field::body)),
          pair_force_(settings),
          frame_(sph::components<D>(particles, field::position), settings.radius()),
          velocity_(sph::components<D>(particles, water_field::partner_velocity)),
          volume_(particles.data(water_field::partner_volume)),
          pressure_(particles.data(water_field::partner_pressure)),
          sticks_(particles.data(water_field::partner_density)),
          force_(sph::components_to_write<D>(particles, water_field::wall_force)),
          scale_(PairForce<D, terms>::scale(settings) * settings.state.reference_density *
                 std::pow(settings.radius(), D)) {
        if constexpr (is_uneven) flow_ = LocalFlow<D>::columns(particles);
    }

    void visit(const CellEntry& cell, std::span<const Run> runs) {
        const auto asks = [this](std::uint32_t i) { return volume_[i] < 0 && feels_[body_[i]]; };
        bool gathered = false;
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            if (!asks(i)) continue;
            if (!gathered) gather(cell, runs);
            gathered = true;
            evaluate(i);
        }
    }

  private:
    static constexpr std::size_t at_velocity = D, at_volume = 2 * D, at_pressure = 2 * D + 1,
                                 at_flow = 2 * D + 2;
    static constexpr bool is_uneven = terms.laminar == Viscosity::uneven;
    static constexpr std::size_t flow_count = is_uneven ? LocalFlow<D>::value_count : 0,
                                 value_count = at_flow + flow_count;

    void gather(const CellEntry& cell, std::span<const Run> runs) {
        gather_water(
            frame_, cell, runs, volume_, water_,
            [this](std::uint32_t k, std::size_t number, std::array<FloatLanes, value_count>& values) {
                for (int d = 0; d < D; ++d) values[at_velocity + d] = load_first(velocity_[d] + k, number);
                for (std::size_t c = 0; c < flow_count; ++c)
                    values[at_flow + c] = load_first(flow_[c] + k, number);
                values[at_volume] = load_first(volume_ + k, number);
                values[at_pressure] = load_first(pressure_ + k, number);
            });
    }

    void evaluate(std::uint32_t i) {
        const std::array<const float*, value_count> from = water_.columns();
        std::array<FloatLaneSum, D> sum{};
        for (std::size_t k = 0; k < water_.size(); k += float_lane_count) {
            Vector<FloatLanes, D> r, v;
            for (int d = 0; d < D; ++d) {
                r[d] = frame_.place(d, i) - load(from[d] + k);
                v[d] = velocity_[d][i] - load(from[at_velocity + d] + k);
            }
            const FloatLanes r2 = sph::dot(r, r), distance = sqrt(r2),
                             x = max(1 - distance, FloatLanes(0.0F));
            const FloatLanes weight = load(from[at_volume] + k) * (x * x * x);
            const FloatLanes pressure = pressure_[i] + load(from[at_pressure] + k) +
                                        pair_force_.core_pressure(distance),
                             sticks = sticks_[i];
            Vector<FloatLanes, D> force;
            if constexpr (is_uneven)
                force = pair_force_(r, v, r2, pressure, sticks, LocalFlow<D>::load(&from[at_flow], k));
            else
                force = pair_force_(r, v, r2, pressure, sticks);
            for (int d = 0; d < D; ++d) sum[d].add(k, weight * force[d]);
        }
        const double scale = -scale_ * static_cast<double>(volume_[i]);
        for (int d = 0; d < D; ++d) force_[d][i] = scale * sum[d].total();
    }

    std::span<const std::uint8_t> feels_;
    const std::uint8_t* body_;
    const PairForce<D, terms> pair_force_;
    LocalFrame<D> frame_;
    std::array<const float*, D> velocity_;
    const float *volume_, *pressure_, *sticks_;
    std::array<const float*, flow_count> flow_{};
    std::array<double*, D> force_;
    const double scale_;
    Block<value_count> water_;
};

}  // namespace

void find_wall_forces(ParticleSet& particles, const CellTable& table, const Settings& settings,
                      std::span<const std::uint8_t> feels) {
    const auto run = [&]<int D, Viscosities terms>() {
        WallForces<D, terms> pass(particles, settings, feels);
        table.for_each_own(Cells::all, [&pass](const CellEntry& cell, std::span<const Run> runs,
                                               std::size_t) { pass.visit(cell, runs); });
    };
    const auto in_dimension = [&]<int D>() {
        with_viscosities(settings,
                         [&]<Viscosities viscosities>() { run.template operator()<D, viscosities>(); });
    };
    if (particles.dimension() == 2)
        in_dimension.template operator()<2>();
    else
        in_dimension.template operator()<3>();
}

}  // namespace talus::water
