#pragma once
#include <optional>

#include "src/run/evolution.hpp"
#include "src/simulation.hpp"

namespace talus {

/// Solids and gases under SPH.
class SphEvolution : public Evolution {
  public:
    SphEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until);

    const std::string& title() const override { return setup_.title; }
    const OutputPlan& output() const override { return setup_.output; }
    double end_time() const override { return end_time_; }
    std::vector<std::string> warnings() const override;
    std::vector<std::string> preparations() const override;
    void create(const std::function<void()>& check_stop) override;
    ReadCheckpoint read(const std::filesystem::path& what,
                        const std::filesystem::path& output_folder) override;
    void start() override { simulation_->start(); }
    void resume(const RunState& state) override {
        simulation_->resume(state.time, state.time_step, state.step, state.numbers.contains("late_phase"));
    }
    void step() override { simulation_->step(); }
    double time() const override { return simulation_->time(); }
    double time_step() const override { return simulation_->time_step(); }
    std::uint64_t step_count() const override { return simulation_->step_count(); }
    std::uint64_t total_particles() const override { return simulation_->total_particles(); }
    const ParticleSet& particles() const override { return simulation_->particles(); }
    const Decomposition& decomposition() const override { return simulation_->decomposition(); }
    Phases& phases() override { return simulation_->phases(); }
    std::uint64_t pairs() const override { return simulation_->pairs(); }
    void reset_counters() override {
        simulation_->reset_counters();
        counted_from_ = step_count();
    }
    double work() const override { return simulation_->work(); }
    void describe(RunState& state) const override;
    std::string news() override;
    void save(const WriteSets& write) override { write({&simulation_->particles()}); }
    std::vector<SnapshotField> snapshot_fields() const override;
    std::vector<CsvColumn> diagnostics_columns() const override;
    Diagnostics diagnostics() const override;
    std::string summary() const override;
    std::string performance() const override;
    std::string analyse(const std::filesystem::path& folder, const RunState& state) const override;
    std::string hand_over(const std::filesystem::path& folder, const RunState& state) const override;

  private:
    const Communicator& comm_;
    const Scene& scene_;
    SceneSetup setup_;
    double end_time_;  ///< [s]
    std::optional<double>
        unused_until_;  ///< what the user asked for, if the hand-off ends the run before [s]
    bool told_of_clipped_ = false;
    std::vector<Settling> settlings_;
    std::optional<Simulation> simulation_;
    std::uint64_t counted_from_ = 0;  ///< step
};

}  // namespace talus
