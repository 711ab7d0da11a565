#pragma once
#include <optional>

#include "src/run/evolution.hpp"
#include "src/setup/soil_scene.hpp"
#include "src/soil_simulation.hpp"

namespace talus {

/// Soil as a continuum on two grids of particles.
class SoilEvolution : public Evolution {
  public:
    SoilEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until);

    const std::string& title() const override { return setup_.title; }
    const OutputPlan& output() const override { return setup_.output; }
    double end_time() const override { return end_time_; }
    std::vector<std::string> warnings() const override { return {}; }
    void create(const std::function<void()>& check_stop) override;
    ReadCheckpoint read(const std::filesystem::path& what,
                        const std::filesystem::path& output_folder) override;
    void start() override { simulation_->start(); }
    void resume(const RunState& state) override { simulation_->resume(state.time, state.step); }
    void step() override { simulation_->step(); }
    double time() const override { return simulation_->time(); }
    double time_step() const override { return simulation_->time_step(); }
    std::uint64_t step_count() const override { return simulation_->step_count(); }
    std::uint64_t total_particles() const override { return simulation_->decomposition().total_particles(); }
    const ParticleSet& particles() const override { return simulation_->particles(); }
    const Decomposition& decomposition() const override { return simulation_->decomposition(); }
    Phases& phases() override { return simulation_->phases(); }
    std::uint64_t pairs() const override { return simulation_->pairs(); }
    void reset_counters() override { simulation_->reset_counters(); }
    double work() const override { return static_cast<double>(simulation_->particles().size()); }
    void describe(RunState& state) const override;
    void save(const WriteSets& write) override { write({&simulation_->particles()}); }
    std::vector<SnapshotField> snapshot_fields() const override;
    std::vector<CsvColumn> diagnostics_columns() const override;
    Diagnostics diagnostics() override;
    std::string summary() const override { return {}; }
    std::string performance() const override { return {}; }

    const SoilScene& setup() const { return setup_; }

  private:
    std::vector<std::string> materials() const;
    std::vector<std::string> boundaries() const;  ///< what tells them apart, in order

    const Communicator& comm_;
    SoilScene setup_;
    double end_time_;  ///< [s]
    std::optional<SoilSimulation> simulation_;
};

}  // namespace talus
