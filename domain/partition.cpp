#include "domain/partition.hpp"

#include <metis.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <stdexcept>

namespace talus {

namespace {
constexpr int block_bias = 1 << 20;

std::uint64_t spread(std::uint64_t bits) {  // every third bit
    bits &= 0x1fffff;
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    return (bits | bits << 2) & 0x1249249249249249;
}

std::uint64_t compact(std::uint64_t bits) {
    bits &= 0x1249249249249249;
    bits = (bits | bits >> 2) & 0x10c30c30c30c30c3;
    bits = (bits | bits >> 4) & 0x100f00f00f00f00f;
    bits = (bits | bits >> 8) & 0x1f0000ff0000ff;
    bits = (bits | bits >> 16) & 0x1f00000000ffff;
    return (bits | bits >> 32) & 0x1fffff;
}

std::uint64_t morton(const Cell& block) {
    return spread(static_cast<std::uint64_t>(std::int64_t{block[0]} + block_bias)) |
           spread(static_cast<std::uint64_t>(std::int64_t{block[1]} + block_bias)) << 1 |
           spread(static_cast<std::uint64_t>(std::int64_t{block[2]} + block_bias)) << 2;
}
}  // namespace

std::uint64_t block_key_of(const Cell& cell, int block_shift) {
    return morton({cell[0] >> block_shift, cell[1] >> block_shift, cell[2] >> block_shift});
}

Cell block_of(std::uint64_t block_key) {
    return {static_cast<int>(compact(block_key)) - block_bias,
            static_cast<int>(compact(block_key >> 1)) - block_bias,
            static_cast<int>(compact(block_key >> 2)) - block_bias};
}

Partition::Partition(int block_shift, std::span<const Block> blocks, std::vector<int> owners)
    : block_shift_(block_shift), owners_(std::move(owners)) {
    keys_.reserve(blocks.size());
    for (const Block& block : blocks) keys_.push_back(block.key);
}

std::size_t Partition::place_of(std::uint64_t block_key) const {
    const auto at = std::lower_bound(keys_.begin(), keys_.end(), block_key);
    return at == keys_.end() ? keys_.size() - 1 : static_cast<std::size_t>(at - keys_.begin());
}

int Partition::owner_of_block(std::uint64_t block_key) const {
    return keys_.empty() ? 0 : owners_[place_of(block_key)];
}

int Partition::sole_owner(std::uint64_t first_key, std::uint64_t last_key) const {
    if (keys_.empty()) return 0;
    const std::size_t first = place_of(first_key), last = place_of(last_key);
    for (std::size_t k = first; k < last; ++k)
        if (owners_[k + 1] != owners_[first]) return -1;
    return owners_[first];
}

namespace {

/// Halves the blocks along the longest axis at the point that splits the work as the ranks are split.
void bisect(std::span<const Block> blocks, std::span<std::size_t> members, int first_rank, int ranks,
            std::vector<int>& owners) {
    if (ranks == 1 || members.empty()) {
        for (const std::size_t k : members) owners[k] = first_rank;
        return;
    }
    Cell lowest = block_of(blocks[members[0]].key), highest = lowest;
    double total = 0;
    for (const std::size_t k : members) {
        const Cell at = block_of(blocks[k].key);
        for (std::size_t a = 0; a < 3; ++a) {
            lowest[a] = std::min(lowest[a], at[a]);
            highest[a] = std::max(highest[a], at[a]);
        }
        total += blocks[k].work;
    }
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
        if (highest[a] - lowest[a] > highest[axis] - lowest[axis]) axis = a;
    std::sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
        const int at_a = block_of(blocks[a].key)[axis], at_b = block_of(blocks[b].key)[axis];
        return at_a != at_b ? at_a < at_b : blocks[a].key < blocks[b].key;
    });
    const int left_ranks = ranks / 2;
    const double wanted = total * left_ranks / ranks;
    double left = 0;
    std::size_t cut = 0;
    while (cut < members.size() && left + blocks[members[cut]].work / 2 < wanted)
        left += blocks[members[cut++]].work;
    bisect(blocks, members.subspan(0, cut), first_rank, left_ranks, owners);
    bisect(blocks, members.subspan(cut), first_rank + left_ranks, ranks - left_ranks, owners);
}

