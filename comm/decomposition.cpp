#include "comm/decomposition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace talus {

Decomposition::Decomposition(const Communicator& comm, PartitionMethod method)
    : comm_(comm), method_(method), exchange_(comm), halo_(comm) {}

Decomposition::Ledger Decomposition::count_own(const ParticleSet& particles) {
    Ledger ledger{{particles.size(), 0}};
    for (const std::uint64_t id : particles.own(field::id)) ledger.sums[1] += id;
    return ledger;
}

void Decomposition::expect(const ParticleSet& particles) {
    expected_ = count_own(particles);
    comm_.all_sum(std::span<std::uint64_t>(expected_.sums));
}

void Decomposition::expect_change(const Ledger& added, const Ledger& removed) {
    for (std::size_t k = 0; k < expected_.sums.size(); ++k)
        expected_.sums[k] += added.sums[k] - removed.sums[k];
}

void Decomposition::arrange(ParticleSet& particles, const CellGrid& grid) {
    migrate(particles, grid);
    sort(particles);
    list_own_cells();
    Ledger found = count_own(particles);
    Communicator::PendingSum counting = comm_.all_sum_later(found.sums);
    std::vector<CellEntry> entries = halo_.plan(grid, partition_, own_cells_, particles);
    entries.insert(entries.end(), own_cells_.begin(), own_cells_.end());
    table_.build(std::move(entries), particles.dimension(), grid.reach());
    counting.finish();
    check(found, particles);
}

void Decomposition::check(const Ledger& found, const ParticleSet& particles) const {
    if (found == expected_) return;
    std::string message = fmt::format("particle set '{}': {} particles expected, {} found", particles.name(),
                                      expected_.count(), found.count());
    if (found.count() + 1 == expected_.count())
        message += fmt::format("; lost: id {}", expected_.id_sum() - found.id_sum());
    else if (found.count() == expected_.count() + 1)
        message += fmt::format("; found twice: id {}", found.id_sum() - expected_.id_sum());
    else if (found.count() == expected_.count())
        message += ", but not the same ids";
    throw AgreedError(1, message);
}

namespace {

std::size_t state_bytes(const ParticleSet& particles) {
    std::size_t bytes = 0;
    for (const Column& column : particles.columns())
        if (column.info->role == Role::state) bytes += column.components.size() * column.value_size();
    return bytes;
}

Parcel pack(const ParticleSet& particles, int rank, std::span<const std::uint32_t> leaving,
            std::size_t bytes) {
    Parcel parcel{rank, std::vector<std::byte>(leaving.size() * bytes)};
    std::byte* to = parcel.bytes.data();
    for (const Column& column : particles.columns()) {
        if (column.info->role != Role::state) continue;
        const std::size_t size = column.value_size();
        for (const auto& component : column.components)
            for (const std::uint32_t i : leaving) {
                std::memcpy(to, component.data() + i * size, size);
                to += size;
            }
    }
    return parcel;
}

void unpack(ParticleSet& particles, std::size_t first, std::size_t count, const Parcel& parcel) {
    const std::byte* from = parcel.bytes.data();
    for (Column& column : particles.columns()) {
        if (column.info->role != Role::state) continue;
        const std::size_t bytes = count * column.value_size();
        for (auto& component : column.components) {
            std::memcpy(component.data() + first * column.value_size(), from, bytes);
            from += bytes;
        }
    }
}

}  // namespace

void Decomposition::migrate(ParticleSet& particles, const CellGrid& grid) {
    const int dimension = particles.dimension();
    const double* position[3] = {};
    for (int axis = 0; axis < dimension; ++axis) position[axis] = particles.data(field::position, axis);
    const std::uint64_t* id = particles.data(field::id);
    // Most particles kept their cell and thus their place. The former keys only say which to try: one stays
    // if it also follows the last that stayed, whatever happened to the set since.
    keys_.resize(particles.size());
    CellKey last_key = 0;
    std::uint64_t last_id = 0;
    stayed_.clear();
    moved_.clear();
    std::map<int, std::vector<std::uint32_t>> leaving;
    CellKey known_key = ~CellKey{0};
    int known_owner = comm_.rank();
    for (std::size_t i = 0; i < particles.size(); ++i) {
        Cell cell{};
        for (int axis = 0; axis < dimension; ++axis)
            cell[static_cast<std::size_t>(axis)] = grid.index_along(axis, position[axis][i]);
        const CellKey key = key_of(cell);
        if (key != known_key) {
            known_key = key;
            known_owner = partition_.owner_of(cell);
        }
        const auto index = static_cast<std::uint32_t>(i);
        if (known_owner != comm_.rank()) {
            leaving[known_owner].push_back(index);
        } else if (keys_[i] == key && (key > last_key || (key == last_key && id[i] >= last_id))) {
            stayed_.push_back(index);
            last_key = key;
            last_id = id[i];
        } else {
            moved_.push_back(index);
        }
        keys_[i] = key;
    }

    const std::size_t bytes = state_bytes(particles);
    std::vector<Parcel> outgoing;
    outgoing.reserve(leaving.size());
    for (const auto& [rank, indices] : leaving) outgoing.push_back(pack(particles, rank, indices, bytes));
    for (const Parcel& parcel : exchange_(std::move(outgoing))) {
        const std::size_t first = particles.size(), count = parcel.bytes.size() / bytes;
        particles.resize(first + count);
        unpack(particles, first, count, parcel);
        keys_.resize(first + count);
        for (std::size_t i = first; i < first + count; ++i) {
            Cell cell{};
            for (int axis = 0; axis < dimension; ++axis)
                cell[static_cast<std::size_t>(axis)] =
                    grid.index_along(axis, particles.data(field::position, axis)[i]);
            keys_[i] = key_of(cell);
            moved_.push_back(static_cast<std::uint32_t>(i));
        }
    }
}

