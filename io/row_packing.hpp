#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "domain/particles.hpp"

namespace talus {

/// Rows with all components of one particle side by side, for the particles of `order`.
std::vector<std::byte> pack_rows(const Column& column, std::span<const std::uint32_t> order);

/// The reverse: rows become the particles of the column from `first` on.
void unpack_rows(std::span<const std::byte> rows, Column& column, std::size_t first);

}  // namespace talus