std::vector<int> deal_slabs(std::span<const Block> blocks, int ranks) {
    std::vector<std::size_t> order(blocks.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const int at_a = block_of(blocks[a].key)[0], at_b = block_of(blocks[b].key)[0];
        return at_a != at_b ? at_a < at_b : blocks[a].key < blocks[b].key;
    });
    double total = 0, before = 0;
    for (const Block& block : blocks) total += block.work;
    std::vector<int> owners(blocks.size());
    for (const std::size_t k : order) {
        const double middle = total > 0 ? (before + blocks[k].work / 2) / total : 0;
        owners[k] = std::min(static_cast<int>(middle * ranks), ranks - 1);
        before += blocks[k].work;
    }
    return owners;
}

std::vector<int> deal_scrambled(std::span<const Block> blocks, int ranks) {
    std::vector<int> owners(blocks.size());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const std::uint64_t mixed = (blocks[k].key ^ blocks[k].key >> 17) * 0x9e3779b97f4a7c15u;
        owners[k] = static_cast<int>((mixed >> 33) % static_cast<std::uint64_t>(ranks));
    }
    return owners;
}

std::vector<int> deal_bisection(std::span<const Block> blocks, int ranks) {
    std::vector<int> owners(blocks.size());
    std::vector<std::size_t> members(blocks.size());
    std::iota(members.begin(), members.end(), std::size_t{0});
    bisect(blocks, members, 0, ranks, owners);
    return owners;
}

/// Calls visit(k, offset, neighbour) for each of the sorted blocks and each of its 26 neighbours among them,
/// in the order of k; finish(k) after the neighbours of k.
template <class Visit, class Finish>
void for_each_neighbour(std::span<const Block> blocks, Visit&& visit, Finish&& finish) {
    for (std::size_t k = 0; k < blocks.size(); ++k) {
        const Cell at = block_of(blocks[k].key);
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    if (dx == 0 && dy == 0 && dz == 0) continue;
                    const std::uint64_t key = morton({at[0] + dx, at[1] + dy, at[2] + dz});
                    const auto found = std::lower_bound(
                        blocks.begin(), blocks.end(), key,
                        [](const Block& block, std::uint64_t wanted) { return block.key < wanted; });
                    if (found == blocks.end() || found->key != key) continue;
                    visit(k, Cell{dx, dy, dz}, static_cast<std::size_t>(found - blocks.begin()));
                }
        finish(k);
    }
}

std::vector<int> deal_metis(std::span<const Block> blocks, int ranks) {
    // Vertices: blocks, weighted by work. Edges: the 26 neighbours, weighted by the surface they share.
    std::vector<idx_t> starts{0}, neighbours, edge_weights, vertex_weights;
    for_each_neighbour(
        blocks,
        [&](std::size_t, const Cell& offset, std::size_t neighbour) {
            const int order = std::abs(offset[0]) + std::abs(offset[1]) + std::abs(offset[2]);
            neighbours.push_back(static_cast<idx_t>(neighbour));
            edge_weights.push_back(order == 1 ? 100 : order == 2 ? 10 : 1);
        },
        [&](std::size_t) { starts.push_back(static_cast<idx_t>(neighbours.size())); });
    double total = 0;
    for (const Block& block : blocks) total += block.work;
    const double scale = 1e6 / std::max(total / static_cast<double>(blocks.size()), 1e-300);
    for (const Block& block : blocks) {
        const double weight = block.work * scale / (1 + static_cast<double>(blocks.size()) / 1000);
        vertex_weights.push_back(static_cast<idx_t>(std::clamp(weight, 1.0, 1e8)));
    }
    idx_t vertices = static_cast<idx_t>(blocks.size()), constraints = 1, parts = ranks, cut = 0;
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    options[METIS_OPTION_UFACTOR] = 20;
    std::vector<idx_t> part(blocks.size());
    const int status = METIS_PartGraphKway(&vertices, &constraints, starts.data(), neighbours.data(),
                                           vertex_weights.data(), nullptr, edge_weights.data(), &parts,
                                           nullptr, nullptr, options, &cut, part.data());
    if (status != METIS_OK) throw std::runtime_error("METIS could not divide the graph of cell blocks");
    return {part.begin(), part.end()};
}

