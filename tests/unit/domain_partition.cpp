#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "domain/partition.hpp"
#include "domain/random.hpp"

namespace talus {
namespace {

constexpr RandomStream draws{.seed = 41};
constexpr PartitionMethod methods[] = {PartitionMethod::cheapest, PartitionMethod::metis,
                                       PartitionMethod::bisection, PartitionMethod::slabs,
                                       PartitionMethod::scrambled};

std::vector<Block> sorted(std::vector<Block> blocks) {
    std::sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.key < b.key; });
    return blocks;
}

/// n^3 blocks around the origin, with work between `least` and 1.
std::vector<Block> cube(int n, double least) {
    std::vector<Block> blocks;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) {
                const std::uint64_t key = block_key_of({x - n / 2, y - n / 2, z - n / 2}, 0);
                blocks.push_back({key, least + (1 - least) * draws.uniform(key, 0)});
            }
    return sorted(std::move(blocks));
}

void expect_all_owned(std::span<const Block> blocks, std::span<const int> owners, int ranks) {
    ASSERT_EQ(owners.size(), blocks.size());
    for (const int owner : owners) {
        ASSERT_GE(owner, 0);
        ASSERT_LT(owner, ranks);
    }
}

TEST(BlockKey, RoundTrip) {
    for (const int x : {-cell_limit, -9, -1, 0, 3, 4, cell_limit})
        for (const int y : {-5, 0, 1023})
            for (const int z : {-cell_limit, 0, 17}) {
                EXPECT_EQ(block_of(block_key_of({x, y, z}, 0)), (Cell{x, y, z}));
                EXPECT_EQ(block_of(block_key_of({x, y, z}, 2)),
                          (Cell{static_cast<int>(std::floor(x / 4.0)), static_cast<int>(std::floor(y / 4.0)),
                                static_cast<int>(std::floor(z / 4.0))}));
            }
}

TEST(Partition, OwnersOfKnownAndUnknownBlocks) {
    EXPECT_EQ(Partition(2).owner_of({5, 6, 7}), 0);
    const std::vector<Block> blocks = cube(4, 1);
    std::vector<int> owners;
    for (std::size_t k = 0; k < blocks.size(); ++k) owners.push_back(static_cast<int>(k % 5));
    const Partition partition(0, blocks, owners);
    EXPECT_EQ(partition.block_count(), 64u);
    for (std::size_t k = 0; k < blocks.size(); ++k)
        EXPECT_EQ(partition.owner_of_block(blocks[k].key), owners[k]);
    for (const Cell far : {Cell{100, 0, 0}, Cell{-100, 3, 2}, Cell{cell_limit, cell_limit, cell_limit},
                           Cell{-cell_limit, -cell_limit, -cell_limit}}) {
        EXPECT_GE(partition.owner_of(far), 0);
        EXPECT_LT(partition.owner_of(far), 5);
    }
}

TEST(DealBlocks, EveryBlockHasAnOwnerAndEveryRankWork) {
    const std::vector<Block> blocks = cube(20, 0.1);
    for (const PartitionMethod method : methods)
        for (const int ranks : {1, 2, 3, 5, 8}) {
            const auto owners = deal_blocks(method, blocks, ranks, {});
            expect_all_owned(blocks, owners, ranks);
            EXPECT_EQ(std::set<int>(owners.begin(), owners.end()).size(), static_cast<std::size_t>(ranks));
        }
}

TEST(DealBlocks, BalancesWork) {
    const std::vector<Block> blocks = cube(20, 0.1);
    for (const int ranks : {2, 3, 5, 8, 27}) {
        EXPECT_LE(imbalance(blocks, deal_blocks(PartitionMethod::metis, blocks, ranks, {}), ranks), 1.03)
            << ranks << " ranks";
        EXPECT_LE(imbalance(blocks, deal_blocks(PartitionMethod::bisection, blocks, ranks, {}), ranks), 1.03)
            << ranks << " ranks";
    }
    EXPECT_LE(imbalance(blocks, deal_blocks(PartitionMethod::slabs, blocks, 5, {}), 5), 1.1);
}

