#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "comm/communicator.hpp"

/// Many small runs, shared out over the ranks.
namespace talus::test {

/// Results of `cases` small runs, each done by one rank alone.
template <class Run>
std::vector<double> on_shared_ranks(std::size_t cases, Run&& run) {
    const Communicator world(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    const auto ranks = static_cast<std::size_t>(world.size()), rank = static_cast<std::size_t>(world.rank());
    std::vector<double> mine;
    for (std::size_t k = rank; k < cases; k += ranks) mine.push_back(run(alone, k));
    mine.resize((cases + ranks - 1) / ranks);
    const std::vector<double> all = world.all_gather(std::span<const double>(mine));
    std::vector<double> results;
    for (std::size_t k = 0; k < cases; ++k) results.push_back(all[k % ranks * mine.size() + k / ranks]);
    return results;
}
inline bool is_root() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank == 0;
}

}  // namespace talus::test
