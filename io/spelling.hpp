#pragma once
#include <cstddef>
#include <set>
#include <string>
#include <string_view>

namespace talus {

/// Damerau-Levenshtein distance (optimal string alignment): insertions, deletions, replacements and swaps of
/// neighbours that make one word the other.
std::size_t spelling_distance(std::string_view a, std::string_view b);

/// The word of `known` that `word` was most likely meant to be; empty if none is near.
std::string nearest_spelling(std::string_view word, const std::set<std::string>& known);

}  // namespace talus
