#pragma once
#include <span>

#include "physics/gravity/interactions.hpp"
#include "physics/gravity/tree.hpp"

namespace talus::gravity {

/// Lengths and masses in powers of two near those of the problem, so that single precision has room.
struct Units {
    double length;  ///< [m]
    double mass;    ///< [kg]

    static Units near(double length, double mass) {
        return {std::ldexp(1.0, std::ilogb(length)), mass > 0 ? std::ldexp(1.0, std::ilogb(mass)) : 1};
    }
};

/// How many pairs of a target and a source of each kind.
struct PairCounts {
    std::uint64_t points = 0, softened = 0, nodes = 0;
};

/// Gravity on one group after another: lists what acts on it, then adds that up.
template <class Scalar>
class GroupForces {
  public:
    GroupForces(const Tree& tree, const OpeningTest& opening, const Softening<double>& softening,
                const Units& units);

    /// Evaluates a group. The results, for sources group.begin on, hold until the next call.
    PairCounts evaluate(const Group& group);

    /// [G kg/m2] and [G kg/m] of the k-th particle of the group.
    double acceleration(std::size_t k, std::size_t axis) const {
        return static_cast<double>(targets_.acceleration[axis][k]) * units_.mass /
               (units_.length * units_.length);
    }
    double potential(std::size_t k) const {
        return static_cast<double>(targets_.potential[k]) * units_.mass / units_.length;
    }
    /// Whether the tree lacked something that was asked for.
    bool found_gap() const { return found_gap_; }

  private:
    void take_targets(const Group& group);
    void list_sources(const Target& target);
    void list_particles(std::span<const Source> sources, const Target& target);
    std::array<Scalar, 3> relative(const std::array<double, 3>& position) const {
        std::array<Scalar, 3> x;
        for (std::size_t a = 0; a < 3; ++a)
            x[a] = static_cast<Scalar>((position[a] - middle_[a]) / units_.length);
        return x;
    }

    const Tree& tree_;
    const OpeningTest opening_;
    const Softening<Scalar> softening_;
    const Units units_;
    std::vector<NodeSource<Scalar>> multipoles_;  ///< of the tree's nodes; their positions are not set
    std::array<double, 3> middle_{};              ///< of the group [m]
    Targets<Scalar> targets_;
    std::vector<std::uint32_t> stack_;
    std::vector<PointSource<Scalar>> points_;
    std::vector<SoftSource<Scalar>> softened_;
    std::array<std::vector<NodeSource<Scalar>>, 3> nodes_;  ///< by order, from 1
    bool found_gap_ = false;
};

}  // namespace talus::gravity
