#include <cmath>

#include "domain/water_fields.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_vectors.hpp"
#include "physics/water/neighbourhood.hpp"
#include "physics/water/passes.hpp"

namespace talus::water {

namespace {

using sph::dot;
using sph::Vector;

/// What a scene's water has besides pressure; what it has not costs nothing.
struct Terms {
    bool artificial, viscous;
};

template <int D, Terms terms>
class ForcePass {
  public:
    ForcePass(ParticleSet& particles, const Settings& settings, std::span<const sph::WallNow> walls)
        : settings_(settings),
          walls_(walls),
          position_(sph::components<D>(particles, field::position)),
          velocity_(sph::components<D>(particles, field::predicted_velocity)),
          density_(particles.data(field::predicted_density)),
          of_fluid_(particles.data(density_of_fluid(particles))),
          pressure_(particles.data(field::pressure)),
          volume_(particles.data(water_field::partner_volume)),
          body_(particles.data(field::body)),
          acceleration_(sph::components_to_write<D>(particles, field::acceleration)),
          rate_(particles.data(water_field::density_rate)) {
        const double h = settings.smoothing_length, c0 = settings.state.sound_speed,
                     rho0 = settings.state.reference_density;
        scale_ = 5 * sph::WendlandC2<D>::norm / std::pow(h, D + 2);
        inverse_radius_ = 1 / settings.radius();
        damping_ = settings.artificial_viscosity * rho0 * c0 * h;
        softening_ = 0.01 * h * h;
        diffusion_ = 2 * settings.density_diffusion * h * c0;
        for (int d = 0; d < D; ++d) weight_[d] = rho0 * settings.bearing[d] / (c0 * c0);
    }

    std::uint64_t visit(const CellEntry& cell, std::span<const Run> runs) {
        std::uint32_t own = 0;
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) own += volume_[i] > 0 ? 1 : 0;
        if (own == 0) return 0;
        gather(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i)
            if (volume_[i] > 0) evaluate(i);
        return std::uint64_t{own} * (water_.size() + wall_.size());
    }

  private:
    static constexpr std::size_t at_position = 0, at_velocity = D, at_volume = 2 * D, at_pressure = 2 * D + 1,
                                 at_density = 2 * D + 2, value_count = 2 * D + 3;

    /// Density less that of water at rest, but for a constant.
    template <class Real>
    Real excess_density(Real density, const std::array<Real, D>& x) const {
        for (int d = 0; d < D; ++d) density -= weight_[d] * x[d];
        return density;
    }

    void gather(const CellEntry& cell, std::span<const Run> runs) {
        water_.clear(count_of(runs));
        wall_.clear(count_of(runs));
        for_each_near<D>(cell, runs, position_, settings_.radius(),
                         [this](std::uint32_t k, std::size_t number, const std::array<Lanes, D>& x,
                                const Lanes& excess) { append(k, number, x, excess); });
        std::array<double, value_count> nobody{};
        nobody[0] = far_away;
        water_.pad(nobody);
        wall_.pad(nobody);
    }

    /// Takes up partners k and on.
    void append(std::uint32_t k, std::size_t number, const std::array<Lanes, D>& x, const Lanes& excess) {
        std::array<Lanes, value_count> values;
        for (int d = 0; d < D; ++d) {
            values[at_position + d] = x[d];
            values[at_velocity + d] = load_first(velocity_[d] + k, number);
        }
        const Lanes volume = load_first(volume_ + k, number);
        values[at_volume] = abs(volume);
        values[at_pressure] = load_first(pressure_ + k, number);
        values[at_density] = excess_density(load_first(of_fluid_ + k, number), x);
        const LaneMask is_wall = volume < 0;
        if (none_of(is_wall)) return water_.append(excess, values);
        water_.append(select(is_wall, Lanes(1.0), excess), values);
        values[at_density] =
            Lanes([&](auto lane) { return lane < number && walls_[body_[k + lane]].slips ? 0.0 : 1.0; });
        wall_.append(select(is_wall, excess, Lanes(1.0)), values);
    }