TEST(DealBlocks, BalancesWorkThatVariesAThousandfold) {
    std::vector<Block> blocks = cube(20, 1);
    for (Block& block : blocks) block.work = 1e-12 * std::exp2(10 * draws.uniform(block.key, 1));
    for (const int ranks : {2, 5, 8}) {
        EXPECT_LE(imbalance(blocks, deal_blocks(PartitionMethod::metis, blocks, ranks, {}), ranks), 1.05);
        EXPECT_LE(imbalance(blocks, deal_blocks(PartitionMethod::bisection, blocks, ranks, {}), ranks), 1.05);
    }
}

TEST(DealBlocks, BurdenCountsTheCopiesOfEachRank) {
    // A row of blocks along x with a corner neighbour at its end. Work 8 each; an eighth of a seventh of it
    // is 1/7 for each eighth of a block that is copied.
    const std::vector<Block> blocks = sorted({{block_key_of({0, 0, 0}, 0), 8.0},
                                              {block_key_of({1, 0, 0}, 0), 8.0},
                                              {block_key_of({2, 1, 1}, 0), 8.0}});
    const auto owned = [&](int first, int second, int third) {
        std::vector<int> owners;
        for (const Block& block : blocks) {
            const int x = block_of(block.key)[0];
            owners.push_back(x == 0 ? first : x == 1 ? second : third);
        }
        return owners;
    };
    EXPECT_DOUBLE_EQ(greatest_burden(blocks, owned(0, 0, 0), 2), 24);
    EXPECT_DOUBLE_EQ(greatest_burden(blocks, owned(0, 0, 1), 2), 16 + 1 / 7.0);  // a corner
    EXPECT_DOUBLE_EQ(greatest_burden(blocks, owned(0, 1, 1), 2), 16 + 4 / 7.0);  // a face
    EXPECT_DOUBLE_EQ(greatest_burden(blocks, owned(0, 1, 0), 2), 16 + 5 / 7.0);  // both, of one block
    EXPECT_DOUBLE_EQ(greatest_burden(blocks, owned(0, 1, 2), 3), 8 + 5 / 7.0);
}

TEST(DealBlocks, CheapestIsTheCheaperOfTwo) {
    std::vector<Block> ring;  // bisection is cheaper in the cube, METIS in a ring
    for (const Block& block : cube(24, 1)) {
        const Cell at = block_of(block.key);
        if (std::abs(std::hypot(at[0], at[1]) - 9) < 2 && std::abs(at[2]) < 2) ring.push_back(block);
    }
    std::set<PartitionMethod> chosen;
    for (const auto& blocks : {cube(18, 0.5), ring})
        for (const int ranks : {2, 3, 5, 8}) {
            const auto burden = [&](PartitionMethod method) {
                return greatest_burden(blocks, deal_blocks(method, blocks, ranks, {}), ranks);
            };
            const double metis = burden(PartitionMethod::metis),
                         bisection = burden(PartitionMethod::bisection);
            EXPECT_EQ(burden(PartitionMethod::cheapest), std::min(metis, bisection));
            chosen.insert(metis < bisection ? PartitionMethod::metis : PartitionMethod::bisection);
        }
    EXPECT_EQ(chosen.size(), 2u);
}

TEST(DealBlocks, WorkOfNothing) {
    std::vector<Block> blocks = cube(6, 1);
    for (Block& block : blocks) block.work = 0;
    for (const PartitionMethod method : methods)
        for (const int ranks : {2, 5})
            expect_all_owned(blocks, deal_blocks(method, blocks, ranks, {}), ranks);
    const std::vector<int> owners(blocks.size(), 0);
    EXPECT_EQ(imbalance(blocks, owners, 3), 1);
}

