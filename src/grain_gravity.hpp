#pragma once
#include <cstdint>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/cell_grid.hpp"
#include "domain/particles.hpp"
#include "physics/dem/clumps/clump_motion.hpp"
#include "physics/dem/motion.hpp"
#include "physics/gravity/gravity.hpp"

namespace talus {

/// How grains attract each other; the [gravity] table of a scene of grains.
struct SelfGravity {
    gravity::Settings settings;
    int interval = 1;  ///< steps of the contacts for each impulse of gravity
};

/// Gravity of grains as impulses between blocks of `interval` steps under contact forces alone: half of the
/// block's impulse before it and half after it, which is of second order in the length of the block and keeps
/// the phase-space volume. M. Tuckerman, B. J. Berne, G. J. Martyna, J. Chem. Phys. 97 (1992) 1990. Between
/// blocks velocities are those of the positions' time; within one they hold an impulse too much or too
/// little. Spheres attract as points at their centres, which is exact unless they overlap; those that do are
/// softened by a kernel that ends where they touch. The mass of a clump
/// lies at the centres of its spheres (ClumpShape::mass_shares): they pull at it and turn it, and what those
/// of one clump do to each other cancels but for the tree's error.
class GrainGravity {
  public:
    /// `time_step`: of the contacts [s]. Keeps references to `comm` and `clumps`.
    GrainGravity(const Communicator& comm, const SelfGravity& plan, double time_step,
                 const dem::ClumpMotion& clumps);

    static void add_fields(ParticleSet& grains);

    /// At the start of a new run: evaluates, and returns the impulse that the first block begins with.
    dem::Impulse start(ParticleSet& grains, const CellGrid& grid, Decomposition& decomposition);
    /// Before a step: gives grains that are not held the first half of a block's impulse.
    void begin_step(ParticleSet& grains, const dem::Responses& responses, Decomposition& decomposition) const;
    /// Whether the step that has begun ends a block: its positions must be arranged for evaluation.
    bool ends_block() const { return steps_in_block_ + 1 == plan_.interval; }
    /// After a step's forces: at the end of a block evaluates, and returns the impulses of that block and the
    /// next; none within one. Collective.
    dem::Impulse end_step(ParticleSet& grains, const CellGrid& grid, Decomposition& decomposition);

    /// Whether velocities and positions are of the same time: between blocks.
    bool is_synchronous() const { return steps_in_block_ == 0; }
    const gravity::Counts& counts() const { return gravity_.counts(); }
    void reset_counts() { gravity_.reset_counts(); }

  private:
    dem::Impulse evaluate(ParticleSet& grains, const CellGrid& grid, Decomposition& decomposition,
                          double now);
    void share_attraction(ParticleSet& grains, Decomposition& decomposition) const;

    const SelfGravity plan_;
    const double half_block_;  ///< [s]
    const dem::ClumpMotion& clumps_;
    gravity::Gravity gravity_;
    int steps_in_block_ = 0;
    std::vector<double> work_of_cell_;
};

}  // namespace talus
