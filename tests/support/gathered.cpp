#include "tests/support/gathered.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace talus::test {

GatheredState gather_state(const Communicator& comm, const ParticleSet& particles) {
    std::size_t row_bytes = 0;
    for (const Column& column : particles.columns())
        if (column.info->role == Role::state) row_bytes += column.components.size() * column.value_size();
    std::vector<std::byte> mine(particles.size() * row_bytes);
    std::byte* to = mine.data();
    for (std::size_t i = 0; i < particles.size(); ++i)
        for (const Column& column : particles.columns()) {
            if (column.info->role != Role::state) continue;
            for (const auto& component : column.components) {
                std::memcpy(to, component.data() + i * column.value_size(), column.value_size());
                to += column.value_size();
            }
        }
    const auto ids = comm.all_gather(particles.own(field::id));
    const auto bytes = comm.all_gather(std::span<const std::byte>(mine));
    std::vector<std::size_t> order(ids.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return ids[a] < ids[b]; });
    GatheredState state;
    for (const std::size_t k : order) {
        const auto row = bytes.begin() + static_cast<std::ptrdiff_t>(k * row_bytes);
        state.ids.push_back(ids[k]);
        state.rows.emplace_back(row, row + static_cast<std::ptrdiff_t>(row_bytes));
    }
    return state;
}

std::uint64_t state_hash(const Communicator& comm, const ParticleSet& particles) {
    std::uint64_t hash = 14695981039346656037u;
    for (const auto& row : gather_state(comm, particles).rows)
        for (const std::byte byte : row) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 1099511628211u;
    return hash;
}

void put_row(ParticleSet& particles, std::size_t i, const std::vector<std::byte>& row) {
    const std::byte* from = row.data();
    for (Column& column : particles.columns()) {
        if (column.info->role != Role::state) continue;
        for (auto& component : column.components) {
            std::memcpy(component.data() + i * column.value_size(), from, column.value_size());
            from += column.value_size();
        }
    }
}

}  // namespace talus::test