void Decomposition::sort(ParticleSet& particles) {
    if (stayed_.size() == particles.size()) return;
    const std::uint64_t* id = particles.data(field::id);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        return keys_[a] != keys_[b] ? keys_[a] < keys_[b] : id[a] < id[b];
    };
    std::sort(moved_.begin(), moved_.end(), before);
    std::vector<std::uint32_t> order(stayed_.size() + moved_.size());
    std::merge(stayed_.begin(), stayed_.end(), moved_.begin(), moved_.end(), order.begin(), before);
    std::vector<CellKey> sorted_keys(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) sorted_keys[k] = keys_[order[k]];
    keys_ = std::move(sorted_keys);
    particles.reorder(order);
}

void Decomposition::list_own_cells() {
    own_cells_.clear();
    for (std::size_t i = 0; i < keys_.size(); ++i) {
        if (i == 0 || keys_[i] != keys_[i - 1])
            own_cells_.push_back(
                {keys_[i], static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i), false, false});
        own_cells_.back().end = static_cast<std::uint32_t>(i + 1);
    }
}

void Decomposition::divide(const ParticleSet& particles, const CellGrid& grid) {
    if (comm_.size() == 1) return;
    std::vector<std::uint64_t> keys(particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i) {
        Cell cell{};
        for (int axis = 0; axis < particles.dimension(); ++axis)
            cell[static_cast<std::size_t>(axis)] =
                grid.index_along(axis, particles.data(field::position, axis)[i]);
        keys[i] = block_key_of(cell, partition_.block_shift());
    }
    std::sort(keys.begin(), keys.end());
    BlockWork mine;
    for (std::size_t i = 0; i < keys.size();) {
        const auto end = std::upper_bound(keys.begin() + static_cast<std::ptrdiff_t>(i), keys.end(), keys[i]);
        const auto next = static_cast<std::size_t>(end - keys.begin());
        mine.emplace_hint(mine.end(), keys[i], static_cast<double>(next - i));
        i = next;
    }
    deal(mine, -1);
}

bool Decomposition::rebalance(std::span<const double> work) {
    if (comm_.size() == 1) return false;
    // A move costs a few steps: not worth it for less than 5 % of idle time or a gain below 3 %.
    constexpr double worth_moving = 1.05, least_gain = 0.03;
    double local = 0;
    for (const double w : work) local += w;
    double total = 0, most = 0;
    for (const double w : comm_.all_gather(std::span<const double>(&local, 1))) {
        total += w;
        most = std::max(most, w);
    }
    measured_imbalance_ = total > 0 ? most * comm_.size() / total : 1;
    if (measured_imbalance_ < worth_moving) return false;
    BlockWork mine;
    for (std::size_t c = 0; c < own_cells_.size(); ++c)
        mine[block_key_of(cell_of(own_cells_[c].key), partition_.block_shift())] += work[c];
    return deal(mine, least_gain);
}

bool Decomposition::deal(const BlockWork& mine, double least_gain) {
    std::vector<Block> my_blocks;
    for (const auto& [key, work] : mine) my_blocks.push_back({key, work});
    BlockWork merged;
    for (const Block& block : comm_.all_gather(std::span<const Block>(my_blocks)))
        merged[block.key] += block.work;
    std::vector<Block> blocks;
    std::vector<int> previous;
    for (const auto& [key, work] : merged) {
        blocks.push_back({key, work});
        previous.push_back(partition_.block_count() > 0 ? partition_.owner_of_block(key) : -1);
    }
    std::vector<int> owners = deal_blocks(method_, blocks, comm_.size(), previous);
    if (least_gain >= 0 && imbalance(blocks, owners, comm_.size()) > measured_imbalance_ - least_gain)
        return false;
    partition_ = Partition(partition_.block_shift(), blocks, std::move(owners));
    ++rebalance_count_;
    return true;
}

}  // namespace talus
