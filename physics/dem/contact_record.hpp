#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "comm/decomposition.hpp"
#include "domain/particles.hpp"

namespace talus::dem {

/// Most values that a contact law remembers.
inline constexpr std::size_t most_history = 8;

/// Values that are kept of a bond.
inline constexpr std::size_t bond_values = 10;

/// Names a place of a wall where a second grain would be named.
constexpr std::uint64_t wall_key(std::uint32_t wall, std::uint32_t place) {
    return std::uint64_t{1} << 63 | std::uint64_t{wall} << 32 | place;
}
constexpr bool is_wall_key(std::uint64_t key) { return key >> 63 != 0; }

/// A pair and what is remembered of it, independent of where its grains are stored.
template <std::size_t count>
struct PairRecord {
    std::uint64_t first, second;  ///< ids in order, or a grain's and a wall_key()
    std::array<double, count> history;
};
using ContactRecord = PairRecord<most_history>;
/// A bond: index of the scene's table, length at rest and radius [m], and the history of BeamBond.
using BondRecord = PairRecord<bond_values>;

/// In order of ids.
template <std::size_t count>
bool is_before(const PairRecord<count>& a, const PairRecord<count>& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// Finds records by what touches.
class ContactRecordMap {
  public:
    explicit ContactRecordMap(std::span<const ContactRecord> records);
    const ContactRecord* find(std::uint64_t first, std::uint64_t second) const;

  private:
    std::size_t place_of(std::uint64_t first, std::uint64_t second) const;
    std::span<const ContactRecord> records_;
    std::vector<std::uint32_t> slots_;  ///< index + 1 of a record, 0: free
};

/// Sends the records of the own grains that will move to another rank when `grains` are arranged on the grid
/// next, and takes up those that come; own ones are kept, even if they are not needed any more. Collective.
/// This and the following are there for records of contacts and of bonds.
template <std::size_t count>
void follow_grains(const Communicator& comm, const Decomposition& decomposition, const CellGrid& grid,
                   const ParticleSet& grains, std::vector<PairRecord<count>>& records);

/// An empty set of contacts; `fields` hold what they remember.
ParticleSet empty_contacts(int dimension, std::span<const FieldInfo* const> fields);
/// The same of another name.
ParticleSet empty_pairs(const std::string& name, int dimension, std::span<const FieldInfo* const> fields);

/// Id of the row of a pair among those of its first grain, numbered from 0. Throws std::runtime_error for ids
/// from 2^44 on.
std::uint64_t pair_row_id(std::uint64_t first, std::uint64_t rank);

/// Fills an empty set as a checkpoint saves it with the records whose first grain is this rank's own; row ids
/// order the pairs by their grains' ids: pair_row_id().
template <std::size_t count>
void save_pairs(std::vector<PairRecord<count>> records, std::span<const FieldInfo* const> fields,
                ParticleSet& pairs);

/// The records in the rows of such a set that this rank holds.
template <std::size_t count>
std::vector<PairRecord<count>> rows_of_pairs(const ParticleSet& pairs,
                                             std::span<const FieldInfo* const> fields);

/// The reverse: hands the rows of a checkpoint to the ranks that hold the grains they name. `grains` as they
/// were read from it, in order of id over all ranks. Collective.
template <std::size_t count>
std::vector<PairRecord<count>> read_pairs(const Communicator& comm, const ParticleSet& pairs,
                                          std::span<const FieldInfo* const> fields,
                                          const ParticleSet& grains);

}  // namespace talus::dem
