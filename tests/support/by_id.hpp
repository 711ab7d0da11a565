#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"

namespace talus::test {

/// Columns of values from all ranks, in the order of ids, on every rank.
class ById {
  public:
    ById(const Communicator& comm, const ParticleSet& particles)
        : comm_(comm), ids_(comm.all_gather(particles.own(field::id))), order_(ids_.size()) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::sort(order_.begin(), order_.end(), [this](auto a, auto b) { return ids_[a] < ids_[b]; });
    }
    std::vector<double> operator()(std::span<const double> mine) const {
        const auto all = comm_.all_gather(mine);
        std::vector<double> sorted(all.size());
        for (std::size_t k = 0; k < all.size(); ++k) sorted[k] = all[order_[k]];
        return sorted;
    }

  private:
    const Communicator& comm_;
    std::vector<std::uint64_t> ids_;
    std::vector<std::size_t> order_;
};

}  // namespace talus::test
