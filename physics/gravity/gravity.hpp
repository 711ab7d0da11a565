#pragma once
#include <cstdint>
#include <span>

#include "comm/decomposition.hpp"
#include "physics/gravity/settings.hpp"
#include "physics/gravity/softening.hpp"
#include "physics/sph/motion.hpp"

namespace talus::gravity {

/// What evaluations did on this rank, since the start or the last reset.
struct Counts {
    std::uint64_t points = 0;      ///< pairs beyond softening
    std::uint64_t softened = 0;    ///< softened pairs
    std::uint64_t nodes = 0;       ///< pairs of a particle and a node
    std::uint64_t bytes_sent = 0;  ///< of the tree, to other ranks

    std::uint64_t interactions() const { return points + softened + nodes; }
};

/// Gravity that the particles of a set exert on each other, in an unbounded space of three dimensions: J.
/// Barnes, P. Hut, Nature 324 (1986) 446, with multipoles about the centre of mass, groups of targets (J.
/// Barnes, J. Comput. Phys. 87 (1990) 161) and locally essential trees (M. S. Warren, J. K. Salmon,
/// Supercomputing 1992, 570). Pairs within the reach of the SPH kernel are softened by its mass within their
/// distance, h being the mean of both. The term of a changing h is left out.
class Gravity {
  public:
    /// `sph` names the kernel. Keeps a reference to `comm`.
    Gravity(const Communicator& comm, const Settings& settings, const sph::Settings& sph);

    /// Writes gravity_acceleration and gravity_potential of the own particles; with Opening::relative reads
    /// the former. `decomposition` and `grid` are those the particles are arranged by. Adds the work of each
    /// own cell, in the unit of a pair of SPH, to `work_of_cell`. Throws AgreedError if the tree lacks a
    /// part. Collective.
    void evaluate(ParticleSet& particles, const CellGrid& grid, const Decomposition& decomposition,
                  std::span<double> work_of_cell);

    const Settings& settings() const { return settings_; }
    const Counts& counts() const { return counts_; }
    void reset_counts() { counts_ = {}; }

  private:
    template <class Scalar>
    void evaluate_tree(ParticleSet& particles, const CellGrid& grid, const Decomposition& decomposition,
                       std::span<double> work_of_cell);
    void evaluate_direct(ParticleSet& particles, std::span<double> work_of_cell);

    const Communicator& comm_;
    const Settings settings_;
    const Softening<double> softening_;
    Counts counts_;
};

/// Longest step over the own particles that gravity allows, dt = C sqrt(h/|g|), C being the step_factor.
sph::StepLimit stable_time_step(const ParticleSet& particles, const Settings& settings);

}  // namespace talus::gravity
