#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/particles.hpp"

namespace talus::test {

/// The state of a set from all ranks, ordered by id, on every rank.
struct GatheredState {
    std::vector<std::uint64_t> ids;
    std::vector<std::vector<std::byte>> rows;  ///< all state columns of a particle, in order of the columns
    bool operator==(const GatheredState&) const = default;
};
GatheredState gather_state(const Communicator& comm, const ParticleSet& particles);

/// Hash of every bit of gather_state(); the same on every rank. FNV-1a, 64 bits.
std::uint64_t state_hash(const Communicator& comm, const ParticleSet& particles);

/// Fills `particles`, which must have the fields, with the gathered particles that `keep` chooses; work
/// columns are zero.
template <class Keep>
void fill(ParticleSet& particles, const GatheredState& state, Keep&& keep);

/// Copies one row of a gathered state into an own particle.
void put_row(ParticleSet& particles, std::size_t i, const std::vector<std::byte>& row);

template <class Keep>
void fill(ParticleSet& particles, const GatheredState& state, Keep&& keep) {
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < state.ids.size(); ++k)
        if (keep(k)) chosen.push_back(k);
    particles.resize(0);
    particles.resize(chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) put_row(particles, i, state.rows[chosen[i]]);
}

}  // namespace talus::test
