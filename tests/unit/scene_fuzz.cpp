#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "domain/random.hpp"
#include "io/agree.hpp"
#include "src/run/families.hpp"

/// Scenes that are spoilt at random are refused as scenes, whatever is wrong with them.
namespace talus {
namespace {

/// Random choices that depend on a number alone.
class Dice {
  public:
    explicit Dice(std::uint64_t id) : id_(id) {}
    std::size_t below(std::size_t count) {
        constexpr RandomStream stream{.seed = 11};
        return static_cast<std::size_t>(stream.uniform(id_, draw_++) * static_cast<double>(count));
    }

  private:
    std::uint64_t id_;
    std::uint32_t draw_ = 0;
};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

/// One to three changes: a line lost, doubled or moved, a value replaced by another that fits worse, a byte
/// changed.
std::string spoilt(const std::string& text, Dice dice) {
    static constexpr std::array values{"0",          "-1",    "1e308",     "-1e-308",   "nan",
                                       "inf",        "true",  "\"\"",      "[]",        "\"9 m\"",
                                       "\"1e9 kg\"", "[1]",   "{}",        "[0, 0, 0]", "99999999999",
                                       "\"box\"",    "[[1]]", "1979-05-27"};
    std::vector<std::string> lines = lines_of(text);
    for (std::size_t changes = 1 + dice.below(3); changes > 0 && !lines.empty(); --changes) {
        const std::size_t at = dice.below(lines.size());
        std::string& line = lines[at];
        switch (dice.below(5)) {
            case 0:
                lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
                break;
            case 1:
                lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(dice.below(lines.size())),
                             std::string(line));
                break;
            case 2:
                if (!line.empty()) line[dice.below(line.size())] = static_cast<char>(1 + dice.below(255));
                break;
            default:
                if (const std::size_t equals = line.find('='); equals != std::string::npos)
                    line = line.substr(0, equals + 2) + values[dice.below(values.size())];
        }
    }
    std::string result;
    for (const std::string& line : lines) result += line + '\n';
    return result;
}

TEST(SpoiltScenes, AreRefusedAsScenesOrUnderstood) {
    const Communicator alone(MPI_COMM_SELF);
    constexpr std::uint64_t tries = 60;  // a scene
    std::uint64_t id = 0, refused = 0, understood = 0;
    std::vector<std::filesystem::path> scenes;
    for (const auto& folder : std::filesystem::directory_iterator(TALUS_SOURCE_DIR "/runs"))
        if (std::filesystem::exists(folder.path() / "scene.toml"))
            scenes.push_back(folder.path() / "scene.toml");
    std::sort(scenes.begin(), scenes.end());
    for (const std::filesystem::path& file : scenes) {
        std::string text = Scene::read_text(file);
        for (std::size_t glass; (glass = text.find("\"glass\"")) != std::string::npos;)
            text.replace(glass, 7, "\"cubic\"");  // a glass takes seconds to relax
        for (std::uint64_t k = 0; k < tries; ++k, ++id) {
            const std::string other = spoilt(text, Dice(id));
            const auto began = std::chrono::steady_clock::now();
            const std::string what = fmt::format("{}, try {}:\n{}", file.string(), id, other);
            try {
                const Scene scene = Scene::parse(other, file);
                read_evolution(alone, scene, {});
                ++understood;
            } catch (const SceneError& error) {
                EXPECT_FALSE(std::string(error.what()).empty());
                ++refused;
            } catch (const AgreedError&) {
                ++refused;
            } catch (const std::exception& error) {
                ADD_FAILURE() << error.what() << " in " << what;
            }
            EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(), 20)
                << what;
        }
    }
    EXPECT_GT(refused, id / 4);
    EXPECT_GT(understood, id / 10);
}

}  // namespace
}  // namespace talus
