#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "physics/coupling/exchange.hpp"
#include "physics/coupling/passes.hpp"
#include "src/grain_simulation.hpp"
#include "src/water_simulation.hpp"

namespace talus {

/// How grains and the water around them act on each other, grains smaller than the kernel of the water.
struct CouplingSetup {
    coupling::Spreading spreading;
    coupling::VolumeFraction fraction = coupling::VolumeFraction::normalised;
    coupling::ExchangeLaws laws;
};

/// Everything that defines a run of water with grains in it, besides the particles.
struct CoupledSetup {
    WaterSetup water;  ///< of the same box as the grains
    GrainSetup grains;
    CouplingSetup coupling;
};

/// What water and grains exchange: exact sums rounded once.
struct CouplingTotals {
    std::array<double, 3> force{};       ///< of the water on all grains at the last exchange [N]
    std::array<double, 3> held_force{};  ///< on those of them that are held [N]
    /// Of the grains that are not held, of all if every one is, weighted by mass [m].
    std::array<double, 3> mean_place{};
    double imbalance = 0;  ///< |forces on grains and water together| over the sum of their sizes [1]
    double least_fluid_fraction = 1, greatest_kernel_sum = 0;
    double grain_volume = 0, spread_volume = 0;  ///< of all grains, and as the water sees it [m3]
    std::uint64_t clipped = 0;  ///< particles of water with less room than the exchange allows for
};

/// Water as particles and grains in it, on the mean equations of T. B. Anderson, R. Jackson, Ind. Eng. Chem.
/// Fundam. 6 (1967) 527, as M. Robinson, M. Ramaioli, S. Luding, Int. J. Multiphase Flow 59 (2014) 121 put
/// them on particles: the density of the water is its mass for each volume of space, its pressure follows
/// from that over the share of space that grains leave. Grains move in whole steps of their own within each
/// step of the water (docs/decisions/023).
class CoupledSimulation {
  public:
    /// `water` and `grains` hold their shares of the initial state or of a checkpoint, on any ranks.
    /// Collective.
    CoupledSimulation(const Communicator& comm, CoupledSetup setup, ParticleSet water, ParticleSet grains);
    CoupledSimulation(const CoupledSimulation&) = delete;

    /// Sets with the fields that they need, for setups completed().
    static CoupledSetup completed(CoupledSetup setup);

    /// Lets the grains come to rest without the water, if their setup says so. `before_step` (collective) is
    /// called before each step and may throw. Throws as GrainSimulation::step() does. Collective.
    void settle(const std::function<void()>& before_step);
    /// Takes away the water that is where grains are, and makes the first evaluation. Collective.
    void start();
    /// Goes on from a checkpoint. Collective.
    void resume(double time, double time_step, std::uint64_t step,
                const std::map<std::string, double>& numbers, const ParticleSet& contacts);
    /// One time step of the water. Throws AgreedError (exit code 1) as either simulation does, or if the
    /// water asks for a shorter step than that of the grains. Collective.
    void step();

    void save_numbers(std::map<std::string, double>& numbers) const;
    /// Names of what is saved of Basset's kernel [s], at whose rates the memories in a checkpoint fade.
    static constexpr const char *shortest_memory = "basset.shortest", *longest_memory = "basset.longest";

    const WaterSimulation& water() const { return water_; }
    WaterSimulation& water() { return water_; }
    const GrainSimulation& grains() const { return grains_; }
    GrainSimulation& grains() { return grains_; }
    const CoupledSetup& setup() const { return setup_; }
    /// Pairs of grains and water that this rank weighed since the counters were reset.
    std::uint64_t pairs() const { return pairs_; }
    void reset_counters();
    /// Whether some grains are held and others move.
    bool holds_some_grains() const;
    /// Steps of the grains in the next one of the water.
    int substeps() const;
    /// Collective.
    CouplingTotals totals() const;

  private:
    void immerse();
    void choose_time_step();
    void exchange();
    void fill_immersed();
    std::vector<dem::Vector3<>> at_home(const Field<double>& field);
    void return_forces();
    std::vector<dem::Vector3<>> remembered_slips(std::span<const coupling::Gathered> around,
                                                 const coupling::HistoryKernel::Passage& passage);
    void weigh_work();
    void refresh_water(std::initializer_list<const FieldInfo*> fields);
    void refresh_immersed(std::initializer_list<const FieldInfo*> fields);
    coupling::Mixture mixture();
    const Field<double>& shared_fraction() const;

    const Communicator& comm_;
    CoupledSetup setup_;
    WaterSimulation water_;
    GrainSimulation grains_;
    ParticleSet immersed_;  ///< the grains, as the water sees them
    Decomposition immersed_cells_;
    SparseExchange exchange_;
    double last_step_ = 0;  ///< time over which grains have moved since the last exchange [s]
    bool starting_ = false, settled_ = false;
    std::uint64_t pairs_ = 0;
};

}  // namespace talus
