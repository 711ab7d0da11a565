#pragma once
#include <algorithm>
#include <cmath>

namespace talus::depth {

/// Steady simple shear of a layer on a plane: the stress falls linearly from the bed to the free surface, the
/// shear rate is ((stress - yield stress)^N)/R where that is positive, and zero in the plug above.
/// With X the excess of the stress at the bed over the yield stress, T their sum and h the depth, the mean
/// speed is
///     h X^(N+1) / ((N+1) R T) (1 - X / ((N+2) T)),
/// the integral of the profile; for N = 1 it is Bingham's cubic. X. Huang, M. H. Garcia, J. Fluid Mech. 374
/// (1998) 305.
struct ViscoplasticProfile {
    double yield_stress;  ///< [Pa], not negative
    double resistance;    ///< R [Pa^N s], positive
    double exponent;      ///< N [1], positive

    /// Mean speed [m/s] where the stress at the bed exceeds the yield stress by `excess` [Pa].
    double mean_speed(double excess, double depth) const {
        if (!(excess > 0)) return 0;
        const double share = excess / (excess + yield_stress);
        return scale(depth) * std::pow(excess, exponent) * share * (1 - share / (exponent + 2));
    }

    /// Derivative of mean_speed by the excess [m/(s Pa)].
    double mean_speed_rate(double excess, double depth) const {
        const double share = excess / (excess + yield_stress);
        return scale(depth) * std::pow(excess, exponent - 1) * share *
               (exponent + 1 - 2 * share + 2 * share * share / (exponent + 2));
    }

    /// The excess X [Pa] with mean_speed(X) + per_stress X = speed: the left side grows with X, so that there
    /// is one. Newton's steps, kept between bounds.
    double excess(double speed, double per_stress, double depth) const {
        if (!(speed > 0)) return 0;
        double least = 0, greatest = greatest_excess(speed, depth);
        if (per_stress > 0) greatest = std::min(greatest, speed / per_stress);
        double excess = greatest;
        constexpr int most_steps = 200;
        for (int step = 0; step < most_steps && excess > 0; ++step) {
            const double over = mean_speed(excess, depth) + per_stress * excess - speed;
            if (over == 0) break;
            (over > 0 ? greatest : least) = excess;
            double next = excess - over / (mean_speed_rate(excess, depth) + per_stress);
            if (!(least < next && next < greatest)) next = least + (greatest - least) / 2;
            const bool is_found = std::abs(next - excess) <= 4e-16 * excess;
            excess = next;
            if (is_found) break;
        }
        return excess;
    }

  private:
    double scale(double depth) const { return depth / ((exponent + 1) * resistance); }

    /// A bound of the excess at a mean speed. With share >= 1/2 where X >= tau_y and T <= 2 tau_y elsewhere,
    /// the mean speed is at least scale (N+1)/(N+2) times X^N / 2 and X^(N+1) / (2 tau_y).
    double greatest_excess(double speed, double depth) const {
        const double least = 2 * speed * (exponent + 2) / (scale(depth) * (exponent + 1));
        const double of_a_plug = std::pow(yield_stress * least, 1 / (exponent + 1));
        if (of_a_plug < yield_stress) return of_a_plug;
        return std::max(yield_stress, std::pow(least, 1 / exponent));
    }
};

}  // namespace talus::depth
