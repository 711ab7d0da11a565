#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "comm/communicator.hpp"

namespace talus {

/// Rows of a dataset that are hashed together. Ranks read and write whole blocks, so that a dataset's
/// checksum does not depend on how many they are.
inline constexpr std::uint64_t rows_per_block = 4096;

/// Rows [begin, end) of a dataset.
struct RowRange {
    std::uint64_t begin = 0, end = 0;
    std::size_t count() const { return static_cast<std::size_t>(end - begin); }
};

/// The share of rank `rank` of `size` in `total` rows: whole blocks, as even as those allow.
RowRange rows_of_rank(std::uint64_t total, int rank, int size);

/// Redistribution of particle data into order of id, equal shares by rows_of_rank, whatever the gaps
/// between the ids. Made once for a set, used for each of its columns.
class IdOrder {
  public:
    /// `ids` of this rank's particles. Throws AgreedError if an id occurs twice in `set_name`. Collective.
    IdOrder(const Communicator& comm, std::span<const std::uint64_t> ids, std::string_view set_name);

    std::uint64_t total() const { return total_; }  ///< particles on all ranks
    RowRange rows() const { return rows_; }         ///< this rank's share after redistribution
    /// The order in which `exchange` expects this rank's particles.
    std::span<const std::uint32_t> send_order() const { return send_order_; }
    /// Takes one row of `row_bytes` a particle, in send_order(), and returns this rank's rows() in order of
    /// id. Collective.
    std::vector<std::byte> exchange(std::span<const std::byte> packed, std::size_t row_bytes) const;

  private:
    std::vector<std::uint64_t> ids_at(std::span<const std::uint64_t> sorted,
                                      std::span<const std::uint64_t> positions) const;
    std::vector<std::byte> send(std::span<const std::byte> packed, std::size_t row_bytes) const;

    const Communicator& comm_;
    std::uint64_t total_ = 0;
    RowRange rows_;
    std::vector<std::uint32_t> send_order_;
    std::vector<int> send_counts_, send_starts_, receive_counts_, receive_starts_;
    std::vector<std::uint32_t> receive_order_;  ///< row k comes from received particle receive_order_[k]
};

}  // namespace talus
