#pragma once
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "io/scene.hpp"
#include "src/run/evolution.hpp"

namespace talus {

/// Everything a run writes: checkpoints, snapshots, diagnostics, the log with progress, and the table of
/// where time went. Whatever cannot be written ends the run with AgreedError (exit code 3). All methods are
/// collective.
class Recorder {
  public:
    /// Makes the folder. A new run that finds another run's results there moves them to `folder`.1, .2, ...
    Recorder(const Communicator& comm, std::filesystem::path folder, const Scene& scene,
             const OutputPlan& output, bool is_new);
    ~Recorder();

    const std::filesystem::path& folder() const { return folder_; }

    /// Notes that the run is not new: it goes on from the state of a checkpoint.
    void go_on_from(const ReadCheckpoint& restart);
    /// Before the first step: describes the run, and for a new one writes its first state.
    void begin(Evolution& evolution, double end_time);
    void after_step(Evolution& evolution);
    /// Writes a checkpoint because of `why`.
    void stop_early(Evolution& evolution, const std::string& why);
    /// Writes the last state and what the scene wants to know of it; prints the table of time per phase.
    void finish(Evolution& evolution);

    /// Writes what other models go on from, if the scene asks for it and the time has come.
    void hand_over(const Evolution& evolution);

    /// After a failure of step(): keeps the state that failed in `folder`/failed for a look with `talus
    /// info`, and says where it is and where to go on from.
    std::string after_failure(Evolution& evolution);
    /// Longest wall time of a step so far [s].
    double longest_step() const { return longest_step_; }
    /// Wall time of writing the last checkpoint, or of reading the one that the run goes on from [s].
    double checkpoint_seconds() const { return checkpoint_seconds_; }

  private:
    struct Files;

    void tell_news(Evolution& evolution);
    void write_checkpoint_now(Evolution& evolution);
    void write_snapshot_now(Evolution& evolution, std::uint64_t index);
    void write_analysis(const Evolution& evolution);
    void write_diagnostics(Evolution& evolution);
    void print_summary(Evolution& evolution, const std::string& more);
    void write_performance(const Evolution& evolution, const class PhaseTimer& timer, double seconds,
                           std::uint64_t pairs);

    const Communicator& comm_;
    std::filesystem::path folder_;
    const Scene& scene_;
    const OutputPlan& output_;
    bool is_new_;
    std::unique_ptr<Files> files_;
    std::filesystem::path last_checkpoint_;
    std::chrono::steady_clock::time_point last_checkpoint_time_, step_began_, began_;
    double time_before_ = 0, longest_step_ = 0, checkpoint_seconds_ = 0, first_energy_ = 0;
    std::uint64_t first_step_ = 0, last_snapshot_step_ = ~std::uint64_t{0};
};

}  // namespace talus
