#include <fmt/format.h>
#include <toml++/toml.h>

#include <charconv>
#include <cmath>

#include "io/scene_tree.hpp"

namespace talus {
namespace {

/// Turns toml++ nodes into ours; `origin` makes the place of a node from its line.
template <class Origin>
SceneNode converted(const toml::node& node, const Origin& origin) {
    SceneNode made;
    made.order = static_cast<long>(node.source().begin.line);
    made.origin = origin(made.order);
    if (const auto* table = node.as_table()) {
        SceneTable children;
        for (const auto& [key, child] : *table) {
            SceneNode value = converted(child, origin);
            // A value may begin lines below its key, and an implicit table has no line of its own.
            if (key.source().begin.line > 0 && !value.array()) {
                value.order = static_cast<long>(key.source().begin.line);
                value.origin = origin(value.order);
            }
            children.emplace(std::string(key.str()), std::move(value));
        }
        made.value = std::move(children);
    } else if (const auto* array = node.as_array()) {
        SceneArray elements;
        for (const toml::node& element : *array) elements.push_back(converted(element, origin));
        if (!elements.empty() && elements.front().table()) {
            made.order = elements.front().order;
            made.origin = elements.front().origin;
        }
        made.value = std::move(elements);
    } else if (const auto* text = node.as_string()) {
        made.value = text->get();
    } else if (const auto* whole = node.as_integer()) {
        made.value = whole->get();
    } else if (const auto* real = node.as_floating_point()) {
        made.value = real->get();
    } else if (const auto* truth = node.as_boolean()) {
        made.value = truth->get();
    } else {
        throw SceneError(fmt::format("{}: dates and times are not used in scenes; write a text or a number",
                                     origin(made.order)));
    }
    return made;
}

SceneNode parse_value(std::string_view text, const std::string& origin, long order) {
    const auto at = [&](long) { return origin; };
    const auto set_order = [&](auto&& self, SceneNode& node) -> void {
        node.order = order;
        if (SceneTable* table = node.table())
            for (auto& [key, child] : *table) self(self, child);
        if (SceneArray* array = node.array())
            for (SceneNode& child : *array) self(self, child);
    };
    SceneNode made;
    try {
        const toml::table document = toml::parse(fmt::format("value = {}", text));
        if (document.size() == 1) made = converted(*document.get("value"), at);
    } catch (const toml::parse_error&) {
    }
    if (std::holds_alternative<std::monostate>(made.value)) made.value = std::string(text);  // bare words
    made.origin = origin;
    set_order(set_order, made);
    return made;
}

std::string_view without_spaces(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

/// "body[2]" to "body" and 2, "body" to "body" and -1; -2 if the index is not a number.
std::pair<std::string, long> split_index(const std::string& part) {
    const auto bracket = part.find('[');
    if (bracket == std::string::npos) return {part, -1};
    long index = -2;
    const char* const last = part.data() + part.size() - 1;
    const auto [end, failure] = std::from_chars(part.data() + bracket + 1, last, index);
    if (failure != std::errc() || end != last || *last != ']' || index < 0) index = -2;
    return {part.substr(0, bracket), index};
}

}  // namespace

SceneNode parse_toml(std::string_view text, const std::string& file) {
    try {
        const toml::table document = toml::parse(text, file);
        return converted(document, [&](long line) { return fmt::format("{}:{}", file, line); });
    } catch (const toml::parse_error& failure) {
        throw SceneError(fmt::format("{}:{}:{}: {}", file, failure.source().begin.line,
                                     failure.source().begin.column, failure.description()));
    }
}

std::vector<std::string> split_path(std::string_view path) {
    std::vector<std::string> parts;
    while (true) {
        const auto dot = path.find('.');
        parts.emplace_back(path.substr(0, dot));
        if (dot == std::string_view::npos) return parts;
        path.remove_prefix(dot + 1);
    }
}

std::string joined_path(std::string_view path, std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

void apply_override(SceneNode& root, std::string_view assignment, long order) {
    const auto equals = assignment.find('=');
    const std::string path(without_spaces(assignment.substr(0, equals)));
    const std::string origin = fmt::format("--set {}", path);
    if (equals == std::string_view::npos || path.empty())
        throw SceneError(fmt::format("--set {}: expected key.path=value", assignment));
    SceneNode value = parse_value(without_spaces(assignment.substr(equals + 1)), origin, order);

    SceneNode* node = &root;
    for (const std::string& part : split_path(path)) {
        const auto [key, index] = split_index(part);
        if (key.empty() || index == -2) throw SceneError(fmt::format("{}: '{}' is not a key", origin, part));
        if (!node->table()) {
            node->value = SceneTable();
            node->origin = origin;
            node->order = order;
        }
        node = &(*node->table())[key];
        if (index < 0) continue;
        SceneArray* array = node->array();
        if (array == nullptr || static_cast<std::size_t>(index) >= array->size())
            throw SceneError(fmt::format("{}: the scene has no element {} ({} holds {})", origin, part, key,
                                         array == nullptr ? 0 : array->size()));
        node = &(*array)[static_cast<std::size_t>(index)];
    }
    *node = std::move(value);
}

void merge(SceneNode& into, const SceneNode& from) {
    if (into.table() && from.table()) {
        for (const auto& [key, child] : *from.table()) merge((*into.table())[key], child);
    } else if (into.is_array_of_tables() && from.is_array_of_tables()) {
        for (std::size_t k = 0; k < from.array()->size(); ++k) {
            if (k < into.array()->size())
                merge((*into.array())[k], (*from.array())[k]);
            else
                into.array()->push_back((*from.array())[k]);
        }
    } else {
        into = from;
    }
}

std::string toml_text(std::string_view text) {
    std::string made(1, '"');
    for (const char c : text) {
        if (c == '"' || c == '\\')
            made += std::string{'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            made += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
        else
            made += c;
    }
    return made + '"';
}

std::string toml_number(double value) {
    if (std::isnan(value)) return "nan";
    return fmt::format("{}", value);
}

bool SceneNode::is_array_of_tables() const {
    const SceneArray* elements = array();
    return elements != nullptr && !elements->empty() && elements->front().table() != nullptr;
}

namespace {

std::string written(const SceneNode& node) {
    if (const auto* truth = std::get_if<bool>(&node.value)) return fmt::format("{}", *truth);
    if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return fmt::format("{}", *whole);
    if (const auto* real = std::get_if<double>(&node.value)) return toml_number(*real);
    if (const auto* words = std::get_if<std::string>(&node.value)) return toml_text(*words);
    if (node.is_array_of_tables()) return "an array of tables";
    if (const SceneArray* elements = node.array()) {
        std::vector<std::string> parts;
        for (const SceneNode& element : *elements) parts.push_back(written(element));
        return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    return "a table";
}

}  // namespace

std::string SceneNode::found() const {
    constexpr std::size_t longest = 60;
    const std::string text = written(*this);
    return text.size() <= longest ? text : fmt::format("{}...", text.substr(0, longest - 3));
}

}  // namespace talus
