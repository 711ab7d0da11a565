#include "io/row_packing.hpp"

#include <cstring>

namespace talus {

std::vector<std::byte> pack_rows(const Column& column, std::span<const std::uint32_t> order) {
    const std::size_t value = column.value_size();
    const std::size_t row = value * column.components.size();
    std::vector<std::byte> rows(order.size() * row);
    if (order.empty()) return rows;
    for (std::size_t c = 0; c < column.components.size(); ++c) {
        const std::byte* from = column.components[c].data();
        std::byte* to = rows.data() + c * value;
        for (const std::uint32_t particle : order) {
            std::memcpy(to, from + particle * value, value);
            to += row;
        }
    }
    return rows;
}

void unpack_rows(std::span<const std::byte> rows, Column& column, std::size_t first) {
    const std::size_t value = column.value_size();
    const std::size_t row = value * column.components.size();
    if (rows.empty()) return;
    for (std::size_t c = 0; c < column.components.size(); ++c) {
        std::byte* to = column.components[c].data() + first * value;
        for (std::size_t at = c * value; at < rows.size(); at += row, to += value)
            std::memcpy(to, rows.data() + at, value);
    }
}

}  // namespace talus
