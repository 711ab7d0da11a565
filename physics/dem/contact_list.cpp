#include "physics/dem/contact_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "domain/grain_fields.hpp"
#include "domain/lanes.hpp"
#include "physics/dem/size_levels.hpp"

namespace talus::dem {

namespace {

/// With less room to spare than vectors take by themselves.
template <class T>
void grow(std::vector<T>& values, std::size_t size) {
    constexpr std::size_t share = 16;
    if (size > values.capacity()) values.reserve(size + size / share);
    values.resize(size);
}

}  // namespace

std::size_t ContactList::contact_count() const {
    std::size_t count = 0;
    for (const Chunk& chunk : chunks) count += chunk.contacts;
    return count;
}

void ContactList::make_room(Chunk& chunk, std::size_t count) {
    if (count <= chunk.room) return;
    constexpr std::size_t share = 16;
    const std::size_t sets = (count + count / share + lane_count - 1) / lane_count;
    chunk.place = static_cast<std::uint32_t>(pair.size());
    chunk.room = static_cast<std::uint32_t>(sets * lane_count);
    grow(pair, pair.size() + chunk.room);
    for (std::vector<double>& values : history) grow(values, pair.size());
}

std::size_t ContactList::bytes() const {
    std::size_t bytes = (first.capacity() + second.capacity()) * sizeof(std::uint32_t) +
                        chunks.capacity() * sizeof(Chunk) + pair.capacity() * sizeof(std::uint16_t);
    for (const std::vector<double>& values : history) bytes += values.capacity() * sizeof(double);
    return bytes;
}

namespace {

/// Puts pairs into a list, those with copies after those of own grains.
class ListedPairs {
  public:
    ListedPairs(const ParticleSet& grains, const PairRule& rule, ContactList& list)
        : spheres_(spheres_of(grains)),
          body_(grains.data(field::body)),
          id_(grains.data(field::copied_id)),
          own_(grains.size()),
          rule_(rule),
          list_(list) {
        list_.first.clear();
        list_.second.clear();
        list_.chunks.clear();
        list_.pair.clear();
        for (std::vector<double>& values : list_.history) values.clear();
        list_.margin = rule.margin;
    }

    /// `both_ways`: pairs of own grains come from either side.
    void add(std::uint32_t i, std::uint32_t j, bool both_ways) {
        if (i == j || (rule_.held[body_[i]] && rule_.held[body_[j]]) || (i >= own_ && j >= own_)) return;
        if (rule_.left_out && rule_.left_out(i, j)) return;
        const bool in_order = id_[i] < id_[j];
        const Pair pair = in_order ? Pair{i, j} : Pair{j, i};
        if (i >= own_ || j >= own_)
            with_copies_.push_back(pair);
        else if (in_order || !both_ways)
            chunk_.push_back(pair);
        if (chunk_.size() == ContactList::chunk_size) put(chunk_);
    }

    void finish() {
        if (!chunk_.empty()) put(chunk_);
        list_.own_chunks = list_.chunks.size();
        for (const Pair& pair : with_copies_) {
            chunk_.push_back(pair);
            if (chunk_.size() == ContactList::chunk_size) put(chunk_);
        }
        if (!chunk_.empty()) put(chunk_);
    }

  private:
    struct Pair {
        std::uint32_t first, second;
    };

    /// Appends a chunk, sorted by classes of gaps, which is empty then.
    void put(std::vector<Pair>& pairs) {
        std::array<std::uint8_t, ContactList::chunk_size> of_class;
        ContactList::Chunk chunk{.begin = static_cast<std::uint32_t>(list_.size()), .grains = grains_};
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            for (const std::uint32_t i : {pairs[k].first, pairs[k].second})
                if (i < own_) chunk.grains = std::max(chunk.grains, i + 1);
            of_class[k] = static_cast<std::uint8_t>(list_.class_of(gap(pairs[k])));
            ++chunk.up_to[of_class[k]];
        }
        std::array<std::uint16_t, ContactList::class_count> place{};
        for (std::size_t c = 1; c < place.size(); ++c) {
            place[c] = chunk.up_to[c - 1];
            chunk.up_to[c] = static_cast<std::uint16_t>(chunk.up_to[c] + chunk.up_to[c - 1]);
        }
        grow(list_.first, chunk.begin + pairs.size());
        grow(list_.second, chunk.begin + pairs.size());
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            const std::size_t p = chunk.begin + place[of_class[k]]++;
            list_.first[p] = pairs[k].first;
            list_.second[p] = pairs[k].second;
        }
        grains_ = chunk.grains;
        list_.chunks.push_back(chunk);
        pairs.clear();
    }

    double gap(const Pair& pair) const {
        double square = 0;
        for (const double* x : spheres_.x)
            square += (x[pair.first] - x[pair.second]) * (x[pair.first] - x[pair.second]);
        return std::sqrt(square) - spheres_.radius[pair.first] - spheres_.radius[pair.second];
    }

    Spheres spheres_;
    const std::uint8_t* body_;
    const std::uint64_t* id_;
    std::size_t own_;
    const PairRule& rule_;
    ContactList& list_;
    std::vector<Pair> chunk_, with_copies_;
    std::uint32_t grains_ = 0;  ///< above all own ones of the chunks before
};

}  // namespace

void list_pairs(const ParticleSet& grains, const CellTable& table, const PairRule& rule, ContactList& list) {
    ListedPairs pairs(grains, rule, list);
    if (!SizeLevels::one_is_enough(grains, rule.largest_radius)) {
        SizeLevels(grains, rule.margin).for_each_pair([&](std::uint32_t i, std::uint32_t j, bool one_level) {
            pairs.add(i, j, one_level);
        });
        return pairs.finish();
    }
    const Spheres spheres{
        {grains.data(field::position, 0), grains.data(field::position, 1), grains.data(field::position, 2)},
        grains.data(field::radius)};
    NearSpheres near;
    table.for_each_own(Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const std::array<double, 3> place{spheres.x[0][i], spheres.x[1][i], spheres.x[2][i]};
            for (const std::uint32_t j : near(spheres, runs, place, spheres.radius[i] + rule.margin))
                pairs.add(i, j, true);
        }
    });
    pairs.finish();
}

std::vector<std::uint8_t> copies_in(const ContactList& list, std::size_t own, std::size_t copies) {
    std::vector<std::uint8_t> found(copies, 0);
    for (std::size_t p = list.own_count(); p < list.size(); ++p)
        for (const std::uint32_t i : {list.first[p], list.second[p]})
            if (i >= own) found[i - own] = 1;
    return found;
}

}  // namespace talus::dem
