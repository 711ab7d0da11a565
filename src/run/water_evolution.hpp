#pragma once
#include <optional>

#include "src/run/evolution.hpp"
#include "src/run/notes.hpp"
#include "src/setup/water_scene.hpp"
#include "src/water/water_record.hpp"
#include "src/water_simulation.hpp"

namespace talus {

/// Water with free surfaces between walls.
class WaterEvolution : public Evolution {
  public:
    WaterEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until);

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
    void step() override { simulation_->step(); }
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
    void describe(RunState& state) const override;
    void save(const WriteSets& write) override;
    std::vector<SnapshotField> snapshot_fields() const override;
    std::vector<CsvColumn> diagnostics_columns() const override;
    Diagnostics diagnostics() override;
    std::string summary() const override;
    std::string performance() const override { return {}; }

    const WaterScene& setup() const { return setup_; }
    const WaterSimulation& simulation() const { return *simulation_; }

  private:
    void emplace(ParticleSet particles);
    void add_columns_of(const std::string& name, std::vector<CsvColumn>& columns) const;
    void add_row_of(const RigidTotals& body, std::vector<double>& row) const;

    const Communicator& comm_;
    const Scene& scene_;
    WaterScene setup_;
    double end_time_;  ///< [s]
    WaterRecord record_;
    std::optional<WaterSimulation> simulation_;
    std::vector<std::string> core_warnings_;  ///< of the first state
    Watch speed_;                             ///< of what diagnostics saw [m/s]
};

}  // namespace talus
