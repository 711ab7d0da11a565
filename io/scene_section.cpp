#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/scene.hpp"
#include "io/scene_tree.hpp"
#include "io/spelling.hpp"
#include "io/units.hpp"

namespace talus {
namespace {

std::string wanted_number(std::string_view unit) {
    if (unit == "1") return "a number";
    return fmt::format("a number in {}, or text with a unit", unit);
}

std::string allowed(const Range& range, std::string_view unit) {
    const std::string suffix = unit == "1" ? "" : fmt::format(" {}", unit);
    std::string words;
    if (std::isfinite(range.min))
        words = fmt::format("{} {}{}", range.min_excluded ? "more than" : "at least", range.min, suffix);
    if (std::isfinite(range.max))
        words += fmt::format("{}at most {}{}", words.empty() ? "" : " and ", range.max, suffix);
    return words;
}

bool inside(double value, const Range& range) {
    return (range.min_excluded ? value > range.min : value >= range.min) && value <= range.max;
}

template <class Values, class Write>
std::string listed(const Values& values, const Write& write) {
    std::string made = "[";
    for (const auto& value : values) made += (made.size() > 1 ? ", " : "") + write(value);
    return made + "]";
}

/// And all below it.
void mark_read(SceneNode& node) {
    node.read = true;
    if (SceneTable* table = node.table())
        for (auto& [key, child] : *table) mark_read(child);
    if (SceneArray* array = node.array())
        for (SceneNode& child : *array) mark_read(child);
}

std::string comment_of(const SceneNode* found, std::string_view unit) {
    std::string comment(unit == "1" ? "" : unit);
    const auto add = [&](std::string_view words) {
        comment += (comment.empty() ? "" : ", ") + std::string(words);
    };
    if (found == nullptr) add("default");
    if (found != nullptr && found->origin.starts_with("--set")) add("from --set");
    return comment;
}

}  // namespace

std::string Section::path_of(std::string_view key) const { return joined_path(path_, key); }

SceneNode* Section::find(std::string_view key) const {
    state_->know(path_, key);
    if (node_ == nullptr || !node_->table()) return nullptr;
    const auto found = node_->table()->find(key);
    return found == node_->table()->end() ? nullptr : &found->second;
}

void Section::fault(std::string_view key, const SceneNode& found, std::string_view why) const {
    state_->faults.push_back(
        {found.order, fmt::format("{}: {} = {} ({})", found.origin, path_of(key), found.found(), why)});
}

void Section::missing(std::string_view key, std::string_view wanted) const {
    const std::string place = node_ == nullptr ? state_->file.string() : node_->origin;
    state_->faults.push_back({node_ == nullptr ? 0 : node_->order,
                              fmt::format("{}: {} (missing; allowed: {})", place, path_of(key), wanted)});
}

void Section::error(std::string_view key, std::string_view message) const {
    if (SceneNode* found = key.empty() ? nullptr : find(key)) {
        found->read = true;  // one fault is enough
        fault(key, *found, message);
        return;
    }
    const std::string place = node_ == nullptr ? state_->file.string() : node_->origin;
    const std::string what = key.empty() ? path_ : path_of(key);
    state_->faults.push_back(
        {node_ == nullptr ? 0 : node_->order, fmt::format("{}: {} ({})", place, what, message)});
}

void Section::ignore(std::string_view key) const {
    if (SceneNode* found = find(key)) mark_read(*found);
}

bool Section::has(std::string_view key) const { return find(key) != nullptr; }

double Section::number_in(const SceneNode& value, std::string_view key, std::string_view unit,
                          Range range) const {
    const double harmless = inside(1, range) ? 1 : (std::isfinite(range.max) ? range.max : range.min);
    double number = 0;
    if (const auto* whole = std::get_if<std::int64_t>(&value.value)) {
        number = static_cast<double>(*whole);
    } else if (const auto* real = std::get_if<double>(&value.value)) {
        number = *real;
    } else if (const auto* words = std::get_if<std::string>(&value.value)) {
        try {
            number = convert_to_si(*words, unit);
        } catch (const UnitError& failure) {
            fault(key, value, failure.what());
            return harmless;
        }
    } else {
        fault(key, value, "not a number; allowed: " + wanted_number(unit));
        return harmless;
    }
    if (!std::isfinite(number)) {
        fault(key, value, "not finite; allowed: " + wanted_number(unit));
        return harmless;
    }
    if (!inside(number, range)) {
        const std::string side = number > range.max ? "too large" : "too small";
        fault(key, value, fmt::format("{}; allowed: {}", side, allowed(range, unit)));
        return harmless;
    }
    return number;
}

double Section::number(std::string_view key, std::string_view unit, std::optional<double> default_value,
                       Range range) const {
    SceneNode* found = find(key);
    double value = default_value.value_or(inside(1, range) ? 1 : range.min);
    if (found != nullptr) {
        found->read = true;
        value = number_in(*found, key, unit, range);
    } else if (!default_value) {
        missing(key, wanted_number(unit));
        return value;
    }
    state_->resolve(path_, key, toml_number(value), comment_of(found, unit));
    return value;
}

std::int64_t Section::integer(std::string_view key, std::optional<std::int64_t> default_value,
                              std::int64_t min, std::int64_t max) const {
    SceneNode* found = find(key);
    std::int64_t value = default_value.value_or(std::clamp<std::int64_t>(1, min, max));
    if (found != nullptr) {
        found->read = true;
        constexpr double exact = 9007199254740992.0;  // 2^53: whole numbers beyond are not all doubles
        const auto* whole = std::get_if<std::int64_t>(&found->value);
        const auto* real = std::get_if<double>(&found->value);
        if (whole == nullptr && (real == nullptr || std::trunc(*real) != *real || std::abs(*real) > exact)) {
            fault(key, *found, "not a whole number");
            return value;
        }
        const std::int64_t given = whole != nullptr ? *whole : static_cast<std::int64_t>(*real);
        if (given < min || given > max) {
            constexpr auto unlimited = std::numeric_limits<std::int64_t>::max();
            const std::string upper = max == unlimited ? "" : fmt::format(" and at most {}", max);
            fault(key, *found,
                  fmt::format("too {}; allowed: at least {}{}", given < min ? "small" : "large", min, upper));
            return value;
        }
        value = given;
    } else if (!default_value) {
        missing(key, "a whole number");
        return value;
    }
    state_->resolve(path_, key, fmt::format("{}", value), comment_of(found, "1"));
    return value;
}

bool Section::flag(std::string_view key, std::optional<bool> default_value) const {
    SceneNode* found = find(key);
    bool value = default_value.value_or(false);
    if (found != nullptr) {
        found->read = true;
        const auto* truth = std::get_if<bool>(&found->value);
        if (truth == nullptr) {
            fault(key, *found, "not a truth value; allowed: true, false");
            return value;
        }
        value = *truth;
    } else if (!default_value) {
        missing(key, "true, false");
        return value;
    }
    state_->resolve(path_, key, value ? "true" : "false", comment_of(found, "1"));
    return value;
}

std::string Section::text(std::string_view key, const std::optional<std::string>& default_value) const {
    SceneNode* found = find(key);
    std::string value = default_value.value_or("");
    if (found != nullptr) {
        found->read = true;
        const auto* words = std::get_if<std::string>(&found->value);
        if (words == nullptr) {
            fault(key, *found, "not a text; allowed: a text in quotes");
            return value;
        }
        value = *words;
    } else if (!default_value) {
        missing(key, "a text");
        return value;
    }
    state_->resolve(path_, key, toml_text(value), comment_of(found, "1"));
    return value;
}

std::string Section::choice(std::string_view key, std::initializer_list<std::string_view> words,
                            const std::optional<std::string>& default_value) const {
    std::string list;
    for (const std::string_view word : words) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", word);
    SceneNode* found = find(key);
    std::string value = default_value.value_or(std::string(*words.begin()));
    if (found != nullptr) {
        found->read = true;
        const auto* given = std::get_if<std::string>(&found->value);
        if (given == nullptr || std::find(words.begin(), words.end(), *given) == words.end()) {
            std::string nearest;
            if (given != nullptr)
                nearest = nearest_spelling(*given, std::set<std::string>(words.begin(), words.end()));
            const std::string hint = nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest);
            fault(key, *found, fmt::format("not a choice{}; allowed: {}", hint, list));
            return value;
        }
        value = *given;
    } else if (!default_value) {
        missing(key, list);
        return value;
    }
    state_->resolve(path_, key, toml_text(value), comment_of(found, "1"));
    return value;
}

