#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <vector>

#include "domain/lanes.hpp"

namespace talus::dem {

/// The laws of all pairs of materials, one a pair, symmetric.
template <class Law>
class PairTable {
  public:
    /// `make(a, b)` is asked for a <= b.
    template <class Make>
    PairTable(std::size_t materials, Make&& make) : materials_(materials) {
        for (std::size_t a = 0; a < materials; ++a)
            for (std::size_t b = 0; b < materials; ++b)
                laws_.push_back(a <= b ? make(a, b) : laws_[b * materials + a]);
    }
    std::size_t index(std::size_t a, std::size_t b) const { return a * materials_ + b; }
    const Law& operator()(std::size_t a, std::size_t b) const { return laws_[index(a, b)]; }
    const Law& operator[](std::size_t index) const { return laws_[index]; }
    std::size_t materials() const { return materials_; }

  private:
    std::size_t materials_;
    std::vector<Law> laws_;
};

/// The laws of as many pairs as there are lanes, side by side. A law is an aggregate of its Real only.
template <class LawOfLanes, class Law>
LawOfLanes gather(const PairTable<Law>& table, const std::array<std::size_t, lane_count>& index) {
    constexpr std::size_t count = sizeof(Law) / sizeof(double);
    static_assert(sizeof(LawOfLanes) == count * sizeof(Lanes));
    using Values = std::array<double, count>;
    std::array<Lanes, count> gathered;
    for (std::size_t c = 0; c < count; ++c)
        gathered[c] = Lanes([&](auto lane) { return std::bit_cast<Values>(table[index[lane]])[c]; });
    return std::bit_cast<LawOfLanes>(gathered);
}

/// One law in all lanes.
template <class LawOfLanes, class Law>
LawOfLanes in_all_lanes(const Law& law) {
    constexpr std::size_t count = sizeof(Law) / sizeof(double);
    static_assert(sizeof(LawOfLanes) == count * sizeof(Lanes));
    const auto values = std::bit_cast<std::array<double, count>>(law);
    std::array<Lanes, count> spread;
    for (std::size_t c = 0; c < count; ++c) spread[c] = Lanes(values[c]);
    return std::bit_cast<LawOfLanes>(spread);
}

}  // namespace talus::dem
