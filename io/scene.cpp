#include "io/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "io/scene_tree.hpp"
#include "io/spelling.hpp"

namespace talus {
namespace {

/// Reports every value of `node` that nobody read.
void find_unread(SceneState& state, const SceneNode& node, const std::string& path) {
    const auto known = state.known.find(path);
    static const std::set<std::string> none;
    const std::set<std::string>& keys = known == state.known.end() ? none : known->second;
    for (const auto& [key, child] : *node.table()) {
        const std::string full = joined_path(path, key);
        if (child.read && child.table()) {
            if (state.known.contains(full)) find_unread(state, child, full);
        } else if (child.read && child.is_array_of_tables()) {
            for (std::size_t k = 0; k < child.array()->size(); ++k)
                if ((*child.array())[k].table())
                    find_unread(state, (*child.array())[k], fmt::format("{}[{}]", full, k));
        } else if (!child.read) {
            std::string hint;
            if (keys.contains(key)) {
                hint = "not used with the other choices of this scene";
            } else if (const std::string nearest = nearest_spelling(key, keys); !nearest.empty()) {
                hint = fmt::format("unknown key; did you mean {}?", joined_path(path, nearest));
            } else {
                std::string others;
                for (const std::string& other : keys) others += (others.empty() ? "" : ", ") + other;
                hint = others.empty() ? "unknown key" : fmt::format("unknown key; allowed here: {}", others);
            }
            state.faults.push_back(
                {child.order, fmt::format("{}: {} = {} ({})", child.origin, full, child.found(), hint)});
        }
    }
}

/// [quick] is not looked into in an ordinary run, but a misspelt table in it should not wait for a quick one.
void check_quick(SceneState& state) {
    if (state.is_quick || !state.quick.table()) return;
    const std::set<std::string>& keys = state.known[""];
    for (const auto& [key, child] : *state.quick.table()) {
        if (keys.contains(key)) continue;
        const std::string nearest = nearest_spelling(key, keys);
        state.faults.push_back(
            {child.order, fmt::format("{}: quick.{} (unknown key{})", child.origin, key,
                                      nearest.empty() ? "" : "; did you mean quick." + nearest + "?")});
    }
}

void write_resolved(const ResolvedTable& table, const std::string& path, std::string& text) {
    for (const auto& [key, value] : table.entries) text += fmt::format("{} = {}\n", key, value);
    for (std::size_t k = 0; k < table.tables.size(); ++k) {
        const std::string& name = table.names[k];
        const ResolvedTable& child = table.tables[k];
        const auto bracket = name.find('[');
        const std::string full = joined_path(path, name.substr(0, bracket));
        if (bracket != std::string::npos)
            text += fmt::format("\n[[{}]]\n", full);
        else if (!child.entries.empty())
            text += fmt::format("\n[{}]\n", full);
        write_resolved(child, full, text);
    }
}

}  // namespace

void SceneState::know(std::string_view path, std::string_view key) {
    auto found = known.find(path);
    if (found == known.end()) found = known.emplace(std::string(path), std::set<std::string>()).first;
    found->second.emplace(key);
}

void SceneState::resolve(std::string_view path, std::string_view key, std::string value,
                         std::string_view comment) {
    ResolvedTable* table = &resolved;
    for (const std::string& part : path.empty() ? std::vector<std::string>() : split_path(path)) {
        const auto found = std::find(table->names.begin(), table->names.end(), part);
        const auto k = static_cast<std::size_t>(found - table->names.begin());
        if (found == table->names.end()) {
            table->names.push_back(part);
            table->tables.emplace_back();
        }
        table = &table->tables[k];
    }
    if (!comment.empty()) value += fmt::format("  # {}", comment);
    for (auto& [known_key, known_value] : table->entries)
        if (known_key == key) return;
    table->entries.emplace_back(key, std::move(value));
}

Scene::Scene(std::unique_ptr<SceneState> state) : state_(std::move(state)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

std::filesystem::path Scene::file_of(const std::filesystem::path& file_or_folder) {
    std::error_code failure;
    return std::filesystem::is_directory(file_or_folder, failure) ? file_or_folder / "scene.toml"
                                                                  : file_or_folder;
}

std::string Scene::read_text(const std::filesystem::path& file) {
    std::error_code failure;
    if (!std::filesystem::exists(file, failure))
        throw SceneError(fmt::format("{}: no such file", file.string()));
    std::ifstream stream(file, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(stream)), {});
    if (!stream || std::filesystem::is_directory(file, failure))
        throw SceneError(fmt::format("{}: cannot be read", file.string()));
    return text;
}

Scene Scene::read(const std::filesystem::path& file_or_folder, bool quick,
                  const std::vector<std::string>& overrides) {
    const std::filesystem::path file = file_of(file_or_folder);
    return parse(read_text(file), file, quick, overrides);
}

Scene Scene::parse(std::string text, const std::filesystem::path& file, bool quick,
                   const std::vector<std::string>& overrides) {
    auto state = std::make_unique<SceneState>();
    state->file = file;
    state->text = std::move(text);
    state->is_quick = quick;
    state->root = parse_toml(state->text, file.string());
    state->root.origin = file.string();
    state->root.order = 0;
    if (const auto found = state->root.table()->find("quick"); found != state->root.table()->end()) {
        state->quick = std::move(found->second);
        state->root.table()->erase(found);
        if (!state->quick.table())
            throw SceneError(
                fmt::format("{}: quick = {} (not a table; allowed: [quick] with keys that "
                            "override others)",
                            state->quick.origin, state->quick.found()));
        if (quick) merge(state->root, state->quick);
    } else if (quick) {
        throw SceneError(fmt::format(
            "{}: quick (missing; there is no table [quick] with keys that override others)", file.string()));
    }
    long order = std::numeric_limits<long>::max() / 2;  // after all lines
    for (const std::string& assignment : overrides) apply_override(state->root, assignment, order++);
    return Scene(std::move(state));
}

Section Scene::root() const { return Section(state_.get(), &state_->root, ""); }
const std::string& Scene::text() const { return state_->text; }
const std::filesystem::path& Scene::file() const { return state_->file; }

bool Scene::faulty() const { return !state_->faults.empty(); }

void Scene::finish() const {
    SceneState checked = *state_;
    find_unread(checked, checked.root, "");
    check_quick(checked);
    if (checked.faults.empty()) return;
    std::stable_sort(checked.faults.begin(), checked.faults.end(),
                     [](const SceneFault& a, const SceneFault& b) { return a.order < b.order; });
    std::string message;
    for (const SceneFault& one : checked.faults) message += (message.empty() ? "" : "\n") + one.message;
    throw SceneError(message);
}

std::string Scene::resolved() const {
    std::string text =
        fmt::format("# {}, as understood: SI units, defaults included\n", state_->file.string());
    write_resolved(state_->resolved, "", text);
    return text;
}

}  // namespace talus
