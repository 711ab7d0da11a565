#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/scene.hpp"

namespace talus {

/// Records a fault of the table if one of `others` has this name already: columns of results go by names.
template <class Item>
void refuse_same_name(const Section& table, const std::vector<Item>& others, const std::string& name) {
    const auto same = [&](const Item& other) { return other.name == name; };
    if (std::any_of(others.begin(), others.end(), same))
        table.error("name", fmt::format("there is another of the name '{}'", name));
}

}  // namespace talus
