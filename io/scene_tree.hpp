#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "io/scene.hpp"

/// Inside of scenes, shared by scene.cpp and scene_parse.cpp.
namespace talus {

struct SceneNode;
using SceneTable = std::map<std::string, SceneNode, std::less<>>;
using SceneArray = std::vector<SceneNode>;

/// A value of the scene and where it was written.
struct SceneNode {
    std::variant<std::monostate, bool, std::int64_t, double, std::string, SceneArray, SceneTable> value;
    std::string origin;  ///< "scene.toml:12" or "--set run.end_time"
    long order = 0;      ///< line; overrides come after all lines
    bool read = false;

    SceneTable* table() { return std::get_if<SceneTable>(&value); }
    const SceneTable* table() const { return std::get_if<SceneTable>(&value); }
    SceneArray* array() { return std::get_if<SceneArray>(&value); }
    const SceneArray* array() const { return std::get_if<SceneArray>(&value); }
    /// A non-empty array of tables only.
    bool is_array_of_tables() const;
    /// As one would write it in the file; long ones are shortened.
    std::string found() const;
};

struct SceneFault {
    long order;
    std::string message;
};

/// What was read, in order, as a tree of tables, for Scene::resolved().
struct ResolvedTable {
    std::vector<std::pair<std::string, std::string>> entries;  ///< key, "value  # unit, default"
    std::vector<std::string> names;                            ///< of the tables
    std::vector<ResolvedTable> tables;
};

struct SceneState {
    std::filesystem::path file;
    std::string text;
    SceneNode root;
    SceneNode quick;  ///< the table [quick], or monostate
    bool is_quick = false;
    std::vector<SceneFault> faults;
    std::map<std::string, std::set<std::string>, std::less<>>
        known;  ///< keys asked for, by path of the table
    ResolvedTable resolved;

    /// Notes that `key` of the table `path` is a key of scenes.
    void know(std::string_view path, std::string_view key);
    /// Notes the effective value of a key, written as TOML.
    void resolve(std::string_view path, std::string_view key, std::string value, std::string_view comment);
};

/// TOML to tree. Throws SceneError on a syntax error.
SceneNode parse_toml(std::string_view text, const std::string& file);
/// Applies "key.path=value". Throws SceneError if it has not that form.
void apply_override(SceneNode& root, std::string_view assignment, long order);
/// Values of `from` replace those of `into`, table by table, arrays of tables element by element.
void merge(SceneNode& into, const SceneNode& from);
/// "a.b[2].c" to its parts "a", "b[2]", "c".
std::vector<std::string> split_path(std::string_view path);
/// "a.b" and "c" to "a.b.c".
std::string joined_path(std::string_view path, std::string_view key);
/// A text as a TOML string.
std::string toml_text(std::string_view text);
/// A number as TOML, shortest form that reads back to the same bits.
std::string toml_number(double value);

}  // namespace talus
