#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "domain/particles.hpp"

namespace talus {

/// Rows with all components of one particle side by side, for the particles of `order`.
std::vector<std::byte> pack_rows(const Column& column, std::span<const std::uint32_t> order);

/// The reverse: rows become particles [0, rows) of the column.
void unpack_rows(std::span<const std::byte> rows, Column& column);

}  // namespace talus
