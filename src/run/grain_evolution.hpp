#pragma once
#include <optional>

#include "src/grain_simulation.hpp"
#include "src/run/evolution.hpp"
#include "src/run/notes.hpp"
#include "src/setup/grain_scene.hpp"
#include "src/setup/shrink_grains.hpp"

namespace talus {

/// Grains under contact laws.
class GrainEvolution : public Evolution {
  public:
    GrainEvolution(const Communicator& comm, const Scene& scene, std::optional<double> until);

    const std::string& title() const override { return setup_.title; }
    const OutputPlan& output() const override { return setup_.output; }
    double end_time() const override { return end_time_; }
    std::vector<std::string> warnings() const override;
    std::vector<std::string> preparations() const override;
    void create(const std::function<void()>& check_stop) override;
    ReadCheckpoint read(const std::filesystem::path& what,
                        const std::filesystem::path& output_folder) override;
    void start() override {}  // create() does: overlaps are known only then
    void resume(const RunState& state) override;
    /// As many steps as it takes until the state is one to write and to go on from.
    void step() override;
    std::vector<std::string> news() override;
    double time() const override { return simulation_->time(); }
    double time_step() const override { return simulation_->time_step(); }
    std::uint64_t step_count() const override { return simulation_->step_count(); }
    std::uint64_t total_particles() const override { return simulation_->total_grains(); }
    const ParticleSet& particles() const override { return simulation_->grains(); }
    const Decomposition& decomposition() const override { return simulation_->decomposition(); }
    Phases& phases() override { return simulation_->phases(); }
    std::uint64_t pairs() const override { return simulation_->evaluated_contacts(); }
    void reset_counters() override { simulation_->reset_counters(); }
    double work() const override { return static_cast<double>(simulation_->grains().size()); }
    void describe(RunState& state) const override;
    void save(const WriteSets& write) override;
    std::vector<SnapshotField> snapshot_fields() const override;
    std::vector<SnapshotSet> more_snapshots() override;
    std::vector<CsvColumn> diagnostics_columns() const override;
    Diagnostics diagnostics() override;
    std::string summary() const override;
    std::string performance() const override;

    const GrainScene& setup() const { return setup_; }
    const GrainSimulation& simulation() const { return *simulation_; }

  private:
    std::vector<std::string> materials() const;
    void check_shear(const ReadCheckpoint& found) const;
    bool torques_have_meaning() const;
    bool has_bonds() const { return !setup_.simulation.bonds.empty(); }

    const Communicator& comm_;
    const Scene& scene_;
    GrainScene setup_;
    double end_time_;  ///< [s]
    std::optional<GrainSimulation> simulation_;
    std::optional<ParticleSet> read_contacts_, read_bonds_;  ///< of the checkpoint, until resume()
    Shrunk shrunk_;                                          ///< at the start
    double first_overlap_ = 0;                               ///< over the radius [1]
    Watch overlap_{most_overlap_of_hard_grains};             ///< of what diagnostics saw
    Watch step_share_{1};                ///< the time step over what pressed grains bear, likewise
    double overlap_of_stable_step_ = 0;  ///< over the radius [1]
    std::vector<std::string> impact_warnings_;
};

}  // namespace talus
