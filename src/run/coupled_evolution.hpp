#pragma once
#include <optional>

#include "src/coupled_simulation.hpp"
#include "src/run/evolution.hpp"
#include "src/run/notes.hpp"
#include "src/setup/coupled_scene.hpp"
#include "src/water/water_record.hpp"

namespace talus {

/// Water and grains that act on each other.
class CoupledEvolution : public Evolution {
  public:
    CoupledEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until);

    const std::string& title() const override { return setup_.water.title; }
    const OutputPlan& output() const override { return setup_.water.output; }
    double end_time() const override { return end_time_; }
    std::vector<std::string> warnings() const override;
    /// Grains settle only if there is a `check_stop`.
    void create(const std::function<void()>& check_stop) override;
    ReadCheckpoint read(const std::filesystem::path& what,
                        const std::filesystem::path& output_folder) override;
    void start() override;
    void resume(const RunState& state) override;
    void step() override { simulation_->step(); }
    std::vector<std::string> news() override;
    double time() const override { return simulation_->water().time(); }
    double time_step() const override { return simulation_->water().time_step(); }
    std::uint64_t step_count() const override { return simulation_->water().step_count(); }
    std::uint64_t total_particles() const override {
        return simulation_->water().total_particles() + simulation_->grains().total_grains();
    }
    const ParticleSet& particles() const override { return simulation_->water().particles(); }
    const Decomposition& decomposition() const override { return simulation_->water().decomposition(); }
    Phases& phases() override { return simulation_->water().phases(); }
    std::uint64_t pairs() const override { return simulation_->water().pairs() + simulation_->pairs(); }
    void reset_counters() override { simulation_->reset_counters(); }
    double work() const override { return simulation_->water().work(); }
    void describe(RunState& state) const override;
    void save(const WriteSets& write) override;
    std::vector<SnapshotField> snapshot_fields() const override;
    std::vector<SnapshotSet> more_snapshots() override;
    std::vector<CsvColumn> diagnostics_columns() const override;
    Diagnostics diagnostics() override;
    std::string summary() const override;
    std::string performance() const override;

    const CoupledScene& setup() const { return setup_; }
    const CoupledSimulation& simulation() const { return *simulation_; }

  private:
    std::vector<std::string> bodies() const;

    const Communicator& comm_;
    const Scene& scene_;
    CoupledScene setup_;
    double end_time_;  ///< [s]
    WaterRecord record_;
    Watch speed_, overlap_{most_overlap_of_hard_grains};  ///< of what diagnostics saw
    std::optional<CoupledSimulation> simulation_;
    std::vector<std::string> core_warnings_;    ///< of the first state
    std::optional<ParticleSet> read_contacts_;  ///< of the checkpoint, until resume()
};

}  // namespace talus
