#include "src/setup/bond_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};

std::array<std::uint8_t, 2> read_pair(const Section& table, const std::vector<GrainBody>& bodies) {
    std::vector<std::size_t> places;
    const std::vector<std::string> names = table.texts("grains", 0);
    for (const std::string& name : names) {
        const auto found =
            std::find_if(bodies.begin(), bodies.end(), [&](const auto& body) { return body.name == name; });
        if (found == bodies.end())
            table.error("grains", fmt::format("no table [[grains]] has the name '{}'", name));
        else
            places.push_back(static_cast<std::size_t>(found - bodies.begin()));
    }
    if (names.empty() || names.size() > 2)
        table.error("grains", "allowed: the name of one body of grains, or of two");
    for (const std::size_t place : places)
        if (bodies[place].clump)
            table.error("grains", "spheres of clumps are not joined by bonds");
        else if (bodies[place].inserted)
            table.error("grains", fmt::format("'{}' is a source: grains are joined at the start only",
                                              bodies[place].name));
    if (places.empty()) return {};
    const auto [low, high] = std::minmax(places.front(), places.back());
    return {static_cast<std::uint8_t>(low), static_cast<std::uint8_t>(high)};
}

}  // namespace

std::vector<dem::BondRule> read_bonds(const Section& root, const std::vector<GrainBody>& bodies) {
    std::vector<dem::BondRule> rules;
    for (const Section& table : root.sections("bond")) {
        dem::BondRule rule{};
        rule.bodies = read_pair(table, bodies);
        for (const dem::BondRule& other : rules)
            if (other.bodies == rule.bodies)
                table.error("grains", "another table [[bond]] joins the same grains");
        rule.gap = table.number("gap", "1", 0.01, {0, 1});
        rule.radius_factor = table.number("radius_factor", "1", 1.0, {0, 1, true});
        rule.material.youngs_modulus = table.number("youngs_modulus", "Pa", {}, positive);
        rule.material.poisson_ratio = table.number("poisson_ratio", "1", {}, {-1, 0.5, true});
        if (table.has("tensile_strength"))
            rule.material.tensile_strength = table.number("tensile_strength", "Pa", {}, positive);
        if (table.has("shear_strength"))
            rule.material.shear_strength = table.number("shear_strength", "Pa", {}, positive);
        rule.material.damping_ratio = table.number("damping", "1", 0.0, {0});
        rule.material.shear_compliance =
            table.choice("beam", {"timoshenko", "euler_bernoulli"}, "timoshenko") == "timoshenko";
        rules.push_back(rule);
    }
    return rules;
}

double usual_step_of_bonds(const std::vector<dem::BondRule>& rules, const std::vector<GrainBody>& bodies) {
    constexpr double share = 0.3;
    constexpr int bonds_in_closest_packing = 12;
    double least = infinity;
    for (const dem::BondRule& rule : rules)
        for (const std::uint8_t b : rule.bodies) {
            if (b >= bodies.size()) continue;  // refused
            const double r = bodies[b].least_radius;
            const double mass = 4.0 / 3.0 * std::numbers::pi * r * r * r * bodies[b].material.density;
            const dem::BeamBond bond(rule.material, rule.radius_factor * r, 2 * r);
            least =
                std::min(least, share * bond.stable_step(mass, 0.4 * mass * r * r, bonds_in_closest_packing));
        }
    return least;
}

}  // namespace talus