TEST(DealBlocks, FewBlocks) {
    for (const PartitionMethod method : methods)
        for (const int ranks : {1, 2, 5, 64}) {
            EXPECT_TRUE(deal_blocks(method, {}, ranks, {}).empty());
            const std::vector<Block> one{{block_key_of({3, -2, 1}, 0), 2.0}};
            expect_all_owned(one, deal_blocks(method, one, ranks, {}), ranks);
            const std::vector<int> unknown{-1};
            expect_all_owned(one, deal_blocks(method, one, ranks, unknown), ranks);
            std::vector<Block> three;
            for (const int x : {-1, 0, 5000}) three.push_back({block_key_of({x, 0, 0}, 0), 1.0});
            three = sorted(std::move(three));
            const auto owners = deal_blocks(method, three, ranks, {});
            expect_all_owned(three, owners, ranks);
            if (method == PartitionMethod::bisection && ranks >= 5) {
                EXPECT_EQ(std::set<int>(owners.begin(), owners.end()).size(), 3u) << ranks;
            }
        }
}

TEST(DealBlocks, IsDeterministic) {
    const std::vector<Block> blocks = cube(12, 0.2);
    for (const PartitionMethod method : methods)
        EXPECT_EQ(deal_blocks(method, blocks, 7, {}), deal_blocks(method, blocks, 7, {}));
}

TEST(DealBlocks, MostWorkStaysWhereItWas) {
    std::vector<Block> blocks = cube(20, 0.5);
    for (const PartitionMethod method :
         {PartitionMethod::cheapest, PartitionMethod::metis, PartitionMethod::bisection})
        for (const int ranks : {2, 3, 5, 8}) {
            const auto before = deal_blocks(method, blocks, ranks, {});
            // Work moves a little; and the former owners have other names than the parts.
            std::vector<Block> later = blocks;
            for (Block& block : later) block.work *= 1 + 0.05 * draws.uniform(block.key, 3);
            std::vector<int> previous;
            for (const int owner : before) previous.push_back(ranks - 1 - owner);
            const auto after = deal_blocks(method, later, ranks, previous);
            expect_all_owned(later, after, ranks);
            double stayed = 0, total = 0;
            for (std::size_t k = 0; k < later.size(); ++k) {
                total += later[k].work;
                if (after[k] == previous[k]) stayed += later[k].work;
            }
            EXPECT_GT(stayed / total, 0.5)
                << "method " << static_cast<int>(method) << ", " << ranks << " ranks";
        }
}

TEST(DealBlocks, SameWorkMovesNothing) {
    const std::vector<Block> blocks = cube(16, 0.5);
    for (const PartitionMethod method : methods) {
        const auto before = deal_blocks(method, blocks, 5, {});
        EXPECT_EQ(deal_blocks(method, blocks, 5, before), before);
    }
}

/// The number of ranks that a rank talks to is that of a compact body's neighbours, however many there are.
TEST(DealBlocks, NeighboursOfAPartDoNotGrowWithTheRanks) {
    const std::vector<Block> blocks = cube(24, 1);
    for (const PartitionMethod method :
         {PartitionMethod::cheapest, PartitionMethod::metis, PartitionMethod::bisection})
        for (const int ranks : {8, 27, 64, 216}) {
            const auto owners = deal_blocks(method, blocks, ranks, {});
            std::map<std::uint64_t, int> owner_of;
            for (std::size_t k = 0; k < blocks.size(); ++k) owner_of[blocks[k].key] = owners[k];
            std::vector<std::set<int>> neighbours(static_cast<std::size_t>(ranks));
            for (const auto& [key, owner] : owner_of) {
                const Cell at = block_of(key);
                for (int n = 0; n < 27; ++n) {
                    const auto other = owner_of.find(
                        block_key_of({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1}, 0));
                    if (other != owner_of.end() && other->second != owner)
                        neighbours[static_cast<std::size_t>(owner)].insert(other->second);
                }
            }
            std::size_t most = 0, sum = 0;
            for (const auto& set : neighbours) {
                most = std::max(most, set.size());
                sum += set.size();
            }
            EXPECT_LE(most, 30u) << "method " << static_cast<int>(method) << ", " << ranks << " ranks";
            EXPECT_LE(static_cast<double>(sum) / ranks, 20)
                << "method " << static_cast<int>(method) << ", " << ranks;
        }
}

}  // namespace
}  // namespace talus
