#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "comm/decomposition.hpp"
#include "domain/particles.hpp"

namespace talus::dem {

/// Most values that a contact law remembers.
inline constexpr std::size_t most_history = 7;

/// Names a place of a wall where a second grain would be named.
constexpr std::uint64_t wall_key(std::uint32_t wall, std::uint32_t place) {
    return std::uint64_t{1} << 63 | std::uint64_t{wall} << 32 | place;
}
constexpr bool is_wall_key(std::uint64_t key) { return key >> 63 != 0; }

/// A contact and what its law remembers, independent of where its grains are stored.
struct ContactRecord {
    std::uint64_t first, second;  ///< ids in order, or a grain's and a wall_key()
    std::array<double, most_history> history;
};

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
void follow_grains(const Communicator& comm, const Decomposition& decomposition, const CellGrid& grid,
                   const ParticleSet& grains, std::vector<ContactRecord>& records);

/// An empty set of contacts; `fields` hold what they remember.
ParticleSet empty_contacts(int dimension, std::span<const FieldInfo* const> fields);

/// Id of the row of a contact among those of its first grain, numbered from 0. Throws std::runtime_error for
/// ids from 2^44 on.
std::uint64_t contact_row_id(std::uint64_t first, std::uint64_t rank);

/// The set that a checkpoint saves, of the records whose first grain is this rank's own; row ids order the
/// contacts by their grains' ids: contact_row_id().
ParticleSet saved_contacts(std::vector<ContactRecord> records, int dimension,
                           std::span<const FieldInfo* const> fields);

/// The reverse: hands the rows of a checkpoint to the ranks that hold the grains they name. `grains` as they
/// were read from it, in order of id over all ranks. Collective.
std::vector<ContactRecord> read_contacts(const Communicator& comm, const ParticleSet& contacts,
                                         std::span<const FieldInfo* const> fields, const ParticleSet& grains);

}  // namespace talus::dem
