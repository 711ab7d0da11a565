#include <cmath>

#include "domain/water_fields.hpp"
#include "physics/sph/pass_support.hpp"
#include "physics/sph/small_vectors.hpp"
#include "physics/water/neighbourhood.hpp"
#include "physics/water/pair_force.hpp"
#include "physics/water/passes.hpp"

namespace talus::water {

namespace {

using sph::dot;
using sph::Vector;

/// What a scene's water has besides pressure; what it has not costs nothing.
struct Terms {
    Viscosities viscosities;
    bool shifts;
    bool cores;  // of walls
};

/// In units of the radius of interaction R, the speed of sound c0 and the density at rest rho0.
template <int D, Terms terms>
class ForcePass {
  public:
    ForcePass(ParticleSet& particles, const Settings& settings)
        : gravity_(settings.gravity),
          pair_force_(settings),
          frame_(sph::components<D>(particles, field::position), settings.radius()),
          velocity_(sph::components<D>(particles, water_field::partner_velocity)),
          volume_(particles.data(water_field::partner_volume)),
          pressure_(particles.data(water_field::partner_pressure)),
          density_(particles.data(water_field::partner_density)),
          mass_(particles.data(field::mass)),
          acceleration_(sph::components_to_write<D>(particles, field::acceleration)),
          rate_(particles.data(water_field::density_rate)) {
        const double radius = settings.radius(), c0 = settings.state.sound_speed,
                     rho0 = settings.state.reference_density;
        const double kernel = Force::kernel();
        force_scale_ = Force::scale(settings);
        rate_scale_ = kernel * rho0 * c0 / radius;
        mass_scale_ = 1 / (rho0 * std::pow(radius, D));
        if constexpr (terms.shifts) {
            shift_ = sph::components_to_write<D>(particles, water_field::shift_velocity);
            const double expected_speed = c0 / 10, spacing = 1 / settings.radius_in_spacings,
                         away = 1 - spacing;
            shift_scale_ = 2 * settings.shifting * kernel * expected_speed;
            fullness_ = kernel;
            nearest_ = static_cast<float>(1 / (std::pow(away, 4) * (1 + 4 * spacing)));
            fastest_ = 0.5 * expected_speed;
        }
        if constexpr (is_uneven) flow_ = LocalFlow<D>::columns(particles);
        diffusion_ = static_cast<float>(2 * settings.density_diffusion / Settings::support());
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
    using Force = PairForce<D, terms.viscosities>;
    static constexpr std::size_t at_velocity = D, at_volume = 2 * D, at_pressure = 2 * D + 1,
                                 at_density = 2 * D + 2, at_flow = 2 * D + 3;
    static constexpr bool is_uneven = terms.viscosities.laminar == Viscosity::uneven;
    static constexpr std::size_t flow_count = is_uneven ? LocalFlow<D>::value_count : 0,
                                 value_count = at_flow + flow_count;

    void gather(const CellEntry& cell, std::span<const Run> runs) {
        frame_.enter(cell);
        water_.clear(count_of(runs));
        wall_.clear(count_of(runs));
        const auto all = [](std::uint32_t, std::size_t) { return ~LaneBits{0}; };
        frame_.for_each_near(
            runs, all,
            [this](std::uint32_t k, std::size_t number, const std::array<FloatLanes, D>& x, LaneBits bits) {
                std::array<FloatLanes, value_count> values;
                for (int d = 0; d < D; ++d) {
                    values[d] = x[d];
                    values[at_velocity + d] = load_first(velocity_[d] + k, number);
                }
                const FloatLanes volume = load_first(volume_ + k, number);
                values[at_volume] = abs(volume);
                values[at_pressure] = load_first(pressure_ + k, number);
                values[at_density] = load_first(density_ + k, number);
                for (std::size_t c = 0; c < flow_count; ++c)
                    values[at_flow + c] = load_first(flow_[c] + k, number);
                const LaneBits is_wall = negative_lanes(volume);
                if ((bits & ~is_wall) != 0) water_.append(bits & ~is_wall, values);
                if ((bits & is_wall) != 0) wall_.append(bits & is_wall, values);
            });
        water_.pad();
        wall_.pad();
    }

    struct Own {
        std::array<FloatLanes, D> x, v;
        FloatLanes pressure, density, excess;
        LocalFlow<D> flow;  // where viscosity differs
    };
    struct Sums {
        std::array<FloatLaneSum, D> force;
        FloatLaneSum rate;
        std::array<FloatLaneSum, D> crowding;  // of shifting particles alone, as what follows
        FloatLaneSum fullness;
    };

    template <bool of_wall>
    void add_up(const Own& own, const Block<value_count>& others, Sums& sums) const {
        const std::array<const float*, value_count> from = others.columns();
        for (std::size_t k = 0; k < others.size(); k += float_lane_count) {
            Vector<FloatLanes, D> r, v;
            for (int d = 0; d < D; ++d) {
                r[d] = own.x[d] - load(from[d] + k);
                v[d] = own.v[d] - load(from[at_velocity + d] + k);
            }
            const FloatLanes r2 = dot(r, r), approach = dot(r, v), distance = sqrt(r2);
            const FloatLanes x = max(1 - distance, FloatLanes(0.0F)), x3 = x * x * x;
            const FloatLanes weight = load(from[at_volume] + k) * x3;
            const FloatLanes last = load(from[at_density] + k);  // of walls whether they do not slip
            FloatLanes pressure = own.pressure + load(from[at_pressure] + k);
            if constexpr (of_wall && terms.cores) pressure += pair_force_.core_pressure(distance);
            const FloatLanes sticks = of_wall ? last : FloatLanes(1.0F);
            Vector<FloatLanes, D> force;
            if constexpr (is_uneven && of_wall)
                force = pair_force_(r, v, r2, pressure, sticks, own.flow);
            else if constexpr (is_uneven)
                force = pair_force_(r, v, r2, pressure, sticks,
                                    between(own.flow, LocalFlow<D>::load(&from[at_flow], k)));
            else
                force = pair_force_(r, v, r2, pressure, sticks);
            for (int d = 0; d < D; ++d) sums.force[d].add(k, weight * force[d]);
            FloatLanes rate = -own.density * approach;
            if constexpr (!of_wall) rate += diffusion_ * (last - own.excess);
            sums.rate.add(k, weight * rate);
            if constexpr (terms.shifts) {
                const FloatLanes closeness = nearest_ * (x3 * x) * (1 + 4 * distance),
                                 squared = closeness * closeness,
                                 push = weight * (1 + 0.2F * squared * squared);
                for (int d = 0; d < D; ++d) sums.crowding[d].add(k, push * r[d]);
                sums.fullness.add(k, weight * r2);
            }
        }
    }

    [[gnu::flatten]] void evaluate(std::uint32_t i) {
        Own own;
        for (int d = 0; d < D; ++d) {
            own.x[d] = frame_.place(d, i);
            own.v[d] = velocity_[d][i];
        }
        own.pressure = pressure_[i];
        own.excess = density_[i];
        if constexpr (is_uneven) own.flow = LocalFlow<D>::of(flow_, i);
        const double density = mass_scale_ * mass_[i] / static_cast<double>(volume_[i]);
        own.density = static_cast<float>(density);
        Sums sums{};
        add_up<false>(own, water_, sums);
        if (wall_.size() > 0) add_up<true>(own, wall_, sums);
        for (int d = 0; d < D; ++d)
            acceleration_[d][i] = gravity_[d] + force_scale_ / density * sums.force[d].total();
        rate_[i] = rate_scale_ * sums.rate.total();
        if constexpr (terms.shifts) shift(i, sums);
    }

    /// Nowhere near a free surface, where the sum of V_j r_ij . grad W_ij is not complete.
    void shift(std::uint32_t i, const Sums& sums) {
        constexpr double full = 0.9 * D;
        std::array<double, D> u{};
        if (fullness_ * sums.fullness.total() > full)
            for (int d = 0; d < D; ++d) u[d] = shift_scale_ * sums.crowding[d].total();
        const double speed = std::sqrt(dot(u, u)), most = speed > fastest_ ? fastest_ / speed : 1;
        for (int d = 0; d < D; ++d) shift_[d][i] = most * u[d];
    }

    const std::array<double, 3> gravity_;
    const Force pair_force_;
    LocalFrame<D> frame_;
    std::array<const float*, D> velocity_;
    const float *volume_, *pressure_, *density_;
    std::array<const float*, flow_count> flow_{};
    const double* mass_;
    std::array<double*, D> acceleration_;
    double* rate_;
    std::array<double*, D> shift_{};
    double force_scale_, rate_scale_, mass_scale_, shift_scale_ = 0, fullness_ = 0, fastest_ = 0;
    float nearest_ = 0;
    float diffusion_;
    Block<value_count> water_, wall_;
};

}  // namespace

void force_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                sph::PassCount& count) {
    const auto run = [&]<int D, Terms terms>() {
        sph::visit_cells(ForcePass<D, terms>(particles, settings), table, which, count);
    };
    const auto with_shifting = [&]<int D, bool shifts>() {
        with_viscosities(settings, [&]<Viscosities viscosities>() {
            if constexpr (D == 3 && viscosities.laminar != Viscosity::uneven)  // all that grains are in
                if (settings.wall_core > 0)
                    return run.template operator()<D, Terms{viscosities, shifts, true}>();
            run.template operator()<D, Terms{viscosities, shifts, false}>();
        });
    };
    const auto in_dimension = [&]<int D>() {
        if (settings.shifting > 0)
            with_shifting.template operator()<D, true>();
        else
            with_shifting.template operator()<D, false>();
    };
    if (particles.dimension() == 2)
        in_dimension.template operator()<2>();
    else
        in_dimension.template operator()<3>();
}

}  // namespace talus::water
