#include "io/ascii_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace talus {

namespace {

constexpr std::string_view spaces = " \t\r\n";
constexpr float nothing = -9999;

/// Words of a text one after another, with the line they are in.
class Words {
  public:
    explicit Words(std::string_view text) : text_(text) {}

    std::size_t line() const { return line_; }

    /// The next word, empty at the end.
    std::string_view next() {
        while (at_ < text_.size() && spaces.find(text_[at_]) != spaces.npos) line_ += text_[at_++] == '\n';
        const std::size_t start = at_;
        at_ = std::min(text_.find_first_of(spaces, start), text_.size());
        return text_.substr(start, at_ - start);
    }

  private:
    std::string_view text_;
    std::size_t at_ = 0, line_ = 1;
};

std::optional<double> number(std::string_view word) {
    if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);
    double value = 0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (failure != std::errc() || end != word.data() + word.size()) return {};
    return value;
}

/// Keys before the values, in lower case.
struct Header {
    struct Key {
        std::string_view name;
        std::optional<double> value = {};
    };
    std::array<Key, 10> keys{{{"ncols"},
                              {"nrows"},
                              {"xllcorner"},
                              {"xllcenter"},
                              {"yllcorner"},
                              {"yllcenter"},
                              {"cellsize"},
                              {"dx"},
                              {"dy"},
                              {"nodata_value"}}};

    std::optional<double>& operator[](std::string_view name) {
        return std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; })
            ->value;
    }
    bool knows(std::string_view name) const {
        return std::any_of(keys.begin(), keys.end(), [&](const Key& key) { return key.name == name; });
    }
    /// One of two keys that exclude each other.
    double one_of(const char* one, const char* other) {
        if ((*this)[one].has_value() == (*this)[other].has_value())
            throw std::runtime_error(fmt::format("its header must have one of {} and {}", one, other));
        return (*this)[one] ? *(*this)[one] : *(*this)[other];
    }
    std::size_t count(const char* name) {
        const double value = (*this)[name].value_or(-1);
        if (!(value >= 2 && value <= 1e6 && value == std::floor(value)))
            throw std::runtime_error(
                fmt::format("its header must have {}, a whole number of at least 2", name));
        return static_cast<std::size_t>(value);
    }
    double size(const char* name) {
        const double value = (*this)[name] ? *(*this)[name] : (*this)["cellsize"].value_or(0);
        if (!(value > 0 && std::isfinite(value)))
            throw std::runtime_error("its header must have cellsize, or dx and dy, positive");
        return value;
    }
};

}  // namespace

TerrainGrid parse_ascii_grid(std::string_view text) {
    Words words(text);
    Header header;
    std::string_view word = words.next();
    for (; !word.empty() && !number(word); word = words.next()) {
        std::string key(word);
        std::transform(key.begin(), key.end(), key.begin(),
                       [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
        if (!header.knows(key))
            throw std::runtime_error(
                fmt::format("line {}: '{:.40}' is no key of an ESRI ASCII grid", words.line(), word));
        const std::string_view value = words.next();
        if (header[key])
            throw std::runtime_error(fmt::format("line {}: {} is given twice", words.line(), key));
        if (!(header[key] = number(value)))
            throw std::runtime_error(
                fmt::format("line {}: {} is '{:.40}', not a number", words.line(), key, value));
    }

    TerrainGrid grid;
    grid.columns = header.count("ncols");
    grid.rows = header.count("nrows");
    grid.spacing = {header.size("dx"), header.size("dy")};
    grid.origin = {header.one_of("xllcorner", "xllcenter"), header.one_of("yllcorner", "yllcenter")};
    if (header["xllcorner"]) grid.origin[0] += grid.spacing[0] / 2;
    if (header["yllcorner"]) grid.origin[1] += grid.spacing[1] / 2;
    const std::optional<double> nodata = header["nodata_value"];

    const std::size_t most = text.size() / 2 + 1;  // a digit and a space each
    if (grid.columns > most / grid.rows)
        throw std::runtime_error(fmt::format("its header says {} x {} values; its {} characters hold fewer",
                                             grid.columns, grid.rows, text.size()));
    grid.elevations.resize(grid.columns * grid.rows);
    for (std::size_t row = 0; row < grid.rows; ++row)
        for (std::size_t column = 0; column < grid.columns; ++column, word = words.next()) {
            if (word.empty())
                throw std::runtime_error(fmt::format("ends in row {} of {}, column {} of {}", row + 1,
                                                     grid.rows, column + 1, grid.columns));
            const std::optional<double> value = number(word);
            const bool is_nothing =
                value && nodata && (*value == *nodata || (std::isnan(*value) && std::isnan(*nodata)));
            if (!is_nothing && !(value && std::isfinite(*value)))
                throw std::runtime_error(fmt::format("line {}: '{:.40}' in column {}, row {} is not a number",
                                                     words.line(), word, column + 1, row + 1));
            grid.elevations[(grid.rows - 1 - row) * grid.columns + column] =
                is_nothing ? std::numeric_limits<double>::quiet_NaN() : *value;
        }
    if (!word.empty())
        throw std::runtime_error(fmt::format("line {}: '{:.40}' after the {} x {} values", words.line(), word,
                                             grid.columns, grid.rows));
    return grid;
}

std::string ascii_grid(const TerrainGrid& grid) {
    std::string text =
        fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\n", grid.columns, grid.rows,
                    grid.origin[0] - grid.spacing[0] / 2, grid.origin[1] - grid.spacing[1] / 2);
    if (grid.spacing[0] == grid.spacing[1])
        text += fmt::format("cellsize {}\n", grid.spacing[0]);
    else
        text += fmt::format("dx {}\ndy {}\n", grid.spacing[0], grid.spacing[1]);
    text += fmt::format("NODATA_value {}\n", nothing);
    for (std::size_t row = grid.rows; row-- > 0;)
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const auto value = static_cast<float>(grid.at(column, row));
            fmt::format_to(std::back_inserter(text), "{}{}", std::isfinite(value) ? value : nothing,
                           column + 1 < grid.columns ? ' ' : '\n');
        }
    return text;
}

}  // namespace talus
