#pragma once
#include "physics/sph/kernels.hpp"
#include "physics/sph/pair_terms.hpp"
#include "physics/sph/small_vectors.hpp"

namespace talus::sph {

/// What varies inside the pair loop of Godunov SPH; each combination is compiled on its own.
template <bool strength_, bool variable_h_, bool quintic_, bool bodies_>
struct GodunovOptions {
    static constexpr bool strength = strength_;      ///< deviatoric stress
    static constexpr bool variable_h = variable_h_;  ///< both particles' smoothing lengths
    static constexpr bool quintic = quintic_;        ///< the quintic may be chosen
    static constexpr bool bodies = bodies_;          ///< several bodies: no tension or shear across contacts
};

/// Places of a particle's values in its record; what the options do not need has no place.
template <int D, class Options>
struct GodunovPlaces {
    static constexpr int position = 0, velocity = D, volume_gradient = 2 * D, pressure_gradient = 3 * D,
                         mass = 4 * D, density = mass + 1, pressure = mass + 2, sound_speed = mass + 3,
                         specific_volume = mass + 4, strain_rate = mass + 5,
                         stress = strain_rate + symmetric_count<D>,
                         curvature = stress + (Options::strength ? symmetric_count<D> : 0),
                         h = curvature + (Options::quintic ? symmetric_count<D> : 0),
                         body = h + (Options::variable_h ? 1 : 0), count = body + (Options::bodies ? 1 : 0);
};

/// One particle's values in the pair loop.
template <class Real, int D, class Options>
struct GodunovParticle {
    using Places = GodunovPlaces<D, Options>;
    std::array<Real, static_cast<std::size_t>(Places::count)> values;

    const Real& scalar(int place) const { return values[static_cast<std::size_t>(place)]; }
    Vector<Real, D> vector(int place) const { return part<D>(place); }
    Symmetric<Real, D> symmetric(int place) const { return part<symmetric_count<D>>(place); }

