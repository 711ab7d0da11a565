#pragma once
#include <chrono>
#include <filesystem>
#include <string>

#include "comm/communicator.hpp"

namespace talus {

/// Asks a run to write a checkpoint and stop: SIGUSR1 to any rank, a file `stop` in the output folder, or the
/// wall time of the job running out.
class StopRequest {
  public:
    /// Installs the signal handler. `walltime` [s] is counted from now.
    StopRequest(const Communicator& comm, const std::filesystem::path& folder, double walltime);

    /// Why to stop, the same on every rank; empty: go on. The wall time is said to run out while there is
    /// still room for three times `step_seconds`, the longest wall time between two calls, and twice
    /// `checkpoint_seconds`, that of writing a checkpoint. The root's values count. Collective.
    std::string reason(double step_seconds, double checkpoint_seconds);

  private:
    const Communicator& comm_;
    std::filesystem::path stop_file_;
    double walltime_;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace talus
