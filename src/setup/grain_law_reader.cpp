#include "src/setup/grain_law_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/dem/laws/time_step.hpp"
#include "src/setup/grain_scene.hpp"

namespace talus {

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};
constexpr Range not_negative{0};
}  // namespace

GrainLawReader::GrainLawReader(const Section& root) : root_(root), dem_(root.section("dem")) {
    hertz_ = dem_.choice("law", {"hertz", "linear"}, "hertz") == "hertz";
    rolling_ = dem_.choice("rolling", {"free", "elastic_plastic"}, "free") == "elastic_plastic";
    end_ = dem_.choice("end_of_contact", {"may_attract", "cut_at_zero"}, "may_attract") == "may_attract"
               ? dem::EndOfContact::may_attract
               : dem::EndOfContact::cut_at_zero;
    if (hertz_) return;
    stiffness_ = dem_.number("stiffness", "N/m", {}, positive);
    stiffness_ratio_ = dem_.number("stiffness_ratio", "1", 2.0 / 7, not_negative);
}

Range GrainLawReader::restitutions() const {
    return {end_ == dem::EndOfContact::cut_at_zero ? dem::least_restitution_cut : 0, 1};
}

dem::GrainMaterial GrainLawReader::read_material(const Section& table, const std::string& name) const {
    dem::GrainMaterial material;
    material.name = name;
    material.density = table.number("density", "kg/m3", {}, positive);
    if (hertz_) {
        material.youngs_modulus = table.number("youngs_modulus", "Pa", {}, positive);
        material.poisson_ratio = table.number("poisson_ratio", "1", {}, {-1, 0.5, true});
    }
    material.restitution = table.number("restitution", "1", {}, restitutions());
    material.friction = table.number("friction", "1", {}, not_negative);
    if (rolling_) {
        material.rolling_friction = table.number("rolling_friction", "1", {}, not_negative);
        material.rolling_damping = table.number("rolling_damping", "1", 0.3, not_negative);
    }
    return material;
}

std::uint8_t GrainLawReader::material(const Section& table) {
    const std::string name = table.text("material");
    for (std::size_t m = 0; m < materials_.size(); ++m)
        if (materials_[m].name == name) return static_cast<std::uint8_t>(m);
    const Section own = root_.section("materials").section(name);
    if (!own.exists() || name.empty())
        table.error("material", fmt::format("there is no table [materials.{}] in the scene", name));
    else if (materials_.size() == 255)
        table.error("material", "more than 255 materials");
    materials_.push_back(own.exists() ? read_material(own, name) : dem::GrainMaterial{.name = name});
    return static_cast<std::uint8_t>(materials_.size() - 1);
}

void GrainLawReader::read_pairs() {
    pairs_.emplace(materials_);
    for (const Section& table : root_.sections("contact")) {
        std::array<std::size_t, 2> pair{};
        const std::vector<std::string> names = table.texts("materials", 2);
        for (std::size_t side = 0; side < std::min<std::size_t>(names.size(), 2); ++side) {
            const auto found = std::find_if(materials_.begin(), materials_.end(), [&](const auto& material) {
                return material.name == names[side];
            });
            if (found == materials_.end())
                table.error("materials", fmt::format("no grains and no wall are of '{}'", names[side]));
            else
                pair[side] = static_cast<std::size_t>(found - materials_.begin());
        }
        const auto given = [&](std::string_view key, Range range) {
            return table.has(key) ? std::optional<double>(table.number(key, "1", {}, range)) : std::nullopt;
        };
        dem::PairOverride stated;
        stated.restitution = given("restitution", restitutions());
        stated.friction = given("friction", not_negative);
        if (rolling_) stated.rolling_friction = given("rolling_friction", not_negative);
        pairs_->state(pair[0], pair[1], stated);
    }
}

GrainTimeStep GrainLawReader::time_step(const std::vector<GrainBody>& bodies) const {
    constexpr double greatest_share = 0.3, usual_share = 0.1;
    GrainTimeStep limit{infinity, infinity, ""};
    for (const GrainBody& body : bodies) {
        if (body.held) continue;
        const double r = body.least_radius;
        const dem::GrainMaterial& material = body.material;
        GrainTimeStep found;
        if (hertz_) {
            const double rayleigh =
                dem::rayleigh_time(r, material.density, dem::shear_modulus(material), material.poisson_ratio);
            found = {
                greatest_share * rayleigh, usual_share * rayleigh,
                fmt::format("{} of the time in which a Rayleigh wave crosses a grain of {:.4g} m of '{}'",
                            greatest_share, r, body.name)};
        } else {
            const double mass = 4.0 / 3.0 * std::numbers::pi * r * r * r * material.density;
            const double ratio = 0.5 * dem::linear_damping(material.restitution, end_);
            const double lattice =
                dem::packed_lattice_limit(mass, stiffness_, stiffness_ratio_ * stiffness_, ratio);
            found = {lattice, 0.2 * lattice,
                     fmt::format("the limit of densely packed grains of {:.4g} m of '{}' that move and turn",
                                 r, body.name)};
        }
        if (found.greatest < limit.greatest) limit = found;
    }
    if (!(limit.greatest < infinity)) limit.usual = 1;  // nothing moves
    return limit;
}

namespace {

template <template <class> class Law, class Make>
dem::AnyLawTable table_of(std::size_t materials, Make&& make) {
    return dem::LawTable<Law>{dem::PairTable<Law<double>>(materials, make)};
}

}  // namespace

dem::AnyLawTable GrainLawReader::table() const {
    const dem::MaterialPairs& pairs = *pairs_;
    const auto elasticity = [&](std::size_t a, std::size_t b) {
        return dem::hertz_mindlin(pairs(a, b), end_);
    };
    const auto spring = [&](std::size_t a, std::size_t b) {
        return dem::linear_spring(pairs(a, b), stiffness_, stiffness_ratio_, end_);
    };
    const auto resistance = [&](std::size_t a, std::size_t b) {
        return dem::ElasticPlasticRolling<double>{pairs(a, b).rolling_friction, pairs(a, b).rolling_damping};
    };
    const std::size_t n = materials_.size();
    if (hertz_ && rolling_)
        return table_of<dem::RollingHertzLaw>(n, [&](std::size_t a, std::size_t b) {
            return dem::RollingHertzLaw<double>{
                elasticity(a, b), {pairs(a, b).friction}, resistance(a, b), {}, {}};
        });
    if (hertz_)
        return table_of<dem::HertzLaw>(n, [&](std::size_t a, std::size_t b) {
            return dem::HertzLaw<double>{elasticity(a, b), {pairs(a, b).friction}, {}, {}, {}};
        });
    if (rolling_)
        return table_of<dem::RollingLinearLaw>(n, [&](std::size_t a, std::size_t b) {
            return dem::RollingLinearLaw<double>{
                spring(a, b), {pairs(a, b).friction}, resistance(a, b), {}, {}};
        });
    return table_of<dem::LinearLaw>(n, [&](std::size_t a, std::size_t b) {
        return dem::LinearLaw<double>{spring(a, b), {pairs(a, b).friction}, {}, {}, {}};
    });
}

}  // namespace talus
