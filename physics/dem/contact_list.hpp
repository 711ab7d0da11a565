#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "comm/decomposition.hpp"
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/dem/contact_record.hpp"

namespace talus::dem {

/// The contacts of one evaluation, in order of their pairs, and what they remember.
struct Contacts {
    std::vector<std::uint32_t> pair;           ///< index of each in the list; room for a set of lanes behind
    std::vector<std::vector<double>> history;  ///< one array a value; as many as are in `pair` and a 0 behind
    std::size_t count = 0;

    explicit Contacts(std::size_t history_count) : history(history_count) {}
    void clear() { count = 0; }
    /// Makes sure that `more` contacts find room.
    void reserve(std::size_t more);
    /// Puts an end behind the contacts: a pair above all, which remembers nothing.
    void close();
    std::size_t bytes() const;
};

/// The pairs that may touch until the list is made anew, each once, and the memory of those that do. A list
/// only has to hold every pair that touches: which others it holds, and in which order, changes no bit of
/// what is computed from it.
///
/// Pairs are kept in chunks, small enough for a cache, and in a chunk in order of classes of the gap they
/// were listed with: a pair need not be looked at before grains have moved far enough to close it.
struct ContactList {
    static constexpr std::size_t chunk_size = 1024, class_count = 16;
    struct Chunk {
        std::uint32_t begin;
        std::array<std::uint16_t, class_count> up_to;  ///< pairs of this class and those before
    };

    explicit ContactList(std::size_t history_count) : now(history_count), before(history_count) {}

    std::vector<std::uint32_t> first;   ///< grain of the lower id; own or copy
    std::vector<std::uint32_t> second;  ///< grain of the higher id
    std::vector<Chunk> chunks;          ///< of own grains; then of pairs with a copy
    std::size_t own_chunks = 0;         ///< number of the former
    double margin = 0;                  ///< greatest gap that was listed [m]
    Contacts now, before;               ///< of the last evaluation, and of the one before

    std::size_t size() const { return first.size(); }
    std::size_t history_count() const { return now.history.size(); }
    /// Number of the first pair with a copy.
    std::size_t own_count() const {
        return own_chunks < chunks.size() ? chunks[own_chunks].begin : first.size();
    }
    std::size_t bytes() const {
        return (first.capacity() + second.capacity()) * sizeof(std::uint32_t) +
               chunks.capacity() * sizeof(Chunk) + now.bytes() + before.bytes();
    }

    /// Class of a gap [m].
    std::size_t class_of(double gap) const {
        const double place = gap / margin * (class_count - 1);
        return place > 0 ? std::min(static_cast<std::size_t>(place) + 1, class_count - 1) : 0;
    }
};

/// What pairs a list of grains must hold.
struct PairRule {
    double margin;          ///< greatest gap that is listed [m]
    double largest_radius;  ///< of all ranks' grains, that the table's cells are made for [m]
    std::span<const std::uint8_t> material;  ///< of each body
    std::span<const std::uint8_t> held;      ///< one a body: pairs of such grains do not act
    std::size_t materials;                   ///< number of materials
    /// True for pairs that never act, as stored; empty if there are none.
    std::function<bool(std::uint32_t, std::uint32_t)> left_out = {};
};

/// Lists the pairs of grains with a gap below the margin of which one at least is this rank's own. Positions,
/// radii, bodies and copied ids must be known of the copies. Nothing touches yet.
void list_pairs(const ParticleSet& grains, const CellTable& table, const PairRule& rule, ContactList& list);

/// One for each copy: 1 if the list holds a pair of it. `own`: number of grains before the copies.
std::vector<std::uint8_t> copies_in(const ContactList& list, std::size_t own, std::size_t copies);

/// The contacts of the last evaluation whose first grain is below `end`, as records.
template <class KeyOfFirst, class KeyOfSecond>
void append_records(const ContactList& list, std::size_t end, KeyOfFirst&& key_of_first,
                    KeyOfSecond&& key_of_second, std::vector<ContactRecord>& records) {
    for (std::size_t k = 0; k < list.now.count; ++k) {
        const std::uint32_t p = list.now.pair[k];
        if (list.first[p] >= end) continue;
        ContactRecord record{key_of_first(list.first[p]), key_of_second(list.second[p]), {}};
        for (std::size_t c = 0; c < list.history_count(); ++c) record.history[c] = list.now.history[c][k];
        records.push_back(record);
    }
}

/// Gives the pairs of a new list that are among the records their memory back.
template <class KeyOfFirst, class KeyOfSecond>
void restore_records(const ContactRecordMap& records, KeyOfFirst&& key_of_first, KeyOfSecond&& key_of_second,
                     ContactList& list) {
    Contacts& contacts = list.now;
    for (std::uint32_t p = 0; p < list.size(); ++p) {
        const ContactRecord* record =
            records.find(key_of_first(list.first[p]), key_of_second(list.second[p]));
        if (!record) continue;
        contacts.reserve(1);
        contacts.pair[contacts.count] = p;
        for (std::size_t c = 0; c < list.history_count(); ++c)
            contacts.history[c][contacts.count] = record->history[c];
        ++contacts.count;
    }
}

}  // namespace talus::dem
