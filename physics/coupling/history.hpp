#pragma once
#include <vector>

namespace talus::coupling {

/// The kernel t^(-1/2) of the history force of A. B. Basset, A Treatise on Hydrodynamics II (1888) ch. 22, as
/// a sum of exponentials, so that what a grain remembers of its past is a few vectors, however long that is:
/// M. A. T. van Hinsberg, J. H. M. ten Thije Boonkkamp, H. J. H. Clercx, J. Comput. Phys. 230 (2011) 1465.
/// Here the exponentials are the trapezoidal rule in x of
///
///     t^(-1/2) = pi^(-1/2) integral of exp(x/2 - t exp(x)) dx,
///
/// all terms beyond the longest time together as one of the same weight and mean rate. Right to a thousandth
/// from the shortest time to the longest; later it falls off at the slowest rate.
class HistoryKernel {
  public:
    /// Times in which the kernel is right [s], 0 < shortest < longest.
    HistoryKernel(double shortest, double longest);

    double shortest() const { return shortest_; }
    double longest() const { return longest_; }
    int size() const { return static_cast<int>(terms_.size()); }
    double operator()(double time) const;  ///< [s^-1/2]

    /// What two time steps make of the memories of a slip w, piecewise linear in time. A memory is the
    /// integral of dw/dt' exp(-rate (t - t')) over all steps but the last.
    struct Passage {
        struct Factors {
            double kept;   ///< of a memory in the last step [1]
            double taken;  ///< of the change of the slip in that step, by its end [1]
            double felt;   ///< share of a memory in the mean over the step to come [s^-1/2]
        };
        std::vector<Factors> memories;
        double recent;  ///< share of the change in the last step in that mean, exact [s^-1/2]
    };
    /// `last`: the step that ends now, 0 if the slip jumps; `next`: the one to come [s].
    Passage between(double last, double next) const;

    /// Share of the change of the slip in a step of its own mean, times the step, exact [s^1/2].
    static double added(double step);

  private:
    struct Term {
        double rate, weight;  ///< [1/s], [s^-1/2]
    };
    double shortest_, longest_;  ///< [s]
    std::vector<Term> terms_;
};

}  // namespace talus::coupling