std::vector<double> Section::numbers(std::string_view key, std::string_view unit, std::size_t count,
                                     const std::optional<std::vector<double>>& default_value) const {
    SceneNode* found = find(key);
    std::vector<double> values = default_value.value_or(std::vector<double>(count, 1.0));
    const std::string wanted =
        fmt::format("[{} of {}]", count == 0 ? "any number" : std::to_string(count), wanted_number(unit));
    if (found != nullptr) {
        found->read = true;
        const SceneArray* elements = found->array();
        if (elements == nullptr || (count != 0 && elements->size() != count)) {
            fault(
                key, *found,
                fmt::format("{}; allowed: {}", elements == nullptr ? "not an array" : "wrong count", wanted));
            return values;
        }
        values.clear();
        for (std::size_t k = 0; k < elements->size(); ++k)
            values.push_back(number_in((*elements)[k], fmt::format("{}[{}]", key, k), unit, {}));
    } else if (!default_value) {
        missing(key, wanted);
        return values;
    }
    state_->resolve(path_, key, listed(values, toml_number), comment_of(found, unit));
    return values;
}

std::vector<std::string> Section::texts(std::string_view key, std::size_t count,
                                        const std::optional<std::vector<std::string>>& default_value) const {
    SceneNode* found = find(key);
    std::vector<std::string> values = default_value.value_or(std::vector<std::string>(count));
    const std::string wanted =
        fmt::format("[{} texts in quotes]", count == 0 ? "any number of" : std::to_string(count));
    if (found != nullptr) {
        found->read = true;
        const SceneArray* elements = found->array();
        if (elements == nullptr || (count != 0 && elements->size() != count)) {
            fault(
                key, *found,
                fmt::format("{}; allowed: {}", elements == nullptr ? "not an array" : "wrong count", wanted));
            return values;
        }
        values.clear();
        for (std::size_t k = 0; k < elements->size(); ++k) {
            const auto* words = std::get_if<std::string>(&(*elements)[k].value);
            if (words == nullptr) fault(fmt::format("{}[{}]", key, k), (*elements)[k], "not a text");
            values.push_back(words == nullptr ? std::string() : *words);
        }
    } else if (!default_value) {
        missing(key, wanted);
        return values;
    }
    state_->resolve(path_, key, listed(values, toml_text), comment_of(found, "1"));
    return values;
}

