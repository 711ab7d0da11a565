#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "physics/gravity/gravity.hpp"
#include "physics/solid/late_phase.hpp"
#include "physics/solid/material.hpp"
#include "physics/sph/motion.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/settings.hpp"
#include "physics/sph/walls.hpp"
#include "src/phases.hpp"
#include "src/varying_grid.hpp"

namespace talus {

/// Everything that defines a run besides the particles: what a scene says, resolved.
struct Setup {
    Box box;
    sph::Settings sph;
    std::optional<gravity::Settings> gravity;           ///< none: no self-gravity
    std::vector<Material> materials;                    ///< one a body, in order
    std::vector<bool> held;                             ///< one a body: its particles never move; empty: none
    std::vector<std::optional<sph::Wall>> walls;        ///< one a body: it is a wall; empty: none is
    std::optional<std::array<double, 3>> even_gravity;  ///< acceleration, the same everywhere [m/s2]
    PartitionMethod partition = PartitionMethod::cheapest;
    double largest_damage_step = 0.1;  ///< D^(1/3) may grow by this much a step [1]
    double first_time_step = std::numeric_limits<double>::infinity();  ///< cap of the first step [s]
    int rebalance_interval = 10;          ///< steps between looks at the imbalance
    std::optional<LatePhase> late_phase;  ///< none: rock keeps its stiffness to the end
};

/// A field and the model that asks for it, in words.
struct NeededField {
    const FieldInfo* info;
    std::string_view model;
};

/// The fields that the setup's models need besides ids and positions, no more.
std::vector<NeededField> needed_fields(const Setup& setup);

/// Adds them to a set.
void add_fields(ParticleSet& particles, const Setup& setup);

/// Totals over all particles, exact sums rounded once: the same bits on any number of ranks.
struct Totals {
    double mass, kinetic_energy, internal_energy;
    std::array<double, 3> momentum, angular_momentum;
    double greatest_speed, least_density, greatest_density, least_pressure, greatest_pressure, mean_damage;
    std::uint64_t particles;
    double potential_energy = 0;  ///< of self-gravity or in even gravity, from the origin [J]
    double gravity_drift =
        0;  ///< sum of all gravity forces over the sum of their sizes, of rounding and tree [1]

    double total_energy() const { return kinetic_energy + internal_energy + potential_energy; }
};

/// Particles that could not keep their pressure: docs/scene.md, [late_phase].
struct Clipped {
    std::uint64_t particles = 0, first_id = 0;
};

/// One particle set under SPH: solids and gases of one or several bodies.
class Simulation {
  public:
    /// `particles` hold their share of the initial state or of a checkpoint, on any ranks, with the fields of
    /// add_fields() set; the position must lie in the box along closed axes. Collective.
    Simulation(const Communicator& comm, Setup setup, ParticleSet particles);

    /// First evaluation of a new run at time 0. Collective.
    void start();
    /// Goes on from a checkpoint's state: particles as they were saved, with the rates; `in_late_phase`: as
    /// it was then. Collective.
    void resume(double time, double time_step, std::uint64_t step, bool in_late_phase = false);

    /// One time step. Throws AgreedError (exit code 1) if a value is not finite or a particle was lost.
    /// Collective.
    void step();

    double time() const { return time_; }            ///< [s]
    double time_step() const { return time_step_; }  ///< of the next step [s]
    std::uint64_t step_count() const { return step_; }
    bool in_late_phase() const { return in_late_phase_; }
    /// What lost pressure when this run entered its late phase.
    const Clipped& clipped_at_late_phase() const { return clipped_; }
    const ParticleSet& particles() const { return particles_; }
    ParticleSet& particles() { return particles_; }
    const Setup& setup() const { return setup_; }
    const Communicator& comm() const { return comm_; }
    Decomposition& decomposition() { return decomposition_; }
    const Decomposition& decomposition() const { return decomposition_; }
    std::uint64_t total_particles() const { return decomposition_.total_particles(); }
    /// Pairs evaluated by this rank in the force pass since the start.
    std::uint64_t pairs() const { return pairs_; }
    /// What self-gravity did on this rank since the start; nullptr: there is none.
    const gravity::Counts* gravity_counts() const { return gravity_ ? &gravity_->counts() : nullptr; }
    /// Work of this rank at the last evaluation, in pairs: what decomposition balances.
    double work() const;
    Phases& phases() { return phases_; }
    const Phases& phases() const { return phases_; }
    /// Starts counting pairs and time anew.
    void reset_counters() {
        pairs_ = 0;
        if (gravity_) gravity_->reset_counts();
        phases_ = {};
    }
    /// What set the next time step, as far as this rank knows.
    const sph::StepLimit& step_limit() const { return limit_; }
    /// Largest interaction radius [m], over all particles. Collective.
    double interaction_radius() const;

    Totals totals() const;

  private:
    /// Interaction radius in smoothing lengths.
    double range_of_interaction() const;
    void arrange();
    void rebalance();
    void evaluate(double time_ahead, double elapsed);
    void material_response(double time_ahead, double elapsed);
    void hold_bodies();
    void return_plastic_stress(std::uint8_t body, double time_ahead, double elapsed);
    std::vector<sph::WallNow> walls_at(double time) const;
    void extrapolate_into_walls(std::span<const sph::WallNow> walls);
    bool is_wall(std::size_t body) const { return !setup_.walls.empty() && setup_.walls[body]; }
    void soften_materials();
    void enter_late_phase_when_due();
    void conclude_step();

    const Communicator& comm_;
    Setup setup_;
    sph::BodyConstants constants_;
    ParticleSet particles_;
    Decomposition decomposition_;
    std::optional<gravity::Gravity> gravity_;
    VaryingGrid grid_;
    double time_ = 0, time_step_ = 0;
    std::uint64_t step_ = 0, pairs_ = 0;
    sph::PassCount pass_count_;
    bool work_measured_ = false, in_late_phase_ = false;
    Clipped clipped_;
    double damage_limit_ = std::numeric_limits<double>::infinity();
    sph::StepLimit limit_{};
    Phases phases_;
};

}  // namespace talus
