#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"
#include "io/run_state.hpp"

namespace talus {

/// XXH64 of some bytes.
std::uint64_t hash64(std::span<const std::byte> bytes, std::uint64_t seed = 0);
std::uint64_t hash64(std::string_view text, std::uint64_t seed = 0);

/// XXH64 of values that come one by one, such as those of a header; not for bulk data, which it keeps.
class Hasher64 {
  public:
    explicit Hasher64(std::uint64_t seed = 0) : seed_(seed) {}
    void add(std::span<const std::byte> bytes);
    void add(std::string_view text);  ///< length and characters
    void add(std::uint64_t value);
    void add(double value);  ///< its bits
    std::uint64_t value() const;

  private:
    std::uint64_t seed_;
    std::string bytes_;
};

/// What a set's state is made of, in the words of the hash: the columns with role `state`, by name.
struct StateColumn {
    std::string name;
    std::size_t value_size;
    std::size_t components;
    std::size_t bytes() const { return value_size * components; }
    auto operator<=>(const StateColumn&) const = default;
};

/// Hash of a complete state that does not depend on the order in which particles are added: each particle
/// is hashed to 128 bits with all its columns, id included, and the hashes are summed.
class StateHash {
  public:
    /// Begins a set; `columns` must be sorted by name.
    void begin_set(std::string_view name, int dimension, const std::vector<StateColumn>& columns);
    /// Adds one particle of the last set begun: its columns in the order given to begin_set, components in
    /// order.
    void add_particle(std::span<const std::byte> row);
    /// Counts and sums over ranks; sets must have been begun in the same order. Collective.
    void sum_over_ranks(const Communicator& comm);
    /// 32 hexadecimal digits for particles, time, time step, step and numbers.
    std::string finish(const RunState& state) const;

  private:
    struct SetHash {
        std::string description;
        std::uint64_t count = 0, low = 0, high = 0;
    };
    std::vector<SetHash> sets_;
};

/// Hash of the complete state, the same on any number of ranks and for any decomposition. Two states are
/// equal if and only if their hashes are (but for a chance of 2^-128). Differing signs of zero are different
/// states. Collective.
std::string state_hash(const Communicator& comm, const RunState& state,
                       const std::vector<const ParticleSet*>& sets);

/// The state columns of a set, sorted by name.
std::vector<const Column*> state_columns(const ParticleSet& set);

}  // namespace talus