Section Section::section(std::string_view key) const {
    SceneNode* found = find(key);
    if (found != nullptr) {
        if (!found->table() && !found->read)
            fault(key, *found, fmt::format("not a table; allowed: keys below [{}]", path_of(key)));
        found->read = true;
        if (!found->table()) found = nullptr;
    }
    state_->known.try_emplace(path_of(key));  // even if none of its keys is asked for
    return Section(state_, found, path_of(key));
}

std::vector<Section> Section::sections(std::string_view key) const {
    SceneNode* found = find(key);
    std::vector<Section> made;
    if (found == nullptr) return made;
    const bool first_time = !found->read;
    found->read = true;
    if (found->table()) {  // a lone table; an array of one keeps the paths uniform
        SceneNode lone = std::move(*found);
        found->origin = lone.origin;
        found->order = lone.order;
        found->value = SceneArray{std::move(lone)};
        found->read = true;
    }
    if (!found->is_array_of_tables() && !(found->array() && found->array()->empty())) {
        if (first_time)
            fault(key, *found, fmt::format("not an array of tables; allowed: [[{}]]", path_of(key)));
        return made;
    }
    SceneArray& elements = *found->array();
    for (std::size_t k = 0; k < elements.size(); ++k) {
        elements[k].read = true;
        if (elements[k].table())
            made.push_back(Section(state_, &elements[k], fmt::format("{}[{}]", path_of(key), k)));
        else if (first_time)
            fault(fmt::format("{}[{}]", key, k), elements[k], "not a table");
    }
    return made;
}

}  // namespace talus
