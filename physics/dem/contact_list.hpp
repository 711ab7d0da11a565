#pragma once
#include <cstdint>
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
struct ContactList {
    explicit ContactList(std::size_t history_count_) : history_count(history_count_) {}

    std::size_t history_count;              ///< values a pair
    std::vector<std::uint32_t> first;       ///< grain of the lower id; own or copy
    std::vector<std::uint32_t> second;      ///< grain of the higher id, or wall
    std::vector<std::uint16_t> law;         ///< index of the pair of materials
    std::vector<std::uint32_t> last_touch;  ///< evaluation at which the pair touched last; 0: never
    std::vector<double> history;            ///< history_count values a pair, one pair after the other
    std::vector<std::uint32_t> touching;    ///< pairs that touched at the last evaluation, with room behind
    std::size_t touching_count = 0;
    std::size_t own_count = 0;  ///< pairs of own grains; those with a copy follow

    std::size_t size() const { return first.size(); }
    std::size_t bytes() const {
        return (first.capacity() + second.capacity() + last_touch.capacity() + touching.capacity()) *
                   sizeof(std::uint32_t) +
               law.capacity() * sizeof(std::uint16_t) + history.capacity() * sizeof(double);
    }
    void clear();
    void add(std::uint32_t first_, std::uint32_t second_, std::size_t law_) {
        first.push_back(first_);
        second.push_back(second_);
        law.push_back(static_cast<std::uint16_t>(law_));
    }
    /// Makes room for the memory of what was added: nothing touches yet.
    void finish();
    /// Takes pairs off a list of which nothing touches yet.
    template <class IsUnwanted>
    void remove_if(IsUnwanted&& is_unwanted) {
        std::size_t kept = 0, own_kept = 0;
        for (std::size_t p = 0; p < size(); ++p) {
            if (is_unwanted(p)) continue;
            own_kept += p < own_count ? 1 : 0;
            first[kept] = first[p];
            second[kept] = second[p];
            law[kept++] = law[p];
        }
        first.resize(kept);
        second.resize(kept);
        law.resize(kept);
        own_count = own_kept;
        finish();
    }
};

/// What pairs a list of grains must hold.
struct PairRule {
    double margin;                           ///< greatest gap that is listed [m]
    std::span<const std::uint8_t> material;  ///< of each body
    std::span<const std::uint8_t> held;      ///< one a body: pairs of such grains do not act
    std::size_t materials;                   ///< number of materials
};

/// Lists the pairs of grains with a gap below the margin of which one at least is this rank's own. Positions,
/// radii, bodies and copied ids must be known of the copies.
void list_pairs(const ParticleSet& grains, const CellTable& table, const PairRule& rule, ContactList& list);

/// The contacts that touched at the last evaluation and whose first grain is below `end`, as records.
template <class KeyOfFirst, class KeyOfSecond>
void append_records(const ContactList& list, std::size_t end, KeyOfFirst&& key_of_first,
                    KeyOfSecond&& key_of_second, std::vector<ContactRecord>& records) {
    for (std::size_t k = 0; k < list.touching_count; ++k) {
        const std::uint32_t p = list.touching[k];
        if (list.first[p] >= end) continue;
        ContactRecord record{key_of_first(list.first[p]), key_of_second(list.second[p]), {}};
        for (std::size_t c = 0; c < list.history_count; ++c)
            record.history[c] = list.history[p * list.history_count + c];
        records.push_back(record);
    }
}

/// Gives the pairs of a new list that are among the records their memory back.
template <class KeyOfFirst, class KeyOfSecond>
void restore_records(const ContactRecordMap& records, std::uint32_t now, KeyOfFirst&& key_of_first,
                     KeyOfSecond&& key_of_second, ContactList& list) {
    for (std::uint32_t p = 0; p < list.size(); ++p) {
        const ContactRecord* record =
            records.find(key_of_first(list.first[p]), key_of_second(list.second[p]));
        if (!record) continue;
        list.last_touch[p] = now;
        list.touching[list.touching_count++] = p;
        for (std::size_t c = 0; c < list.history_count; ++c)
            list.history[p * list.history_count + c] = record->history[c];
    }
}

}  // namespace talus::dem
