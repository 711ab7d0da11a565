#include "physics/dem/contact_record.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <stdexcept>
#include <unordered_map>

#include "domain/grain_fields.hpp"

namespace talus::dem {

ContactRecordMap::ContactRecordMap(std::span<const ContactRecord> records)
    : records_(records), slots_(std::bit_ceil(2 * records.size() + 2)) {
    for (std::size_t k = 0; k < records.size(); ++k) {
        std::uint32_t& slot = slots_[place_of(records[k].first, records[k].second)];
        if (slot == 0) slot = static_cast<std::uint32_t>(k + 1);
    }
}

std::size_t ContactRecordMap::place_of(std::uint64_t first, std::uint64_t second) const {
    std::uint64_t mixed = (first * 0x9E3779B97F4A7C15u) ^ second;
    mixed = (mixed ^ mixed >> 29) * 0xBF58476D1CE4E5B9u;
    std::size_t place = (mixed ^ mixed >> 32) & (slots_.size() - 1);
    while (slots_[place] != 0) {
        const ContactRecord& there = records_[slots_[place] - 1];
        if (there.first == first && there.second == second) break;
        place = (place + 1) & (slots_.size() - 1);
    }
    return place;
}

const ContactRecord* ContactRecordMap::find(std::uint64_t first, std::uint64_t second) const {
    const std::uint32_t slot = slots_[place_of(first, second)];
    return slot == 0 ? nullptr : &records_[slot - 1];
}

namespace {

template <std::size_t count>
using Parcels = std::map<int, std::vector<PairRecord<count>>>;

/// Records that other ranks sent, appended.
template <std::size_t count>
void exchange(const Communicator& comm, const Parcels<count>& leaving,
              std::vector<PairRecord<count>>& records) {
    std::vector<Parcel> outgoing;
    for (const auto& [rank, sent] : leaving) {
        const auto bytes = std::as_bytes(std::span(sent));
        outgoing.push_back({rank, {bytes.begin(), bytes.end()}});
    }
    for (const Parcel& parcel : SparseExchange(comm)(std::move(outgoing))) {
        const std::size_t before = records.size();
        records.resize(before + parcel.bytes.size() / sizeof(PairRecord<count>));
        std::memcpy(records.data() + before, parcel.bytes.data(), parcel.bytes.size());
    }
}

}  // namespace

template <std::size_t count>
void follow_grains(const Communicator& comm, const Decomposition& decomposition, const CellGrid& grid,
                   const ParticleSet& grains, std::vector<PairRecord<count>>& records) {
    if (comm.size() == 1) return;
    const std::uint64_t* id = grains.data(field::id);
    std::unordered_map<std::uint64_t, int> destination;  // of the grains that leave
    for (std::size_t i = 0; i < grains.size(); ++i) {
        Cell cell{};
        for (int axis = 0; axis < grains.dimension(); ++axis)
            cell[static_cast<std::size_t>(axis)] =
                grid.index_along(axis, grains.data(field::position, axis)[i]);
        const int owner = decomposition.partition().owner_of(cell);
        if (owner != comm.rank()) destination.emplace(id[i], owner);
    }
    Parcels<count> leaving;
    if (!destination.empty())
        for (const PairRecord<count>& record : records) {
            const auto first = destination.find(record.first), second = destination.find(record.second);
            const int to_first = first == destination.end() ? comm.rank() : first->second;
            const int to_second = second == destination.end() ? comm.rank() : second->second;
            if (to_first != comm.rank()) leaving[to_first].push_back(record);
            if (to_second != comm.rank() && to_second != to_first) leaving[to_second].push_back(record);
        }
    exchange(comm, leaving, records);
}

namespace {

/// Calls visit(component array, place in the history) for all that a contact remembers.
template <class Set, class Visit>
void for_each_component(Set& contacts, std::span<const FieldInfo* const> fields, Visit&& visit) {
    std::size_t place = 0;
    for (const FieldInfo* info : fields)
        for (auto& component : contacts.column(*info).components) visit(component.data(), place++);
}

}  // namespace

ParticleSet empty_pairs(const std::string& name, int dimension, std::span<const FieldInfo* const> fields) {
    ParticleSet pairs(name, dimension);
    std::erase_if(pairs.columns(), [](const Column& column) { return column.info == &field::position; });
    pairs.add(field::first_id);
    pairs.add(field::second_id);
    for (const FieldInfo* info : fields) pairs.add(*info);
    return pairs;
}

ParticleSet empty_contacts(int dimension, std::span<const FieldInfo* const> fields) {
    return empty_pairs("contacts", dimension, fields);
}

std::uint64_t pair_row_id(std::uint64_t first, std::uint64_t rank) {
    constexpr int bits_of_rank = 20;
    if (first >> (64 - bits_of_rank) != 0 || rank >> bits_of_rank != 0)
        throw std::runtime_error("contacts of ids from 2^44 on, or more than 2^20 of a grain");
    return first << bits_of_rank | rank;
}

template <std::size_t count>
void save_pairs(std::vector<PairRecord<count>> records, std::span<const FieldInfo* const> fields,
                ParticleSet& pairs) {
    std::sort(records.begin(), records.end(), is_before<count>);
    pairs.resize(records.size());
    std::uint64_t rank = 0;
    for (std::size_t k = 0; k < records.size(); ++k) {
        rank = k > 0 && records[k].first == records[k - 1].first ? rank + 1 : 0;
        pairs.data(field::id)[k] = pair_row_id(records[k].first, rank);
        pairs.data(field::first_id)[k] = records[k].first;
        pairs.data(field::second_id)[k] = records[k].second;
    }
    for_each_component(pairs, fields, [&](std::byte* values, std::size_t place) {
        for (std::size_t k = 0; k < records.size(); ++k)
            reinterpret_cast<double*>(values)[k] = records[k].history[place];
    });
}

template <std::size_t count>
std::vector<PairRecord<count>> rows_of_pairs(const ParticleSet& pairs,
                                             std::span<const FieldInfo* const> fields) {
    std::vector<PairRecord<count>> rows(pairs.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
        rows[k] = {pairs.data(field::first_id)[k], pairs.data(field::second_id)[k], {}};
    for_each_component(pairs, fields, [&](const std::byte* values, std::size_t place) {
        for (std::size_t k = 0; k < rows.size(); ++k)
            rows[k].history[place] = reinterpret_cast<const double*>(values)[k];
    });
    return rows;
}

template <std::size_t count>
std::vector<PairRecord<count>> read_pairs(const Communicator& comm, const ParticleSet& pairs,
                                          std::span<const FieldInfo* const> fields,
                                          const ParticleSet& grains) {
    const std::vector<PairRecord<count>> rows = rows_of_pairs<count>(pairs, fields);
    // Ranks hold grains in order of id; those without any repeat the id of the next.
    const auto ids = grains.own(field::id);
    const std::uint64_t least = ids.empty() ? ~std::uint64_t{0} : *std::min_element(ids.begin(), ids.end());
    std::vector<std::uint64_t> starts = comm.all_gather(std::span<const std::uint64_t>(&least, 1));
    for (std::size_t r = starts.size() - 1; r > 0; --r) starts[r - 1] = std::min(starts[r - 1], starts[r]);
    const auto holder = [&](std::uint64_t id) {
        const auto after = std::upper_bound(starts.begin(), starts.end(), id);
        return static_cast<int>(std::max<std::ptrdiff_t>(after - starts.begin() - 1, 0));
    };
    Parcels<count> parcels;
    for (const PairRecord<count>& row : rows) {
        const int first = holder(row.first), second = holder(row.second);
        parcels[first].push_back(row);
        if (!is_wall_key(row.second) && second != first) parcels[second].push_back(row);
    }
    std::vector<PairRecord<count>> records;
    exchange(comm, parcels, records);
    return records;
}

template void follow_grains(const Communicator&, const Decomposition&, const CellGrid&, const ParticleSet&,
                            std::vector<ContactRecord>&);
template void follow_grains(const Communicator&, const Decomposition&, const CellGrid&, const ParticleSet&,
                            std::vector<BondRecord>&);
template void save_pairs(std::vector<ContactRecord>, std::span<const FieldInfo* const>, ParticleSet&);
template void save_pairs(std::vector<BondRecord>, std::span<const FieldInfo* const>, ParticleSet&);
template std::vector<ContactRecord> rows_of_pairs(const ParticleSet&, std::span<const FieldInfo* const>);
template std::vector<ContactRecord> read_pairs(const Communicator&, const ParticleSet&,
                                               std::span<const FieldInfo* const>, const ParticleSet&);
template std::vector<BondRecord> read_pairs(const Communicator&, const ParticleSet&,
                                            std::span<const FieldInfo* const>, const ParticleSet&);

}  // namespace talus::dem
