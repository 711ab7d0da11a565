#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/particles.hpp"
#include "physics/soil/boundary_conditions.hpp"
#include "physics/soil/constitutive.hpp"
#include "physics/soil/moving_grids.hpp"
#include "physics/soil/pore_pressure.hpp"
#include "physics/soil/stencils.hpp"
#include "physics/soil/taylor_galerkin.hpp"
#include "physics/soil/time_factor.hpp"
#include "src/phases.hpp"

namespace talus {

/// Everything that defines a run of soil besides its particles: what a scene says, resolved.
struct SoilSetup {
    int dimension = 2;
    std::vector<soil::Material> materials;  ///< one a body, in order
    double spacing = 0;                     ///< of the nodes [m]
    double courant = 0.9;                   ///< dt = courant * spacing / fastest wave
    std::array<double, 3> gravity{};        ///< [m/s2]
    soil::TimeFactor gravity_factor, strength_factor;
    double damping = 0;                          ///< [1/s]
    double hourglass = 0, stress_smoothing = 0;  ///< as soil::StepSettings
    std::vector<soil::BoundaryCondition> conditions;
    bool moves = false;             ///< large deformation: nodes and elements move
    bool saturated = false;         ///< pores hold water under pressure: the v-p_w model
    bool free_tight_faces = false;  ///< in 2D or 3D: soil::FreeFaces
    double pressure_smoothing = 0;  ///< soil::PorePressure::Settings::stabilisation
    double pressure_tolerance = 0;  ///< soil::PorePressure::Settings::tolerance
    PartitionMethod partition = PartitionMethod::cheapest;
};

/// Whether bodies differ in density.
bool has_layers(const SoilSetup& setup);

/// The fields that the setup's models need besides ids and positions, no more.
void add_fields(ParticleSet& particles, const SoilSetup& setup);

/// Totals over all nodes, exact sums rounded once: the same bits on any number of ranks.
struct SoilTotals {
    double mass = 0, kinetic_energy = 0, elastic_energy = 0, viscoplastic_work = 0;
    std::array<double, 3> momentum{};
    double greatest_speed = 0, greatest_displacement = 0, greatest_viscoplastic_strain = 0;
    double least_pore_pressure = 0, greatest_pore_pressure = 0;
    /// Of what is around the soil, through the face of each boundary condition with one [N, N/m in 2D, Pa in
    /// 1D].
    std::vector<std::array<double, 3>> forces;
};

/// Soil as a continuum on two grids of particles: Runge-Kutta Taylor-SPH in small strain, or moving with the
/// soil in large deformation.
class SoilSimulation {
  public:
    /// `particles` hold their share of the initial state or of a checkpoint, on any ranks, with the fields
    /// of add_fields(). Collective.
    SoilSimulation(const Communicator& comm, SoilSetup setup, ParticleSet particles);

    /// A new run at time 0. Throws AgreedError (exit code 1) if a particle has too few partners. Collective.
    void start();
    /// Goes on from a checkpoint's state. Collective.
    void resume(double time, std::uint64_t step);
    /// One time step. Throws AgreedError (exit code 1) if a value is not finite, a node is faster
    /// than 10 waves, or stress relaxes too fast. Collective.
    void step();

    double time() const { return time_; }            ///< [s]
    double time_step() const { return time_step_; }  ///< the same throughout [s]
    std::uint64_t step_count() const { return step_; }
    const ParticleSet& particles() const { return particles_; }
    ParticleSet& particles() { return particles_; }
    const SoilSetup& setup() const { return setup_; }
    const Decomposition& decomposition() const { return decomposition_; }
    const soil::Stencils& stencils() const { return stencils_; }
    /// Partners summed over by this rank since the counters were reset.
    std::uint64_t pairs() const { return pairs_; }
    Phases& phases() { return phases_; }
    void reset_counters() {
        pairs_ = 0;
        phases_ = {};
    }
    /// Iterations of the pore pressure's equation in the last step.
    int pressure_iterations() const { return pore_pressure_ ? pore_pressure_->iterations() : 0; }
    /// Collective.
    SoilTotals totals() const;

  private:
    bool smooths() const { return setup_.hourglass > 0 || setup_.stress_smoothing > 0; }
    void advance_pore_pressure(const std::array<double, 3>& body_force);
    void arrange();
    void list_stencils();
    soil::StepSettings settings_now() const;
    void step_at_rest(const soil::StepSettings& settings);
    void step_moving(const soil::StepSettings& settings);
    std::uint64_t first_runaway() const;
    void refuse_what_broke(std::uint64_t too_fast);
    void add_force(const soil::BoundaryNode& node, std::span<class ExactSum> sums) const;

    const Communicator& comm_;
    SoilSetup setup_;
    ParticleSet particles_;
    Decomposition decomposition_;
    std::unique_ptr<CellGrid> grid_;
    soil::Stencils stencils_;
    std::vector<soil::BoundaryNode> boundary_nodes_;
    soil::FreeAxes free_axes_;
    bool any_free_face_ = false;  ///< on any rank
    soil::StepMemory memory_;
    soil::MovingMemory moving_memory_;
    std::optional<soil::PorePressure> pore_pressure_;
    double time_ = 0, time_step_ = 0;
    std::uint64_t step_ = 0, pairs_ = 0;
    Phases phases_;
};

}  // namespace talus
