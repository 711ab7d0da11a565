#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "domain/cell_grid.hpp"

namespace talus {

/// How blocks of cells are dealt to ranks. `metis` and `bisection` balance work, `cheapest` is the one of
/// them with the smaller greatest_burden(); `slabs` (by x) and `scrambled` (pseudo-random, the worst possible
/// surface) exist to show that results do not depend on it.
enum class PartitionMethod : std::uint8_t { cheapest, metis, bisection, slabs, scrambled };

/// A cube of cells, the unit that a rank owns, and the work measured in it.
struct Block {
    std::uint64_t key;  ///< Morton key, see block_key_of
    double work;        ///< any unit; the same for all blocks
};

/// Morton key of the block of 2^block_shift cells a side that holds the cell.
std::uint64_t block_key_of(const Cell& cell, int block_shift);
/// Block coordinates of a key (block units).
Cell block_of(std::uint64_t block_key);

/// Which rank owns which cell. The same on every rank.
class Partition {
  public:
    Partition() = default;
    /// Everything belongs to rank 0.
    explicit Partition(int block_shift) : block_shift_(block_shift) {}
    /// `blocks` sorted by key without repeats; owners[k] is the rank of blocks[k].
    Partition(int block_shift, std::span<const Block> blocks, std::vector<int> owners);

    int block_shift() const { return block_shift_; }
    std::size_t block_count() const { return keys_.size(); }

    /// Owner of a block. A block that held no particles when the partition was made belongs to the owner
    /// of the next known block in Morton order, which is near it.
    int owner_of_block(std::uint64_t block_key) const;
    /// Owner of all blocks from one key to another, inclusive; -1 if there are several.
    int sole_owner(std::uint64_t first_key, std::uint64_t last_key) const;
    int owner_of(const Cell& cell) const { return owner_of_block(block_key_of(cell, block_shift_)); }

  private:
    std::size_t place_of(std::uint64_t block_key) const;

    int block_shift_ = 2;
    std::vector<std::uint64_t> keys_;
    std::vector<int> owners_;
};

/// Deals sorted blocks to `ranks` ranks so that work is balanced and the surface small. Deterministic: every
/// rank computes the same owners from the same blocks. `previous`, if not empty, holds each block's owner so
/// far (-1: none); parts are named so that little moves.
std::vector<int> deal_blocks(PartitionMethod method, std::span<const Block> blocks, int ranks,
                             std::span<const int> previous);

/// Largest work of a rank over the mean.
double imbalance(std::span<const Block> blocks, std::span<const int> owners, int ranks);

/// Work of the busiest rank, the copies that it needs of others' particles included, in the unit of work:
/// each costs a seventh of the work on the particle itself, and blocks are taken to be two cells a side and
/// evenly filled.
double greatest_burden(std::span<const Block> blocks, std::span<const int> owners, int ranks);

}  // namespace talus
