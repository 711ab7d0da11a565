#pragma once
#include <optional>

#include "src/depth_simulation.hpp"
#include "src/run/evolution.hpp"
#include "src/setup/depth_scene.hpp"

namespace talus {

/// Depth-integrated flows over terrain.
class DepthEvolution : public Evolution {
  public:
    DepthEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until);

    const std::string& title() const override { return setup_.title; }
    const OutputPlan& output() const override { return setup_.output; }
    double end_time() const override { return end_time_; }
    std::vector<std::string> warnings() const override;
    void create(const std::function<void()>& check_stop) override;
    ReadCheckpoint read(const std::filesystem::path& what,
                        const std::filesystem::path& output_folder) override;
    void start() override;
    void resume(const RunState& state) override {
        simulation_->resume(state.time, state.time_step, state.step, state.numbers);
    }
    void step() override;
    std::vector<std::string> news() override;
    double time() const override { return simulation_->time(); }
    double time_step() const override { return simulation_->time_step(); }
    std::uint64_t step_count() const override { return simulation_->step_count(); }
    std::uint64_t total_particles() const override { return simulation_->total_particles(); }
    const ParticleSet& particles() const override { return simulation_->particles(); }
    const Decomposition& decomposition() const override { return simulation_->decomposition(); }
    Phases& phases() override { return simulation_->phases(); }
    std::uint64_t pairs() const override { return simulation_->pairs(); }
    void reset_counters() override { simulation_->reset_counters(); }
    double work() const override { return simulation_->work(); }
    void describe(RunState& state) const override { simulation_->save_numbers(state.numbers); }
    void save(const WriteSets& write) override;
    std::vector<SnapshotField> snapshot_fields() const override;
    std::vector<CsvColumn> diagnostics_columns() const override;
    Diagnostics diagnostics() override;
    std::string summary() const override;
    std::string performance() const override { return {}; }
    std::string analyse(const std::filesystem::path& folder, const RunState& state) const override;

    const DepthScene& setup() const { return setup_; }
    const DepthSimulation& simulation() const { return *simulation_; }

  private:
    void check_box() const;

    const Communicator& comm_;
    const Scene& scene_;
    DepthScene setup_;
    double end_time_;  ///< [s]
    std::optional<DepthSimulation> simulation_;
    std::optional<FlowRecord> record_;  ///< if the scene wants rasters
};

}  // namespace talus
