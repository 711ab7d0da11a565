#include "io/hashing.hpp"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace talus {

std::uint64_t hash64(std::span<const std::byte> bytes, std::uint64_t seed) {
    return XXH64(bytes.data(), bytes.size(), seed);
}
std::uint64_t hash64(std::string_view text, std::uint64_t seed) {
    return XXH64(text.data(), text.size(), seed);
}

void Hasher64::add(std::span<const std::byte> bytes) {
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}
void Hasher64::add(std::uint64_t value) { add(std::as_bytes(std::span(&value, 1))); }
void Hasher64::add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
void Hasher64::add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    bytes_.append(text);
}
std::uint64_t Hasher64::value() const { return hash64(bytes_, seed_); }

void StateHash::begin_set(std::string_view name, int dimension, const std::vector<StateColumn>& columns) {
    SetHash set;
    set.description = fmt::format("set {} of dimension {}:", name, dimension);
    for (const StateColumn& column : columns)
        set.description += fmt::format(" {} {}x{}", column.name, column.components, column.value_size);
    sets_.push_back(std::move(set));
}

void StateHash::add_particle(std::span<const std::byte> row) {
    const XXH128_hash_t hash = XXH3_128bits(row.data(), row.size());
    SetHash& set = sets_.back();
    // A sum rather than an exclusive or: two copies of a particle must not cancel. Two sums of 64 bits.
    set.count += 1;
    set.low += hash.low64;
    set.high += hash.high64;
}

void StateHash::sum_over_ranks(const Communicator& comm) {
    std::vector<std::uint64_t> sums;
    for (const SetHash& set : sets_) sums.insert(sums.end(), {set.count, set.low, set.high});
    comm.all_sum(std::span(sums));
    for (std::size_t k = 0; k < sets_.size(); ++k) {
        sets_[k].count = sums[3 * k];
        sets_[k].low = sums[3 * k + 1];
        sets_[k].high = sums[3 * k + 2];
    }
}

std::string StateHash::finish(const RunState& state) const {
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    std::vector<std::string> lines;
    for (const SetHash& set : sets_)
        lines.push_back(fmt::format("{} {} {:x} {:x}\n", set.description, set.count, set.low, set.high));
    std::sort(lines.begin(), lines.end());
    for (const auto& [name, value] : state.numbers)
        lines.push_back(fmt::format("{} {:x}\n", name, bits(value)));
    lines.push_back(fmt::format("{:x} {:x} {}\n", bits(state.time), bits(state.time_step), state.step));
    std::string all;
    for (const std::string& line : lines) all += line;
    const XXH128_hash_t hash = XXH3_128bits(all.data(), all.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::vector<const Column*> state_columns(const ParticleSet& set) {
    std::vector<const Column*> columns;
    for (const Column& column : set.columns())
        if (column.info->role == Role::state) columns.push_back(&column);
    std::sort(columns.begin(), columns.end(),
              [](const Column* a, const Column* b) { return a->info->name < b->info->name; });
    return columns;
}

std::string state_hash(const Communicator& comm, const RunState& state,
                       const std::vector<const ParticleSet*>& sets) {
    StateHash hash;
    for (const ParticleSet* set : sets) {
        struct Piece {
            const std::byte* values;
            std::size_t size;
        };
        std::vector<Piece> pieces;
        std::vector<StateColumn> description;
        std::size_t row_bytes = 0;
        for (const Column* column : state_columns(*set)) {
            const std::size_t size = column->value_size();
            description.push_back({std::string(column->info->name), size, column->components.size()});
            for (const auto& component : column->components) pieces.push_back({component.data(), size});
            row_bytes += description.back().bytes();
        }
        hash.begin_set(set->name(), set->dimension(), description);
        std::vector<std::byte> row(row_bytes);
        for (std::size_t k = 0; k < set->size(); ++k) {
            std::byte* to = row.data();
            for (const Piece& piece : pieces) {
                std::memcpy(to, piece.values + k * piece.size, piece.size);
                to += piece.size;
            }
            hash.add_particle(row);
        }
    }
    hash.sum_over_ranks(comm);
    return hash.finish(state);
}

}  // namespace talus
