#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
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

/// Rows that a rank packs, sends and writes at a time, whole blocks, so that buffers stay small.
inline constexpr std::uint64_t rows_per_slab = 4 * rows_per_block;
/// Number of slabs in a share of rows.
inline std::uint64_t slabs_in(RowRange rows) { return (rows.count() + rows_per_slab - 1) / rows_per_slab; }
/// Slab `slab` of a share of rows; empty behind its end.
inline RowRange slab_of(RowRange rows, std::uint64_t slab) {
    const std::uint64_t begin = std::min(rows.begin + slab * rows_per_slab, rows.end);
    return {begin, std::min(begin + rows_per_slab, rows.end)};
}

/// Redistribution of particle data into order of id, equal shares by rows_of_rank, whatever the gaps
/// between the ids. Made once for a set, used for each of its columns.
class IdOrder {
  public:
    /// `ids` of this rank's particles. Throws AgreedError if an id occurs twice in `set_name`. Collective.
    IdOrder(const Communicator& comm, std::span<const std::uint64_t> ids, std::string_view set_name);

    std::uint64_t total() const { return total_; }  ///< particles on all ranks
    RowRange rows() const { return rows_; }         ///< this rank's share after redistribution
    /// Packs one row of `row_bytes` for each of the given own particles.
    using Pack = std::function<std::vector<std::byte>(std::span<const std::uint32_t>)>;
    /// This rank's rows of slab `slab` in order of id. Collective.
    std::vector<std::byte> exchange(std::uint64_t slab, std::size_t row_bytes, const Pack& pack) const;

  private:
    std::vector<std::uint64_t> ids_at(std::span<const std::uint64_t> sorted,
                                      std::span<const std::uint64_t> positions) const;
    void find_sources(std::span<const std::uint64_t> sorted, std::string_view set_name);
    void count_slabs();

    const Communicator& comm_;
    std::uint64_t total_ = 0;
    RowRange rows_;
    std::uint64_t slabs_ = 0;                        ///< most that any rank has
    std::vector<std::uint32_t> send_order_;          ///< own particles in order of id
    std::vector<int> send_starts_;                   ///< of each rank's share in send_order_
    std::vector<int> source_of_row_;                 ///< rank that each of this rank's rows comes from
    std::vector<int> send_counts_, receive_counts_;  ///< [rank][slab]
};

}  // namespace talus