    struct Own {
        std::array<Lanes, D> x, v;
        Lanes pressure, density, excess;
    };
    struct Sums {
        std::array<LaneSum, D> force;
        LaneSum rate;
    };

    template <bool of_wall>
    void add_up(const Own& own, const Block<value_count>& others, Sums& sums) const {
        std::array<const double*, value_count> from;
        for (std::size_t c = 0; c < value_count; ++c) from[c] = others.column(c);
        for (std::size_t k = 0; k < others.size(); k += lane_count) {
            Vector<Lanes, D> r, v;
            for (int d = 0; d < D; ++d) {
                r[d] = own.x[d] - load(from[at_position + d] + k);
                v[d] = own.v[d] - load(from[at_velocity + d] + k);
            }
            const Lanes r2 = dot(r, r), approach = dot(r, v);
            const Lanes near = max(1 - sqrt(r2) * inverse_radius_, Lanes(0.0));
            const Lanes weight = load(from[at_volume] + k) * (near * near * near);
            Lanes pressure = own.pressure + load(from[at_pressure] + k);
            Lanes friction = 2 * settings_.viscosity, damping = damping_;
            if constexpr (of_wall) {
                const Lanes sticks = load(from[at_density] + k);
                friction *= sticks;
                damping *= sticks;
            }
            if constexpr (terms.artificial)
                pressure -= damping * min(approach, Lanes(0.0)) / (r2 + softening_);
            for (int d = 0; d < D; ++d) {
                Lanes force = pressure * r[d];
                if constexpr (terms.viscous) force -= friction * v[d];
                sums.force[d].add(k, weight * force);
            }
            Lanes rate = -own.density * approach;
            if constexpr (!of_wall) rate += diffusion_ * (load(from[at_density] + k) - own.excess);
            sums.rate.add(k, weight * rate);
        }
    }

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        Own own;
        std::array<double, D> x;
        for (int d = 0; d < D; ++d) {
            x[d] = position_[d][i];
            own.x[d] = x[d];
            own.v[d] = velocity_[d][i];
        }
        own.pressure = pressure_[i];
        own.density = density_[i];
        own.excess = excess_density(of_fluid_[i], x);
        Sums sums{};
        add_up<false>(own, water_, sums);
        if (wall_.size() > 0) add_up<true>(own, wall_, sums);
        for (int d = 0; d < D; ++d)
            acceleration_[d][i] = settings_.gravity[d] + scale_ / density_[i] * sums.force[d].total();
        rate_[i] = scale_ * sums.rate.total();
    }

    const Settings& settings_;
    std::span<const sph::WallNow> walls_;
    std::array<const double*, D> position_, velocity_;
    const double *density_, *of_fluid_, *pressure_, *volume_;
    const std::uint8_t* body_;
    std::array<double*, D> acceleration_;
    double* rate_;
    double scale_, inverse_radius_, damping_, softening_, diffusion_;
    std::array<double, D> weight_;
    Block<value_count> water_, wall_;
};

template <int D, Terms terms>
void run(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
         std::span<const sph::WallNow> walls, sph::PassCount& count) {
    sph::visit_cells(ForcePass<D, terms>(particles, settings, walls), table, which, count);
}

}  // namespace

void force_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                std::span<const sph::WallNow> walls, sph::PassCount& count) {
    const bool artificial = settings.artificial_viscosity > 0, viscous = settings.viscosity > 0;
    const auto with_terms = [&](auto dimension) {
        constexpr int D = dimension;
        if (artificial && viscous)
            run<D, Terms{true, true}>(particles, table, which, settings, walls, count);
        else if (artificial)
            run<D, Terms{true, false}>(particles, table, which, settings, walls, count);
        else if (viscous)
            run<D, Terms{false, true}>(particles, table, which, settings, walls, count);
        else
            run<D, Terms{false, false}>(particles, table, which, settings, walls, count);
    };
    if (particles.dimension() == 2)
        with_terms(std::integral_constant<int, 2>{});
    else
        with_terms(std::integral_constant<int, 3>{});
}

}  // namespace talus::water
