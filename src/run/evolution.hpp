#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comm/decomposition.hpp"
#include "domain/particles.hpp"
#include "io/csv.hpp"
#include "io/run_state.hpp"
#include "io/scene.hpp"
#include "io/snapshot.hpp"
#include "src/phases.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

/// Where a run's first state came from, if it is not new.
struct ReadCheckpoint {
    std::filesystem::path file;
    RunState state;
    double seconds = 0;  ///< wall time of reading [s]
};

/// What a record of the diagnostics says.
struct Diagnostics {
    std::vector<double> row;  ///< of the columns
    double total_energy = 0;  ///< that should stay the same [J]; 0 where no such energy is known
};

/// What a scene describes and how it moves on in time: all that the run loop and the recorder know of it. One
/// implementation a family of models. All methods but the plain getters are collective.
class Evolution {
  public:
    virtual ~Evolution() = default;

    virtual const std::string& title() const = 0;
    virtual const OutputPlan& output() const = 0;
    virtual double end_time() const = 0;  ///< [s]
    /// What a user should know before the first step.
    virtual std::vector<std::string> warnings() const = 0;

    /// Makes the particles of a new run; calls check_stop() now and then if that takes long.
    virtual void create(const std::function<void()>& check_stop) = 0;
    /// What create() did, in words.
    virtual std::vector<std::string> preparations() const { return {}; }
    /// Reads those of the checkpoint that `what` means (see find_checkpoint()).
    virtual ReadCheckpoint read(const std::filesystem::path& what,
                                const std::filesystem::path& output_folder) = 0;
    /// First evaluation after create().
    virtual void start() = 0;
    /// Goes on from the state that was read.
    virtual void resume(const RunState& state) = 0;
    /// One time step. Throws AgreedError if the run cannot go on.
    virtual void step() = 0;

    /// What happened at the start or in the last step that a user should know, once; or nothing.
    virtual std::string news() { return {}; }

    virtual double time() const = 0;       ///< [s]
    virtual double time_step() const = 0;  ///< [s]
    virtual std::uint64_t step_count() const = 0;
    virtual std::uint64_t total_particles() const = 0;
    virtual const ParticleSet& particles() const = 0;
    virtual const Decomposition& decomposition() const = 0;
    virtual Phases& phases() = 0;
    /// Pairs evaluated by this rank since the counters were reset.
    virtual std::uint64_t pairs() const = 0;
    virtual void reset_counters() = 0;
    /// Work of this rank at the last evaluation, in any unit.
    virtual double work() const = 0;

    /// Adds to a checkpoint's state what it must know besides time and particles.
    virtual void describe(RunState& state) const = 0;
    /// Calls write(sets) with all particle sets that a checkpoint holds.
    using WriteSets = std::function<void(const std::vector<const ParticleSet*>&)>;
    virtual void save(const WriteSets& write) = 0;
    virtual std::vector<SnapshotField> snapshot_fields() const = 0;
    virtual std::vector<CsvColumn> diagnostics_columns() const = 0;
    virtual Diagnostics diagnostics() const = 0;
    /// What else a summary of the run says, a line or nothing.
    virtual std::string summary() const = 0;
    /// What else performance.json holds: `"key": value, ` for each, or nothing.
    virtual std::string performance() const = 0;
    /// Analyses the last state as the scene asks, writes to `folder` and returns what to log, or nothing.
    virtual std::string analyse(const std::filesystem::path&, const RunState&) const { return {}; }
    /// The same for what another model goes on from.
    virtual std::string hand_over(const std::filesystem::path&, const RunState&) const { return {}; }
};

/// Reads a scene to run it until its own end or `until` [s]. Throws SceneError
/// (on every rank) with all faults. `comm` and `scene` must outlive the result. Collective.
std::unique_ptr<Evolution> read_evolution(const Communicator& comm, const Scene& scene,
                                          std::optional<double> until);

}  // namespace talus
