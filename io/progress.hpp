#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "comm/communicator.hpp"

namespace talus {

using Clock = std::chrono::steady_clock;

/// One line on how far a run is, on the root only: rewritten in place on a terminal, else a new one now and
/// then.
class Progress {
  public:
    /// What the run aims at; whichever comes first.
    struct Goal {
        std::optional<double> end_time;          ///< [s]
        std::optional<std::uint64_t> last_step;  ///< steps
    };
    /// `seconds_between` lines [s]; a quarter of a second on a terminal.
    Progress(bool is_root, Goal goal, double seconds_between = 10, std::FILE* out = stderr);
    ~Progress() { finish(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Call after every step; `particles` on all ranks. Prints only when it is time to.
    void update(std::uint64_t step, double time, double time_step, std::uint64_t particles);
    /// Prints the last state and ends the line.
    void finish();

  private:
    void print();
    std::string remaining() const;

    bool is_root_;
    Goal goal_;
    std::FILE* out_;
    bool terminal_;
    double seconds_between_;
    Clock::time_point last_print_;
    bool begun_ = false, pending_ = false;
    std::uint64_t step_ = 0, printed_step_ = 0, particles_ = 0;
    double time_ = 0, printed_time_ = 0, time_step_ = 0;
    std::size_t width_ = 0;
    double steps_per_second_ = 0, time_per_second_ = 0;  ///< moving averages
};

/// "1:02:03", of seconds.
std::string hours_minutes_seconds(double seconds);

/// Adds up the time that phases of a run take. Cheap enough for phases of microseconds.
class PhaseTimer {
  public:
    /// Measures from its making to its end.
    class Scope {
      public:
        Scope(PhaseTimer& timer, std::size_t phase) : timer_(timer), phase_(phase), start_(Clock::now()) {}
        ~Scope() { timer_.add(phase_, std::chrono::duration<double>(Clock::now() - start_).count()); }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

      private:
        PhaseTimer& timer_;
        std::size_t phase_;
        Clock::time_point start_;
    };

    /// `const auto timing = timer.start("density");` Names are literals, compared by content. Phases within
    /// phases count twice.
    [[nodiscard]] Scope start(std::string_view phase) { return Scope(*this, index_of(phase)); }
    /// Counts time measured elsewhere.
    void add(std::string_view phase, double seconds, std::uint64_t calls) {
        phases_[index_of(phase)].seconds += seconds;
        phases_[index_of(phase)].calls += calls;
    }
    /// Seconds of this rank, 0 for an unknown phase.
    double seconds(std::string_view phase) const;
    void reset() { phases_.clear(); }

    struct Row {
        std::string phase;
        double least, average, greatest;  ///< over ranks [s]
        std::uint64_t calls;              ///< greatest over ranks
        /// Greatest over average: 1 is even.
        double imbalance() const { return average > 0 ? greatest / average : 1; }
    };
    /// All phases any rank knows, those of the root first; the same on every rank. Collective.
    std::vector<Row> rows(const Communicator& comm) const;
    /// rows() as a table with shares of `total_seconds`, and the peak memory of the largest rank. Collective.
    std::string report(const Communicator& comm, double total_seconds) const;

  private:
    struct Phase {
        std::string_view name;
        double seconds = 0;
        std::uint64_t calls = 0;
    };
    std::size_t index_of(std::string_view name);
    void add(std::size_t phase, double seconds) {
        phases_[phase].seconds += seconds;
        ++phases_[phase].calls;
    }
    std::vector<Phase> phases_;
};

/// Most memory this process ever held [bytes]; 0 if the system does not tell.
std::uint64_t peak_memory();

}  // namespace talus
