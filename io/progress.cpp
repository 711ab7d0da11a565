#include "io/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>

namespace talus {
namespace {

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Average that forgets within some prints.
void move_towards(double& average, double value) {
    average = average == 0 ? value : 0.7 * average + 0.3 * value;
}

}  // namespace

std::string hours_minutes_seconds(double seconds) {
    const auto whole = std::llround(std::min(seconds, 1e12));
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(bool is_root, Goal goal, double seconds_between, std::FILE* out)
    : is_root_(is_root),
      goal_(goal),
      out_(out),
      terminal_(::isatty(::fileno(out)) != 0),
      seconds_between_(terminal_ ? 0.25 : seconds_between),
      last_print_(Clock::now()) {}

void Progress::update(std::uint64_t step, double time, double time_step, std::uint64_t particles) {
    if (!is_root_) return;
    step_ = step;
    time_ = time;
    time_step_ = time_step;
    particles_ = particles;
    if (!begun_) {  // rates count from here
        begun_ = true;
        printed_step_ = step;
        printed_time_ = time;
        last_print_ = Clock::now();
        return;
    }
    pending_ = true;
    if (seconds_since(last_print_) >= seconds_between_) print();
}

void Progress::print() {
    const double elapsed = std::max(seconds_since(last_print_), 1e-9);
    move_towards(steps_per_second_, static_cast<double>(step_ - printed_step_) / elapsed);
    move_towards(time_per_second_, (time_ - printed_time_) / elapsed);
    std::string line =
        fmt::format("step {}  time {:.5g} s  dt {:.3g} s  {:.3g} particle-steps/s  {}", step_, time_,
                    time_step_, steps_per_second_ * static_cast<double>(particles_), remaining());
    if (terminal_) {
        const std::size_t width = line.size();
        if (width < width_) line.append(width_ - width, ' ');
        width_ = width;
        fmt::print(out_, "\r{}", line);
    } else {
        fmt::print(out_, "{}\n", line);
    }
    std::fflush(out_);
    last_print_ = Clock::now();
    printed_step_ = step_;
    printed_time_ = time_;
    pending_ = false;
}

std::string Progress::remaining() const {
    double seconds = std::numeric_limits<double>::infinity();
    if (goal_.end_time && time_per_second_ > 0)
        seconds = std::min(seconds, (*goal_.end_time - time_) / time_per_second_);
    if (goal_.last_step && steps_per_second_ > 0)
        seconds = std::min(seconds, (static_cast<double>(*goal_.last_step) - static_cast<double>(step_)) /
                                        steps_per_second_);
    return std::isfinite(seconds) ? fmt::format("{} left", hours_minutes_seconds(std::max(seconds, 0.0)))
                                  : "";
}

void Progress::finish() {
    if (!is_root_ || !begun_) return;
    if (pending_) print();
    if (terminal_) fmt::print(out_, "\n");
    begun_ = false;
}

std::size_t PhaseTimer::index_of(std::string_view name) {
    for (std::size_t k = 0; k < phases_.size(); ++k)
        if (phases_[k].name == name) return k;
    phases_.push_back({name});
    return phases_.size() - 1;
}

double PhaseTimer::seconds(std::string_view phase) const {
    for (const Phase& known : phases_)
        if (known.name == phase) return known.seconds;
    return 0;
}

std::vector<PhaseTimer::Row> PhaseTimer::rows(const Communicator& comm) const {
    std::string mine;
    for (const Phase& phase : phases_) mine += fmt::format("{}\n", phase.name);
    const std::vector<char> everyones = comm.all_gather(std::span<const char>(mine));
    std::istringstream lines(std::string(everyones.begin(), everyones.end()));
    std::vector<Row> rows;
    for (std::string name; std::getline(lines, name);)
        if (std::none_of(rows.begin(), rows.end(), [&](const Row& row) { return row.phase == name; }))
            rows.push_back({name, 0, 0, 0, 0});

    std::vector<double> times;
    std::vector<std::uint64_t> calls(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        times.push_back(seconds(rows[k].phase));
        for (const Phase& phase : phases_)
            if (phase.name == rows[k].phase) calls[k] = phase.calls;
    }
    const std::vector<double> all = comm.all_gather(std::span<const double>(times));
    comm.all_max(std::span(calls));
    for (std::size_t k = 0; k < rows.size(); ++k) {
        rows[k].least = rows[k].greatest = times[k];
        rows[k].calls = calls[k];
        for (std::size_t at = k; at < all.size(); at += rows.size()) {
            rows[k].least = std::min(rows[k].least, all[at]);
            rows[k].greatest = std::max(rows[k].greatest, all[at]);
            rows[k].average += all[at] / comm.size();
        }
    }
    return rows;
}

std::string PhaseTimer::report(const Communicator& comm, double total_seconds) const {
    std::string table = fmt::format("{:<20} {:>10} {:>10} {:>10} {:>8} {:>10} {:>9}\n", "phase", "min [s]",
                                    "avg [s]", "max [s]", "share", "max/avg", "calls");
    for (const Row& row : rows(comm))
        table += fmt::format("{:<20} {:>10.4f} {:>10.4f} {:>10.4f} {:>7.1f}% {:>10.3f} {:>9}\n", row.phase,
                             row.least, row.average, row.greatest,
                             total_seconds > 0 ? 100 * row.average / total_seconds : 0, row.imbalance(),
                             row.calls);
    const std::uint64_t memory = comm.all_max(peak_memory());
    return table + fmt::format("total {:.3f} s on {} ranks, peak memory {:.1f} MB on the largest rank\n",
                               total_seconds, comm.size(), static_cast<double>(memory) * 1e-6);
}

std::uint64_t peak_memory() {
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.starts_with("VmHWM:")) return std::stoull(line.substr(6)) * 1024;
    return 0;
}

}  // namespace talus
