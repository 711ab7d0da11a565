#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "comm/halo.hpp"
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "domain/partition.hpp"

namespace talus {

/// Spreads one particle set over the ranks: who owns what, who needs copies of what, and in which order
/// particles are stored. arrange() brings all of it up to date with the particles' positions.
class Decomposition {
  public:
    Decomposition(const Communicator& comm, PartitionMethod method);

    /// Collective. Moves every particle to its owner, stores own particles in (cell, id) order, plans the
    /// halo and lists the cells. Afterwards the copies' fields are not yet filled: refresh them through
    /// halo(). Throws AgreedError (exit code 1) naming the id if a particle got lost.
    void arrange(ParticleSet& particles, const CellGrid& grid);

    /// Collective. Cuts the blocks of a new grid, weighted by their numbers of particles. arrange() must
    /// follow.
    void divide(const ParticleSet& particles, const CellGrid& grid);

    /// Collective. Cuts the blocks anew, weighted by the work measured in each own cell since the last
    /// arrange(), in order (any unit), if that lowers the imbalance enough to pay. True if ownership changed;
    /// arrange() must follow.
    bool rebalance(std::span<const double> work);

    /// Takes over who owns which block from another set on cells of the same size. arrange() must follow.
    void follow(const Partition& partition) { partition_ = partition; }

    /// Collective. The number of particles over all ranks, which only expect_change() changes from now on:
    /// arrange() checks it.
    void expect(const ParticleSet& particles);
    std::uint64_t total_particles() const { return expected_.count(); }

    /// Number of particles over all ranks and sum of their ids modulo 2^64.
    struct Ledger {
        std::array<std::uint64_t, 2> sums{};
        std::uint64_t count() const { return sums[0]; }
        std::uint64_t id_sum() const { return sums[1]; }
        bool operator==(const Ledger&) const = default;
    };
    /// Particles came and went on purpose; the same on every rank.
    void expect_change(const Ledger& added, const Ledger& removed);

    const CellTable& table() const { return table_; }
    const Partition& partition() const { return partition_; }
    /// Own cells in the order of the table.
    std::span<const CellEntry> own_cells() const { return own_cells_; }
    Halo& halo() { return halo_; }
    const Halo& halo() const { return halo_; }
    /// Imbalance of work (largest over mean) at the last call of rebalance().
    double measured_imbalance() const { return measured_imbalance_; }
    int rebalance_count() const { return rebalance_count_; }

  private:
    using BlockWork = std::map<std::uint64_t, double>;
    bool deal(const BlockWork& mine, double least_gain);
    static Ledger count_own(const ParticleSet& particles);
    void check(const Ledger& found, const ParticleSet& particles) const;
    void migrate(ParticleSet& particles, const CellGrid& grid);
    void sort(ParticleSet& particles);
    void list_own_cells();

    const Communicator& comm_;
    PartitionMethod method_;
    SparseExchange exchange_;
    Partition partition_{1};
    Halo halo_;
    CellTable table_;
    std::vector<CellEntry> own_cells_;
    std::vector<CellKey> keys_;  ///< cell of each own particle at the last sort: a hint, see migrate()
    std::vector<std::uint32_t> stayed_;  ///< particles still in their cell, in order
    std::vector<std::uint32_t> moved_;   ///< particles that changed cell or arrived
    Ledger expected_;
    double measured_imbalance_ = 1;
    int rebalance_count_ = 0;
};

}  // namespace talus
