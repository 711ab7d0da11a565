#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

#include "domain/cell_table.hpp"

namespace talus {

/// A growing array of doubles on a cache-line boundary, for values gathered in front of a pair loop.
class AlignedValues {
  public:
    AlignedValues() = default;
    AlignedValues(const AlignedValues&) = delete;
    AlignedValues& operator=(const AlignedValues&) = delete;
    ~AlignedValues() { release(); }

    void reserve(std::size_t count) {
        if (count <= capacity_) return;
        release();
        capacity_ = count + count / 2;
        data_ = new (alignment) double[capacity_];
    }
    double* data() { return data_; }

  private:
    static constexpr std::align_val_t alignment{64};
    void release() {
        if (data_) ::operator delete[](data_, alignment);
    }
    double* data_ = nullptr;
    std::size_t capacity_ = 0;
};

/// The interaction partners of one particle: found exactly (|r| < radius, itself excluded), in canonical
/// order, so that what is summed over them has the same bits on any number of ranks.
template <int D>
class Partners {
  public:
    /// `position`: D component arrays, own particles and copies; `i` the particle; `limit2(k)` the squared
    /// radius within which particle k interacts with it [m2].
    template <class Limit2>
    void find(const std::array<const double*, D>& position, std::uint32_t i, std::span<const Run> runs,
              Limit2&& limit2) {
        std::size_t most = 0;
        for (const Run& run : runs) most += run.end - run.begin;
        if (index_.size() < most + 1) index_.resize(most + 1);
        distance2_.reserve(most + 1);
        std::array<double, D> centre;
        for (int d = 0; d < D; ++d) centre[d] = position[d][i];
        std::uint32_t* index = index_.data();
        double* excess = distance2_.data();
        count_ = 0;
        for (const Run& run : runs) {
            const std::uint32_t n = run.end - run.begin;
#pragma omp simd
            for (std::uint32_t k = 0; k < n; ++k) {
                double r2 = 0;
                for (int d = 0; d < D; ++d) {
                    const double dx = centre[d] - position[d][run.begin + k];
                    r2 += dx * dx;
                }
                excess[k] = r2 - limit2(run.begin + k);
            }
            for (std::uint32_t k = 0; k < n; ++k) {
                index[count_] = run.begin + k;
                count_ += (excess[k] < 0) & (run.begin + k != i);
            }
        }
    }

    std::size_t count() const { return count_; }
    std::span<const std::uint32_t> index() const { return {index_.data(), count_}; }

    /// Copies one component of a field for all partners to contiguous memory.
    template <class T>
    void gather(const T* from, AlignedValues& to) const {
        to.reserve(count_);
        double* values = to.data();
        const std::uint32_t* index = index_.data();
        for (std::size_t k = 0; k < count_; ++k) values[k] = static_cast<double>(from[index[k]]);
    }

  private:
    std::vector<std::uint32_t> index_;
    AlignedValues distance2_;
    std::size_t count_ = 0;
};

}  // namespace talus
