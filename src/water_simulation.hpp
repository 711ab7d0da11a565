#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/box.hpp"
#include "domain/cell_grid.hpp"
#include "domain/particles.hpp"
#include "physics/sph/walls.hpp"
#include "physics/water/motion.hpp"
#include "physics/water/passes.hpp"
#include "physics/water/settings.hpp"
#include "src/phases.hpp"
#include "src/rigid_bodies.hpp"
#include "src/water/open_boundaries.hpp"

namespace talus {

/// Everything that defines a run of water besides the particles: what a scene says, resolved.
struct WaterSetup {
    Box box;
    water::Settings settings;
    std::vector<std::optional<sph::Wall>> walls;  ///< one a body: it is a wall; empty: none is
    OpenPlan open{};                              ///< inflows and outflows
    std::vector<std::uint8_t> records_force{};    ///< one a body, not 0: its force is; empty: of none
    PartitionMethod partition = PartitionMethod::cheapest;
    int rebalance_interval = 10;  ///< steps between looks at the imbalance
    RigidSetup rigid;             ///< those of the walls that move freely
    bool holds_grains = false;    ///< that act on the water: CoupledSimulation
};

/// Totals over the water, walls left out: exact sums rounded once, the same bits on any number of ranks.
struct WaterTotals {
    double mass = 0;              ///< [kg]
    double kinetic_energy = 0;    ///< [J]
    double potential_energy = 0;  ///< in even gravity, from the origin [J]
    double elastic_energy = 0;    ///< of compression [J]
    std::array<double, 3> momentum{};
    double greatest_speed = 0;
    double least_density = 0, greatest_density = 0, least_pressure = 0, greatest_pressure = 0;
    std::array<double, 3> least_place{}, greatest_place{};  ///< corners of what the water fills [m]
    std::uint64_t particles = 0;

    double total_energy() const { return kinetic_energy + potential_energy + elastic_energy; }
};

/// Water as a barely compressible fluid of particles, with walls of particles around it.
class WaterSimulation {
  public:
    /// `particles` hold their share of the initial state or of a checkpoint, on any ranks, with the fields of
    /// add_fields(). Collective.
    WaterSimulation(const Communicator& comm, WaterSetup setup, ParticleSet particles);

    static void add_fields(ParticleSet& particles, const WaterSetup& setup);

    /// First evaluation of a new run at time 0. Collective.
    void start();
    /// Goes on from a checkpoint's state and what save_numbers() added to it. Collective.
    void resume(double time, double time_step, std::uint64_t step,
                const std::map<std::string, double>& numbers);

    /// Rigid bodies; null if the scene has none. Before resume() they must be restored.
    RigidBodies* rigid() { return rigid_.get(); }
    const RigidBodies* rigid() const { return rigid_.get(); }

    /// One time step. Throws AgreedError (exit code 1) if a value is not finite or a particle was lost.
    /// Collective.
    void step();

    /// What grains in the water change of it.
    struct Access {
        ParticleSet& particles;
        Decomposition& decomposition;
        const CellGrid& grid;
        std::vector<double>& work_of_cell;
    };
    Access access() { return {particles_, decomposition_, *grid_, pass_count_.work_of_cell}; }
    /// `find(time)` is called before each evaluation, when particles are where they belong.
    void before_evaluation(std::function<void(double)> find) { before_evaluation_ = std::move(find); }
    /// Makes the next step no longer than it would be.
    void set_time_step(double time_step) { time_step_ = time_step; }

    /// Cells of the grid on which the water is spread over ranks.
    static CellGrid cells(const WaterSetup& setup);

    double time() const { return time_; }            ///< [s]
    double time_step() const { return time_step_; }  ///< of the next step [s]
    std::uint64_t step_count() const { return step_; }
    const ParticleSet& particles() const { return particles_; }
    const WaterSetup& setup() const { return setup_; }
    const Communicator& comm() const { return comm_; }
    const Decomposition& decomposition() const { return decomposition_; }
    std::uint64_t total_particles() const { return decomposition_.total_particles(); }
    /// Pairs that this rank looked at in the force pass since the counters were reset.
    std::uint64_t pairs() const { return pairs_; }
    /// Work of this rank at the last evaluation, in pairs.
    double work() const;
    Phases& phases() { return phases_; }
    const sph::StepLimit& step_limit() const { return limit_; }
    void reset_counters() {
        pairs_ = 0;
        phases_ = {};
    }
    void save_numbers(std::map<std::string, double>& numbers) const {
        if (open_) open_->save(numbers);
    }
    /// Inflows and outflows; null if the scene has none.
    OpenBoundaries* open() { return open_.get(); }
    const OpenBoundaries* open() const { return open_.get(); }
    /// Whether a body is neither a wall nor an inflow or outflow.
    bool is_water(std::size_t body) const {
        return (setup_.walls.empty() || !setup_.walls[body]) &&
               (setup_.open.buffers.empty() || !setup_.open.buffers[body].is_open());
    }
    /// Collective.
    WaterTotals totals() const;

  private:
    void arrange();
    void evaluate(double time_ahead, double time);
    void pass_open_ends();
    std::vector<sph::WallNow> walls_at(double time) const;
    void conclude_step();

    const Communicator& comm_;
    WaterSetup setup_;
    std::function<void(double)> before_evaluation_;
    ParticleSet particles_;
    Decomposition decomposition_;
    std::unique_ptr<CellGrid> grid_;
    std::unique_ptr<OpenBoundaries> open_;
    std::vector<std::uint64_t> seeing_;  ///< own particles of each open end that see water
    std::unique_ptr<RigidBodies> rigid_;
    double time_ = 0, time_step_ = 0;
    std::uint64_t step_ = 0, pairs_ = 0;
    sph::PassCount pass_count_;
    bool work_measured_ = false;
    sph::StepLimit limit_{};
    Phases phases_;
};

}  // namespace talus
