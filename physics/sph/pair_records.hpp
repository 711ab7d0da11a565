#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "domain/lanes.hpp"

namespace talus::sph {

/// What a pair loop reads of one particle, side by side in memory: a partner costs a few cache lines, not one
/// for each of its values.
template <std::size_t count>
struct alignas(32) PairRecord {
    std::array<double, count> values;
};

/// One record in every lane.
template <std::size_t count>
std::array<Lanes, count> broadcast(const PairRecord<count>& record) {
    std::array<Lanes, count> lanes;
    for (std::size_t c = 0; c < count; ++c) lanes[c] = record.values[c];
    return lanes;
}

/// The records of a particle set, own particles and copies.
template <std::size_t count>
class PairRecords {
  public:
    explicit PairRecords(std::size_t particles)
        : size_(particles), records_(std::make_unique_for_overwrite<PairRecord<count>[]>(particles)) {}

    /// Values from `place` on are copied from these component arrays.
    template <std::size_t components>
    void copy(std::size_t place, const std::array<const double*, components>& from) {
        for (std::size_t c = 0; c < components; ++c) columns_[place + c] = from[c];
    }
    /// Fills all records; finish(k, values) sets what is not copied.
    template <class Finish>
    void fill(Finish&& finish) {
        for (std::size_t k = 0; k < size_; ++k) {
            auto& values = records_[k].values;
            for (std::size_t c = 0; c < count; ++c)
                if (columns_[c]) values[c] = columns_[c][k];
            finish(k, values);
        }
    }

    const PairRecord<count>& operator[](std::size_t k) const { return records_[k]; }

    /// The records of four particles, one in each lane.
    std::array<Lanes, count> gather(const std::uint32_t* index) const {
        std::array<Lanes, count> lanes;
        std::array<const double*, lane_count> from;
        for (std::size_t lane = 0; lane < lane_count; ++lane)
            from[lane] = records_[index[lane]].values.data();
        const auto two = [&](std::size_t c) {
            load_two({from[0] + c, from[1] + c, from[2] + c, from[3] + c}, lanes[c], lanes[c + 1]);
        };
        [&]<std::size_t... pair>(std::index_sequence<pair...>) { (two(2 * pair), ...); }
        (std::make_index_sequence<count / 2>{});
        if constexpr (count % 2 == 1)
            lanes[count - 1] = Lanes([&](auto lane) { return from[lane][count - 1]; });
        return lanes;
    }

  private:
    std::array<const double*, count> columns_{};
    std::size_t size_;
    std::unique_ptr<PairRecord<count>[]> records_;
};

}  // namespace talus::sph
