#include "io/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace talus {
namespace {

struct UnitDeleter {
    void operator()(ut_unit* unit) const { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, UnitDeleter>;

/// The unit database, read once. It is not safe to be used by several threads at a time.
ut_system* unit_system() {
    struct Owner {
        ut_system* system = nullptr;
        Owner() {
            ut_set_error_message_handler(ut_ignore);
            system = ut_read_xml(nullptr);
            if (system == nullptr)
                throw UnitError("cannot read the UDUNITS-2 database (package libudunits2-data)");
            // "deg" is not in the database.
            const Unit degree(ut_parse(system, "degree", UT_UTF8));
            if (degree != nullptr) ut_map_name_to_unit("deg", UT_ASCII, degree.get());
        }
        ~Owner() { ut_free_system(system); }
        Owner(const Owner&) = delete;
        Owner& operator=(const Owner&) = delete;
    };
    static const Owner owner;
    return owner.system;
}

Unit parse_unit(std::string_view text) {
    return Unit(ut_parse(unit_system(), std::string(text).c_str(), UT_UTF8));
}

constexpr std::pair<std::string_view, std::string_view> dimension_names[] = {
    {"1", "pure number"},
    {"m", "length"},
    {"kg", "mass"},
    {"s", "time"},
    {"K", "temperature"},
    {"m s-1", "velocity"},
    {"m s-2", "acceleration"},
    {"kg m-3", "density"},
    {"Pa", "pressure"},
    {"J", "energy"},
    {"J kg-1", "energy per mass"},
    {"J kg-1 K-1", "heat capacity"},
    {"N", "force"},
    {"Pa s", "dynamic viscosity"},
    {"m2 s-1", "diffusivity"},
    {"s-1", "rate"},
    {"m2", "area"},
    {"m3", "volume"},
    {"m-3", "number per volume"},
    {"W", "power"},
    {"N m-1", "surface tension"},
};

std::string name_of(const ut_unit* unit) {
    for (const auto& [known, name] : dimension_names)
        if (ut_are_convertible(unit, parse_unit(known).get()) != 0) return std::string(name);
    return {};
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\n");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// k if a conversion multiplies by 10^k, to the rounding of UDUNITS' factors.
std::optional<int> power_of_ten(const cv_converter* converter) {
    const double factor = cv_convert_double(converter, 1);
    if (cv_convert_double(converter, 0) != 0 || !(factor > 0)) return {};
    const double exponent = std::round(std::log10(factor));
    if (std::abs(factor / std::pow(10.0, exponent) - 1) > 1e-12) return {};
    return static_cast<int>(exponent);
}

/// The double nearest to the number written in `digits` times 10^`power`: "50" and -6 make 5e-05, where the
/// product of the doubles 50 and 1e-6 is another. Nothing if it is beyond the doubles.
std::optional<double> shifted(std::string_view digits, int power) {
    const auto e = std::min(digits.find_first_of("eE"), digits.size());
    std::string_view exponent_text = digits.substr(std::min(e + 1, digits.size()));
    if (exponent_text.starts_with('+')) exponent_text.remove_prefix(1);
    int exponent = 0;
    std::from_chars(exponent_text.data(), exponent_text.data() + exponent_text.size(), exponent);
    const std::string text = fmt::format("{}e{}", digits.substr(0, e), exponent + power);
    double value = 0;
    if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc()) return {};
    return value;
}

std::string expectation(std::string_view si_unit) {
    const std::string name = dimension_name(si_unit);
    return name.empty() ? fmt::format("[{}]", si_unit) : fmt::format("{} [{}]", name, si_unit);
}

}  // namespace

std::string dimension_name(std::string_view si_unit) {
    if (si_unit == "rad") return "angle";
    const Unit unit = parse_unit(si_unit);
    return unit == nullptr ? std::string() : name_of(unit.get());
}

double convert_to_si(std::string_view text, std::string_view si_unit) {
    const Unit wanted = parse_unit(si_unit);
    if (wanted == nullptr) throw std::logic_error(fmt::format("'{}' is not a UDUNITS unit", si_unit));

    std::string_view rest = trimmed(text);
    if (rest.starts_with('+')) rest.remove_prefix(1);
    double value = 0;
    const auto [end, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (failure != std::errc() || !std::isfinite(value))
        throw UnitError(
            fmt::format("'{}' does not begin with a number; expected: {}", text, expectation(si_unit)));
    const std::string_view unit_text = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));

    const Unit found = parse_unit(unit_text.empty() ? "1" : unit_text);
    if (found == nullptr)
        throw UnitError(fmt::format("unknown unit '{}'; expected: {}", unit_text, expectation(si_unit)));
    if (ut_are_convertible(found.get(), wanted.get()) == 0) {
        if (unit_text.empty())
            throw UnitError(fmt::format("'{}' has no unit; expected: {}", text, expectation(si_unit)));
        const std::string dimension = name_of(found.get());
        throw UnitError(fmt::format("'{}' is {} {}; expected: {}", text, dimension.empty() ? "of" : "a",
                                    dimension.empty() ? "another dimension" : dimension,
                                    expectation(si_unit)));
    }
    const std::unique_ptr<cv_converter, decltype(&cv_free)> converter(
        ut_get_converter(found.get(), wanted.get()), &cv_free);
    if (converter == nullptr) throw UnitError(fmt::format("cannot convert '{}' to {}", text, si_unit));
    const std::optional<int> power = power_of_ten(converter.get());
    if (power)
        if (const auto exact = shifted(rest.substr(0, static_cast<std::size_t>(end - rest.data())), *power))
            return *exact;
    return cv_convert_double(converter.get(), value);
}

}  // namespace talus
