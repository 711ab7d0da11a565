#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "domain/terrain.hpp"
#include "physics/depth/consolidation.hpp"
#include "physics/depth/motion.hpp"
#include "physics/depth/passes.hpp"
#include "physics/depth/settings.hpp"
#include "src/depth/outflow.hpp"
#include "src/phases.hpp"
#include "src/varying_grid.hpp"

namespace talus {

/// Excess pore pressure at the bed, which takes from its friction.
struct PorePressure {
    depth::Consolidation law;
    int points = 1;           ///< of a profile over the depth; 1: the first mode alone
    double ratio = 1;         ///< of the pressure at the start to the load
    double loaded_share = 1;  ///< of the normal stress that loads the mixture: 1, or less under buoyancy
};

/// Everything that defines a depth-integrated run besides the particles: what a scene says, resolved.
struct DepthSetup {
    Box box;  ///< in plan, of one dimension or two
    std::shared_ptr<const Terrain> terrain;
    depth::Settings settings;
    depth::BasalFriction friction;
    std::optional<PorePressure> pore_pressure{};
    PartitionMethod partition = PartitionMethod::cheapest;
    int rebalance_interval = 10;  ///< steps between looks at the imbalance
};

/// Totals over all particles, exact sums rounded once: the same bits on any number of ranks. In 1D all for
/// each metre of width.
struct DepthTotals {
    double volume = 0;                                      ///< [m3]
    double kinetic_energy = 0;                              ///< of the speed along the bed [J]
    double potential_energy = 0;                            ///< against elevation 0 [J]
    std::array<double, 2> momentum{};                       ///< in plan [kg m/s]
    std::array<double, 2> centre{};                         ///< of the volume, in plan [m]
    std::array<double, 2> least_place{}, greatest_place{};  ///< corners of what the flow covers [m]
    double greatest_speed = 0, greatest_depth = 0;
    double stopped = 0;                    ///< share of the volume that does not move at all [1]
    double water_volume = 0;               ///< of two phases [m3]
    std::array<double, 2> water_centre{};  ///< in plan [m]
};

/// Columns of a flow over terrain under depth-integrated equations.
class DepthSimulation {
  public:
    /// `particles` hold their share of the initial state or of a checkpoint, on any ranks, with the fields of
    /// add_fields(). Collective.
    DepthSimulation(const Communicator& comm, DepthSetup setup, ParticleSet particles);

    static void add_fields(ParticleSet& particles, const DepthSetup& setup);

    /// Finds the smoothing lengths and makes the first evaluation of a new run at time 0. Collective.
    void start();
    /// Goes on from a checkpoint's state and what save_numbers() added to it. Collective.
    void resume(double time, double time_step, std::uint64_t step,
                const std::map<std::string, double>& numbers);

    /// One time step. Throws AgreedError (exit code 1) if a value is not finite, a particle was lost or meets
    /// a hole of the terrain. Collective.
    void step();

    double time() const { return time_; }            ///< [s]
    double time_step() const { return time_step_; }  ///< of the next step [s]
    std::uint64_t step_count() const { return step_; }
    const ParticleSet& particles() const { return particles_; }
    const DepthSetup& setup() const { return setup_; }
    const Communicator& comm() const { return comm_; }
    const Decomposition& decomposition() const { return decomposition_; }
    const Outflow& outflow() const { return outflow_; }
    Outflow& outflow() { return outflow_; }
    std::uint64_t total_particles() const { return decomposition_.total_particles(); }
    /// Pairs evaluated by this rank in the pressure pass since the counters were reset.
    std::uint64_t pairs() const { return pairs_; }
    /// Work of this rank at the last evaluation, in pairs.
    double work() const;
    Phases& phases() { return phases_; }
    const sph::StepLimit& step_limit() const { return limit_; }
    void reset_counters() {
        pairs_ = 0;
        phases_ = {};
    }
    /// Largest interaction radius [m]. Collective.
    double interaction_radius() const;
    void save_numbers(std::map<std::string, double>& numbers) const { outflow_.save(numbers); }
    /// Collective.
    DepthTotals totals() const;
    /// Of the column's material [kg/m3].
    double density(std::size_t i) const;
    /// Of the whole flow where a column is, both phases if there are two: as depth is of one [m].
    double whole_depth(std::size_t i) const;

  private:
    void arrange();
    void find_heights();
    double change_of_smoothing_lengths() const;
    void evaluate(double time_ahead);
    std::vector<double> loads() const;
    void consolidate(std::span<const double> loads_before, double time_step);
    void drag(double time);
    void erode(double time);
    void copy_velocity();
    Decomposition::Ledger merge();
    void conclude_step();

    const Communicator& comm_;
    DepthSetup setup_;
    ParticleSet particles_;
    Decomposition decomposition_;
    Outflow outflow_;
    VaryingGrid grid_{4};  ///< few columns have the largest radius: small cells list fewer candidates
    double time_ = 0, time_step_ = 0;
    std::uint64_t step_ = 0, pairs_ = 0;
    sph::PassCount pass_count_;
    bool work_measured_ = false;
    sph::StepLimit limit_{};
    Phases phases_;
};

}  // namespace talus
