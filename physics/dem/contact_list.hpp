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

/// The pairs that may touch until the list is made anew, each once, and the memory of those that do. A list
/// only has to hold every pair that touches: which others it holds, and in which order, changes no bit of
/// what is computed from it.
///
/// Pairs are kept in chunks, small enough for a cache, and in a chunk in order of classes of the gap they
/// were listed with: a pair need not be looked at before grains have moved far enough to close it. The
/// contacts of a chunk and what they remember lie one after the other in the order of their pairs; a chunk
/// has room for some more than it had at first, and moves behind all others if that is not enough.
struct ContactList {
    static constexpr std::size_t chunk_size = 1024, class_count = 16;
    struct Chunk {
        std::uint32_t begin;         ///< first pair
        std::uint32_t grains;        ///< this chunk and those before have no own grain from here on
        std::uint32_t place = 0;     ///< of its first contact
        std::uint32_t room = 0;      ///< for contacts; whole sets of lanes
        std::uint32_t contacts = 0;  ///< at the last evaluation
        std::array<std::uint16_t, class_count> up_to{};  ///< pairs of this class and those before
    };

    explicit ContactList(std::size_t history_count) : history(history_count) {}

    std::vector<std::uint32_t> first;          ///< grain of the lower id; own or copy
    std::vector<std::uint32_t> second;         ///< grain of the higher id
    std::vector<Chunk> chunks;                 ///< of own grains; then of pairs with a copy
    std::size_t own_chunks = 0;                ///< number of the former
    double margin = 0;                         ///< greatest gap that was listed [m]
    std::vector<std::uint16_t> pair;           ///< of each contact, counted from its chunk's first
    std::vector<std::vector<double>> history;  ///< what contacts remember, one array a value

    std::size_t size() const { return first.size(); }
    std::size_t history_count() const { return history.size(); }
    std::size_t contact_count() const;
    /// Number of the first pair with a copy.
    std::size_t own_count() const {
        return own_chunks < chunks.size() ? chunks[own_chunks].begin : first.size();
    }
    std::size_t bytes() const;

    /// Class of a gap [m].
    std::size_t class_of(double gap) const {
        const double place = gap / margin * (class_count - 1);
        return place > 0 ? std::min(static_cast<std::size_t>(place) + 1, class_count - 1) : 0;
    }

    /// Makes sure that so many contacts of a chunk find room; what they remembered may be lost.
    void make_room(Chunk& chunk, std::size_t count);

    /// Calls visit(p, k) for the contacts: p the pair, k the place of what it remembers.
    template <class Visit>
    void for_each_contact(Visit&& visit) const {
        for (const Chunk& chunk : chunks)
            for (std::size_t k = chunk.place; k < chunk.place + chunk.contacts; ++k)
                visit(chunk.begin + std::size_t{pair[k]}, k);
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
    list.for_each_contact([&](std::size_t p, std::size_t k) {
        if (list.first[p] >= end) return;
        ContactRecord record{key_of_first(list.first[p]), key_of_second(list.second[p]), {}};
        for (std::size_t c = 0; c < list.history_count(); ++c) record.history[c] = list.history[c][k];
        records.push_back(record);
    });
}

/// Gives the pairs of a new list that are among the records their memory back. Pairs whose gap is above
/// `reach` [m] have none: they cannot be in contact when they are evaluated next.
template <class KeyOfFirst, class KeyOfSecond>
void restore_records(const ContactRecordMap& records, double reach, KeyOfFirst&& key_of_first,
                     KeyOfSecond&& key_of_second, ContactList& list) {
    const std::size_t last_class = list.class_of(reach);
    std::vector<const ContactRecord*> found;
    for (ContactList::Chunk& chunk : list.chunks) {
        found.clear();
        for (std::uint32_t p = chunk.begin; p < chunk.begin + chunk.up_to[last_class]; ++p)
            found.push_back(records.find(key_of_first(list.first[p]), key_of_second(list.second[p])));
        const auto known = found.size() - static_cast<std::size_t>(std::ranges::count(found, nullptr));
        list.make_room(chunk, std::max(known, std::size_t{chunk.up_to[0]}));
        for (std::size_t k = 0; k < found.size(); ++k) {
            if (!found[k]) continue;
            const std::size_t place = chunk.place + chunk.contacts++;
            list.pair[place] = static_cast<std::uint16_t>(k);
            for (std::size_t c = 0; c < list.history_count(); ++c)
                list.history[c][place] = found[k]->history[c];
        }
    }
}

}  // namespace talus::dem
