#pragma once
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// A scene that cannot be used: one line for every fault, `file:line: key = found (why; allowed: ...)`.
class SceneError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Values that a number may take.
struct Range {
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool min_excluded = false;
};

struct SceneState;
struct SceneNode;

/// One table of a scene, possibly absent (then every key has its default). Light to copy; must not outlive
/// its Scene. The first reading of a key fixes its default and unit in Scene::resolved(). Whatever is wrong
/// is recorded in the scene and a harmless value returned, so that Scene::finish() can report all at once.
class Section {
  public:
    /// Whether the scene says anything for `key`. Does not count as reading it.
    bool has(std::string_view key) const;
    /// Whether the table itself is in the scene.
    bool exists() const { return node_ != nullptr; }
    /// Dotted path, such as body[0].shape; empty for the root.
    const std::string& path() const { return path_; }

    /// A bare number is in `unit` (SI), a text is a number with a unit. Not finite is refused.
    double number(std::string_view key, std::string_view unit, std::optional<double> default_value = {},
                  Range range = {}) const;
    std::int64_t integer(std::string_view key, std::optional<std::int64_t> default_value = {},
                         std::int64_t min = std::numeric_limits<std::int64_t>::min(),
                         std::int64_t max = std::numeric_limits<std::int64_t>::max()) const;
    bool flag(std::string_view key, std::optional<bool> default_value = {}) const;
    std::string text(std::string_view key, const std::optional<std::string>& default_value = {}) const;
    /// One of `allowed`; returns the default or the first allowed word if the scene's is not.
    std::string choice(std::string_view key, std::initializer_list<std::string_view> allowed,
                       const std::optional<std::string>& default_value = {}) const;
    /// `count` numbers (0: any count), each like number().
    std::vector<double> numbers(std::string_view key, std::string_view unit, std::size_t count,
                                const std::optional<std::vector<double>>& default_value = {}) const;
    std::vector<std::string> texts(std::string_view key, std::size_t count,
                                   const std::optional<std::vector<std::string>>& default_value = {}) const;

    /// The table `key`; an absent one reads as empty.
    Section section(std::string_view key) const;
    /// The tables of the array of tables `key`, none if absent. A single table counts as an array of one.
    std::vector<Section> sections(std::string_view key) const;

    /// Lets nothing be told of what the scene says for `key`: for what is not read once something else is
    /// wrong.
    void ignore(std::string_view key) const;

    /// Records a fault the caller found, at the line of `key`, or of the table if the key is absent or empty.
    void error(std::string_view key, std::string_view message) const;

  private:
    friend class Scene;
    Section(SceneState* state, SceneNode* node, std::string path)
        : state_(state), node_(node), path_(std::move(path)) {}

    SceneNode* find(std::string_view key) const;
    std::string path_of(std::string_view key) const;
    void fault(std::string_view key, const SceneNode& found, std::string_view why) const;
    void missing(std::string_view key, std::string_view wanted) const;
    double number_in(const SceneNode& value, std::string_view key, std::string_view unit, Range range) const;

    SceneState* state_;
    SceneNode* node_;
    std::string path_;
};

/// A scene or material file (TOML). Keys are read through root(); finish() reports everything wrong.
class Scene {
  public:
    /// Reads `file_or_folder` (a folder means its scene.toml) and parses it. For one rank; let the root read
    /// the text with read_text() and broadcast it otherwise. Throws SceneError if there is no such file.
    static Scene read(const std::filesystem::path& file_or_folder, bool quick = false,
                      const std::vector<std::string>& overrides = {});
    /// The file that `file_or_folder` means.
    static std::filesystem::path file_of(const std::filesystem::path& file_or_folder);
    /// The text of a file. Throws SceneError if it cannot be read.
    static std::string read_text(const std::filesystem::path& file);
    /// `quick`: keys of the table [quick] override the others. `overrides`: "key.path=value" with a TOML
    /// value or bare words, stronger than [quick]. Throws SceneError on syntax errors, naming line and
    /// column, and if a scene without that table shall be quick.
    static Scene parse(std::string text, const std::filesystem::path& file, bool quick = false,
                       const std::vector<std::string>& overrides = {});

    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;
    ~Scene();

    Section root() const;
    /// Whether a fault was found so far: values may then be harmless ones that do not fit each other.
    bool faulty() const;
    /// Throws SceneError listing all faults in order of line, among them every key that nobody read.
    void finish() const;
    /// The file's text, verbatim.
    const std::string& text() const;
    const std::filesystem::path& file() const;
    /// Every key that was read with its effective value (defaults included) and unit, as TOML that reads
    /// back to the same values.
    std::string resolved() const;

  private:
    explicit Scene(std::unique_ptr<SceneState> state);
    std::unique_ptr<SceneState> state_;
};

}  // namespace talus
