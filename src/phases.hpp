#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace talus {

/// Parts of a time step, for the table of where time went.
enum class Phase : unsigned char {
    decompose,
    halo,
    density,
    gradients,
    forces,
    gravity,
    pressure,
    material,
    motion,
    grains,    ///< in water: their steps
    exchange,  ///< between water and grains
    wait,
    output,
    count
};

inline constexpr std::array<std::string_view, static_cast<std::size_t>(Phase::count)> phase_names = {
    "decompose", "halo",   "density", "gradients", "forces",          "gravity", "pressure",
    "material",  "motion", "grains",  "exchange",  "wait for others", "output"};

/// Wall time spent in each phase on this rank.
class Phases {
  public:
    using Clock = std::chrono::steady_clock;

    /// Counts the time from now until the next call to another phase.
    void enter(Phase phase) {
        const auto now = Clock::now();
        if (running_)
            seconds_[static_cast<std::size_t>(current_)] +=
                std::chrono::duration<double>(now - since_).count();
        if (!running_ || phase != current_) ++entries_[static_cast<std::size_t>(phase)];
        current_ = phase;
        since_ = now;
        running_ = true;
    }
    void stop() {
        enter(current_);
        running_ = false;
    }
    const std::array<double, static_cast<std::size_t>(Phase::count)>& seconds() const { return seconds_; }

    const std::array<std::uint64_t, static_cast<std::size_t>(Phase::count)>& entries() const {
        return entries_;
    }

  private:
    std::array<std::uint64_t, static_cast<std::size_t>(Phase::count)> entries_{};
    std::array<double, static_cast<std::size_t>(Phase::count)> seconds_{};
    Phase current_ = Phase::motion;
    Clock::time_point since_{};
    bool running_ = false;
};

}  // namespace talus