  private:
    template <int count>
    std::array<Real, static_cast<std::size_t>(count)> part(int place) const {
        std::array<Real, static_cast<std::size_t>(count)> components;
        for (std::size_t c = 0; c < components.size(); ++c)
            components[c] = values[static_cast<std::size_t>(place) + c];
        return components;
    }
};

/// Force per mass of both and work per mass of both and time that j exerts on i.
template <class Real, int D>
struct GodunovForce {
    Vector<Real, D> force;  ///< [m/s2 per kg of j]
    Real power;             ///< [W/kg per kg of j]
};

/// The equations of one pair; see passes.hpp for the source. e points from j to i, s runs along it.
/// Exchanging i and j changes the sign of the force and not a bit more. `h` is for a smoothing length that
/// all share.
template <int D, class Options, class Real>
GodunovForce<Real, D> godunov_pair(const GodunovParticle<Real, D, Options>& i,
                                   const GodunovParticle<Real, D, Options>& j, Real h,
                                   const Gaussian<D>& kernel, const Settings& settings) {
    using std::max, std::min, std::sqrt;
    using P = GodunovPlaces<D, Options>;
    constexpr double root_half = 0.70710678118654752;
    const Vector<Real, D> x_i = i.vector(P::position), x_j = j.vector(P::position);
    Vector<Real, D> r, e;
    for (std::size_t d = 0; d < D; ++d) r[d] = x_i[d] - x_j[d];
    const Real r2 = max(dot(r, r), Real(1e-300)), distance = sqrt(r2), inverse_distance = 1 / distance;
    for (std::size_t d = 0; d < D; ++d) e[d] = r[d] * inverse_distance;

    // Specific volume between the particles, linear where the cubic or quintic overshoots.
    const Real pressure_i = i.scalar(P::pressure), pressure_j = j.scalar(P::pressure);
    const auto compressed = pressure_i + pressure_j > 0;
    const auto wanted = [&](Interpolation kind) {
        const auto is = [=](Interpolation choice) { return Real(choice == kind ? 1.0 : 0.0); };
        return select(compressed, is(settings.compressed), is(settings.stretched));
    };
    VolumeEnds<Real> ends{i.scalar(P::specific_volume), j.scalar(P::specific_volume),
                          dot(i.vector(P::volume_gradient), e), dot(j.vector(P::volume_gradient), e)};
    if constexpr (Options::quintic) {
        ends.curve_i = normal_component(i.symmetric(P::curvature), e);
        ends.curve_j = normal_component(j.symmetric(P::curvature), e);
    }
    const Real mean_density = 0.5 * (i.scalar(P::density) + j.scalar(P::density));
    const Real density_square = mean_density * mean_density;
    const auto smooth = interpolate_volume(ends, distance, inverse_distance, wanted(Interpolation::cubic));
    const auto straight = interpolate_volume(ends, distance, inverse_distance, Real(0.0));
    const auto moments = [&](Real h2) {
        VolumeMoments<Real> m = cubic_moments(smooth, h2);
        if constexpr (Options::quintic) {
            const auto quintic = wanted(Interpolation::quintic) > 0.5;
            const VolumeMoments<Real> q = quintic_moments(ends, distance, inverse_distance, h2);
            m = {select(quintic, q.square, m.square), select(quintic, q.first, m.first)};
        }
        const auto overshoots = m.square * density_square > 10;
        const Real line_first = 0.5 * h2 * straight.c * straight.d;
        const Real line_square = 0.25 * h2 * (straight.c * straight.c) + straight.d * straight.d;
        return VolumeMoments<Real>{select(overshoots, line_square, m.square),
                                   select(overshoots, line_first, m.first)};
    };
    Real weight, centre;  // sum of V_ij^2 times the kernels' slopes, s*
    if constexpr (Options::variable_h) {
        const Real h_i = i.scalar(P::h), h_j = j.scalar(P::h);
        const auto own = moments(h_i * h_i), other = moments(h_j * h_j);
        weight = own.square * kernel.factor(r2, root_half / h_i) +
                 other.square * kernel.factor(r2, root_half / h_j);
        centre = 0.5 * (own.first / own.square + other.first / other.square);
    } else {
        const auto both = moments(h * h);
        weight = 2 * both.square * kernel.factor(r2, root_half / h);
        centre = both.first / both.square;
    }
    const Real share = centre * inverse_distance;  // s* / distance
    const Real share_i = 0.5 + share, share_j = 0.5 - share;

    // Riemann problem between states reconstructed at s*. No state may lie outside the two values, whose
    // difference the gradients, being smooth, exceed next to jumps; first order at compressions fast against
    // sound.
    const Vector<Real, D> v_i = i.vector(P::velocity), v_j = j.vector(P::velocity);
    const Real u_i = dot(v_i, e), u_j = dot(v_j, e);
    Real star_pressure = 0.5 * (pressure_i + pressure_j), velocity_change = 0;
    if (settings.riemann) {
        const Real c_i = i.scalar(P::sound_speed), c_j = j.scalar(P::sound_speed);
        RiemannSide<Real> right{i.scalar(P::density), pressure_i, u_i, c_i};
        RiemannSide<Real> left{j.scalar(P::density), pressure_j, u_j, c_j};
        if (settings.second_order) {
            const Real u_slope_i = normal_component(i.symmetric(P::strain_rate), e),
                       u_slope_j = normal_component(j.symmetric(P::strain_rate), e);
            const Real p_slope_i = dot(i.vector(P::pressure_gradient), e),
                       p_slope_j = dot(j.vector(P::pressure_gradient), e);
            const auto gentle = 3 * (u_j - u_i) < min(c_i, c_j);
            const Real u_secant = (u_i - u_j) * inverse_distance,
                       p_secant = (pressure_i - pressure_j) * inverse_distance;
            const auto limited = [&](Real slope, Real other, Real secant) {
                return select(gentle && slope * secant > 0 && other * secant > 0, lesser(slope, secant),
                              Real(0.0));
            };
            const Real reach_i = centre - 0.5 * distance, reach_j = centre + 0.5 * distance;
            right.pressure += limited(p_slope_i, p_slope_j, p_secant) * reach_i;
            left.pressure += limited(p_slope_j, p_slope_i, p_secant) * reach_j;
            right.velocity += limited(u_slope_i, u_slope_j, u_secant) * reach_i;
            left.velocity += limited(u_slope_j, u_slope_i, u_secant) * reach_j;
        }
        const RiemannSolution<Real> star = solve_riemann(left, right, settings.shock_slope);
        const auto false_tension = star.pressure < 0 && pressure_i > 0 && pressure_j > 0;
        star_pressure = select(false_tension, star_pressure, star.pressure);
        if (settings.riemann_velocity) velocity_change = star.velocity - (share_i * u_i + share_j * u_j);
    }

    // Traction on i and its work at the velocity between the particles.
    Real keep_i = share_i, keep_j = share_j;  // of either side's stress
    if constexpr (Options::bodies) {
        const auto contact = i.scalar(P::body) != j.scalar(P::body);
        star_pressure = select(contact, max(star_pressure, Real(0.0)), star_pressure);
        keep_i = select(contact, Real(0.0), share_i);
        keep_j = select(contact, Real(0.0), share_j);
    }
    Symmetric<Real, D> stress;
    if constexpr (Options::strength) {
        const Symmetric<Real, D> s_i = i.symmetric(P::stress), s_j = j.symmetric(P::stress);
        for (std::size_t c = 0; c < s_i.size(); ++c) stress[c] = keep_i * s_i[c] + keep_j * s_j[c];
    }
    GodunovForce<Real, D> result;
    result.power = 0;
    for (std::size_t a = 0; a < D; ++a) {
        Real traction = -star_pressure * r[a];
        if constexpr (Options::strength) traction += row_times(stress, a, r);
        Real star = share_i * v_i[a] + share_j * v_j[a];
        if (settings.riemann_velocity) star += velocity_change * e[a];
        result.force[a] = weight * traction;
        result.power += result.force[a] * star;
    }
    return result;
}

}  // namespace talus::sph
