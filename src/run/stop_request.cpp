#include "src/run/stop_request.hpp"

#include <atomic>
#include <csignal>

namespace talus {

namespace {
std::atomic<int> signals_received{0};
static_assert(std::atomic<int>::is_always_lock_free);

enum Reason { none, signalled, stop_file, out_of_time };
}  // namespace

StopRequest::StopRequest(const Communicator& comm, const std::filesystem::path& folder, double walltime)
    : comm_(comm),
      stop_file_(folder / "stop"),
      walltime_(walltime),
      start_(std::chrono::steady_clock::now()) {
    signals_received = 0;
    std::signal(SIGUSR1, [](int) { signals_received.fetch_add(1); });
}

std::string StopRequest::reason(double step_seconds, double checkpoint_seconds) {
    int found = none;
    if (comm_.is_root()) {
        const double elapsed =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        std::error_code unreadable;
        if (std::filesystem::exists(stop_file_, unreadable)) found = stop_file;
        if (elapsed + 3 * step_seconds + 2 * checkpoint_seconds > walltime_) found = out_of_time;
    }
    if (signals_received.load() > 0) found = signalled;
    switch (comm_.all_max(found)) {
        case signalled:
            return "signal SIGUSR1";
        case stop_file:
            if (comm_.is_root()) {
                std::error_code ignored;
                std::filesystem::remove(stop_file_, ignored);  // it has been obeyed
            }
            return "file 'stop'";
        case out_of_time:
            return "the wall time is running out";
        default:
            return {};
    }
}

}  // namespace talus
