#include "domain/cell_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace talus {

bool Image::is_original() const { return shift == std::array<double, 3>{} && flip == std::array<bool, 3>{}; }

CellGrid::CellGrid(const Box& box, double radius, int reach) : box_(box), reach_(reach) {
    if (!(radius > 0) || !std::isfinite(radius))
        throw std::invalid_argument(
            fmt::format("interaction radius {} m (must be positive and finite)", radius));
    covered_radius_ = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < box.dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double least = box.shear_rate != 0 && axis == 0 ? 2 * radius : radius;
        size_[a] = least / reach;
        if (box.boundary[a] != Boundary::open) {
            if (box.length(axis) < least)
                throw std::invalid_argument(
                    fmt::format("box is {} m long along {}, shorter than {}the interaction radius {} m",
                                box.length(axis), "xyz"[axis], least > radius ? "twice " : "", radius));
            origin_[a] = box.lower[a];
            count_[a] = std::min(static_cast<int>(box.length(axis) / size_[a]), cell_limit);
            size_[a] = box.length(axis) / count_[a];
        }
        inverse_size_[a] = 1 / size_[a];
        covered_radius_ = std::min(covered_radius_, size_[a] * reach);
    }
}

CellGrid CellGrid::reaching(double radius) const {
    CellGrid grid = *this;
    const double least = covered_radius_ / reach_;
    grid.reach_ = static_cast<int>(std::ceil(radius / least));
    grid.covered_radius_ = grid.reach_ * least;
    return grid;
}

namespace {
struct AxisImage {
    int index;
    double shift;
    bool flip;
};

std::vector<AxisImage> axis_images(const CellGrid& grid, int axis, int index) {
    const auto a = static_cast<std::size_t>(axis);
    std::vector<AxisImage> images{{index, 0, false}};
    const int count = grid.cell_count(axis), reach = grid.reach();
    const Box& box = grid.box();
    if (box.boundary[a] == Boundary::periodic) {
        for (int turn = 1; index - turn * count >= -reach; ++turn)
            images.push_back({index - turn * count, -turn * box.length(axis), false});
        for (int turn = 1; index + turn * count < count + reach; ++turn)
            images.push_back({index + turn * count, turn * box.length(axis), false});
    } else if (box.boundary[a] == Boundary::reflecting) {
        if (index < reach) images.push_back({-1 - index, 2 * box.lower[a], true});
        if (count - 1 - index < reach) images.push_back({2 * count - 1 - index, 2 * box.upper[a], true});
    }
    return images;
}
}  // namespace

std::vector<Image> CellGrid::images(const Cell& cell) const {
    if (box_.shear_rate != 0) return sheared_images(cell);
    std::vector<Image> result{Image{cell, {}, {}}};
    for (int axis = 0; axis < box_.dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const auto along = axis_images(*this, axis, cell[a]);
        const std::size_t before = result.size();
        for (std::size_t k = 1; k < along.size(); ++k)
            for (std::size_t b = 0; b < before; ++b) {
                Image image = result[b];
                image.cell[a] = along[k].index;
                image.shift[a] = along[k].shift;
                image.flip[a] = along[k].flip;
                result.push_back(image);
            }
    }
    return result;
}

/// A displaced cell is counted to the nearest one: its particles lie up to half a cell beside it, which the
/// double width leaves room for.
std::vector<Image> CellGrid::sheared_images(const Cell& cell) const {
    const int displaced = static_cast<int>(std::lround(image_offset_ * inverse_size_[0]));
    std::vector<Image> result;
    for (const AxisImage& y : axis_images(*this, 1, cell[1])) {
        const double turns = std::round(y.shift / box_.length(1));
        std::vector<AxisImage> along_x = axis_images(*this, 0, cell[0]);
        if (turns != 0) {
            along_x.clear();
            const int lowest = cell[0] + static_cast<int>(turns) * displaced;
            const int first = (lowest + reach_) / count_[0] + 1;  // turns back, at most
            for (int turn = -first; lowest + turn * count_[0] < count_[0] + reach_; ++turn)
                if (const int index = lowest + turn * count_[0]; index >= -reach_)
                    along_x.push_back({index, turns * image_offset_ + turn * box_.length(0), false});
        }
        for (const AxisImage& x : along_x)
            for (const AxisImage& z : axis_images(*this, 2, cell[2]))
                result.push_back({{x.index, y.index, z.index}, {x.shift, y.shift, z.shift}, {}});
    }
    return result;
}

bool CellGrid::has_copies(const Cell& cell) const {
    for (int axis = 0; axis < box_.dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (box_.boundary[a] == Boundary::open) continue;
        if (cell[a] < reach_ || cell[a] >= count_[a] - reach_) return true;
    }
    return false;
}

double CellGrid::ladder_radius(double radius) {
    // 2^(k/8 - 1), written out: logarithms would put some rungs one too high, and differ between libraries.
    constexpr std::array<double, 9> rungs{0.5,
                                          0.5452538663326288,
                                          0.5946035575013605,
                                          0.6484197773255048,
                                          0.7071067811865476,
                                          0.7711054127039704,
                                          0.8408964152537145,
                                          0.9170040432046712,
                                          1.0};
    if (!(radius > 0) || !std::isfinite(radius)) return radius;  // for the grid to refuse
    int exponent = 0;
    const double fraction = std::frexp(radius, &exponent);  // in [0.5, 1)
    return std::ldexp(*std::lower_bound(rungs.begin(), rungs.end(), fraction), exponent);
}

}  // namespace talus
