#include "domain/particles.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace talus {

ParticleSet::ParticleSet(std::string name, int dimension) : name_(std::move(name)), dimension_(dimension) {
    add(field::id);
    add(field::position);
}

const Column* ParticleSet::find(const FieldInfo& info) const {
    for (const Column& column : columns_)
        if (column.info == &info) return &column;
    return nullptr;
}

Column& ParticleSet::column(const FieldInfo& info) {
    return const_cast<Column&>(std::as_const(*this).column(info));
}

const Column& ParticleSet::column(const FieldInfo& info) const {
    if (const Column* found = find(info)) return *found;
    throw std::logic_error(fmt::format("particle set '{}' has no field '{}'", name_, info.name));
}

void ParticleSet::add(const FieldInfo& info, int profile_size) {
    if (has(info)) return;
    Column column{&info, {}};
    const std::size_t count = info.reach == Reach::halo ? size_with_halo() : size_;
    const int components =
        info.shape == Shape::profile ? profile_size : component_count(info.shape, dimension_);
    column.components.assign(static_cast<std::size_t>(components),
                             StaggeredVector<std::byte>(count * size_of(info.type)));
    columns_.push_back(std::move(column));
}

namespace {
/// Room to grow is a sixteenth, not as much again as std::vector takes.
void resize_with_room(StaggeredVector<std::byte>& values, std::size_t bytes) {
    if (bytes > values.capacity()) values.reserve(values.empty() ? bytes : bytes + bytes / 16);
    values.resize(bytes);
}
}  // namespace

void ParticleSet::resize(std::size_t size) {
    size_ = size;
    halo_size_ = 0;
    for (Column& column : columns_)
        for (auto& component : column.components) resize_with_room(component, size * column.value_size());
}

void ParticleSet::set_halo_size(std::size_t halo_size) {
    halo_size_ = halo_size;
    for (Column& column : columns_) {
        if (column.info->reach != Reach::halo) continue;
        for (auto& component : column.components)
            resize_with_room(component, size_with_halo() * column.value_size());
    }
}

namespace {
template <class T>
void gather(std::span<const std::uint32_t> order, const std::byte* from, std::byte* to) {
    const T* source = reinterpret_cast<const T*>(from);
    T* target = reinterpret_cast<T*>(to);
    for (std::size_t k = 0; k < order.size(); ++k) target[k] = source[order[k]];
}
}  // namespace

void ParticleSet::reorder(std::span<const std::uint32_t> order) {
    for (Column& column : columns_) {
        const std::size_t value_size = column.value_size();
        for (auto& component : column.components) {
            if (column.info->role == Role::state) {
                reorder_buffer_.resize(order.size() * value_size);
                switch (value_size) {
                    case 8:
                        gather<std::uint64_t>(order, component.data(), reorder_buffer_.data());
                        break;
                    case 4:
                        gather<std::uint32_t>(order, component.data(), reorder_buffer_.data());
                        break;
                    default:
                        gather<std::uint8_t>(order, component.data(), reorder_buffer_.data());
                        break;
                }
                std::swap(component, reorder_buffer_);
            } else {
                component.resize(order.size() * value_size);
            }
        }
    }
    size_ = order.size();
    halo_size_ = 0;
}

std::size_t ParticleSet::bytes_per_particle() const {
    std::size_t bytes = 0;
    for (const Column& column : columns_) bytes += column.components.size() * column.value_size();
    return bytes;
}

NotFinite find_not_finite(const ParticleSet& particles) {
    NotFinite found{0, nullptr};
    std::size_t first = particles.size();
    for (const Column& column : particles.columns()) {
        if (column.info->role != Role::state || column.info->type != ValueType::f64) continue;
        for (const auto& component : column.components) {
            const auto* values = reinterpret_cast<const double*>(component.data());
            double sum = 0;  // 0 unless a value is infinite or NaN
#pragma omp simd reduction(+ : sum)
            for (std::size_t i = 0; i < particles.size(); ++i) sum += values[i] * 0.0;
            if (sum == 0) continue;
            for (std::size_t i = 0; i < first; ++i)
                if (!std::isfinite(values[i])) {
                    first = i;
                    found = {particles.data(field::id)[i], column.info};
                }
        }
    }
    return found;
}

}  // namespace talus