/// Names the parts so that the most work stays where it was.
void relabel(std::span<const Block> blocks, std::span<const int> previous, int ranks,
             std::vector<int>& owners) {
    std::map<std::pair<int, int>, double> shared;  // (part, rank) -> work
    for (std::size_t k = 0; k < blocks.size(); ++k)
        if (previous[k] >= 0) shared[{owners[k], previous[k]}] += blocks[k].work;
    std::vector<std::pair<double, std::pair<int, int>>> overlaps;
    overlaps.reserve(shared.size());
    for (const auto& [names, work] : shared) overlaps.push_back({work, names});
    std::stable_sort(overlaps.begin(), overlaps.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<int> name(static_cast<std::size_t>(ranks), -1);
    std::vector<bool> taken(static_cast<std::size_t>(ranks), false);
    for (const auto& [work, names] : overlaps) {
        const auto part = static_cast<std::size_t>(names.first),
                   rank = static_cast<std::size_t>(names.second);
        if (name[part] >= 0 || taken[rank]) continue;
        name[part] = names.second;
        taken[rank] = true;
    }
    std::size_t free_rank = 0;
    for (int& chosen : name) {
        if (chosen >= 0) continue;
        while (taken[free_rank]) ++free_rank;
        chosen = static_cast<int>(free_rank);
        taken[free_rank] = true;
    }
    for (int& owner : owners) owner = name[static_cast<std::size_t>(owner)];
}

}  // namespace

std::vector<int> deal_blocks(PartitionMethod method, std::span<const Block> blocks, int ranks,
                             std::span<const int> previous) {
    if (ranks == 1 || blocks.empty()) return std::vector<int>(blocks.size(), 0);
    if (method == PartitionMethod::scrambled) return deal_scrambled(blocks, ranks);
    if (method == PartitionMethod::slabs) return deal_slabs(blocks, ranks);
    const bool few = blocks.size() <= 2 * static_cast<std::size_t>(ranks);
    std::vector<int> owners;
    if (method == PartitionMethod::metis && !few) {
        owners = deal_metis(blocks, ranks);
    } else {
        owners = deal_bisection(blocks, ranks);
        if (method == PartitionMethod::cheapest && !few) {
            std::vector<int> other = deal_metis(blocks, ranks);
            if (greatest_burden(blocks, other, ranks) < greatest_burden(blocks, owners, ranks))
                owners = std::move(other);
        }
    }
    if (!previous.empty()) relabel(blocks, previous, ranks, owners);
    return owners;
}

namespace {
std::vector<double> work_of_ranks(std::span<const Block> blocks, std::span<const int> owners, int ranks) {
    std::vector<double> work(static_cast<std::size_t>(ranks), 0.0);
    for (std::size_t k = 0; k < blocks.size(); ++k)
        work[static_cast<std::size_t>(owners[k])] += blocks[k].work;
    return work;
}

/// The eighths of a block within half a block's reach of its neighbour in a direction, as bits.
unsigned eighths_next_to(const Cell& offset) {
    unsigned bits = 0;
    for (unsigned eighth = 0; eighth < 8; ++eighth) {
        bool near = true;
        for (std::size_t a = 0; a < 3; ++a)
            if (offset[a] != 0 && (eighth >> a & 1) != (offset[a] > 0 ? 1u : 0u)) near = false;
        if (near) bits |= 1u << eighth;
    }
    return bits;
}
}  // namespace

double imbalance(std::span<const Block> blocks, std::span<const int> owners, int ranks) {
    const std::vector<double> work = work_of_ranks(blocks, owners, ranks);
    const double total = std::accumulate(work.begin(), work.end(), 0.0);
    return total > 0 ? *std::max_element(work.begin(), work.end()) * ranks / total : 1.0;
}

double greatest_burden(std::span<const Block> blocks, std::span<const int> owners, int ranks) {
    constexpr double cost_of_copy = 1.0 / 7;  // measured, docs/decisions/012
    std::vector<double> burden = work_of_ranks(blocks, owners, ranks);
    std::map<int, unsigned> copied;  // eighths of the block that other ranks need
    for_each_neighbour(
        blocks,
        [&](std::size_t k, const Cell& offset, std::size_t neighbour) {
            if (owners[neighbour] != owners[k]) copied[owners[neighbour]] |= eighths_next_to(offset);
        },
        [&](std::size_t k) {
            for (const auto& [rank, eighths] : copied)
                burden[static_cast<std::size_t>(rank)] +=
                    cost_of_copy * blocks[k].work * std::popcount(eighths) / 8;
            copied.clear();
        });
    return *std::max_element(burden.begin(), burden.end());
}

}  // namespace talus
