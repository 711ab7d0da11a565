#include "src/setup/grain_law_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <type_traits>

#include "physics/dem/laws/time_step.hpp"
#include "src/setup/grain_scene.hpp"

namespace talus {

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};
constexpr Range not_negative{0};
}  // namespace

GrainLawReader::GrainLawReader(const Section& root) : root_(root), dem_(root.section("dem")) {
    const bool hertz = dem_.choice("law", {"hertz", "linear"}, "hertz") == "hertz";
    if (!hertz) elasticity_ = Elasticity::linear;
    const std::string rolling =
        dem_.choice("rolling", {"free", "constant_torque", "elastic_plastic"}, "free");
    if (rolling == "constant_torque") rolling_ = Rolling::constant_torque;
    if (rolling == "elastic_plastic") rolling_ = Rolling::elastic_plastic;
    twists_freely_ = dem_.choice("twisting", {"free", "contact_area"}, "free") == "free";
    end_ = dem_.choice("end_of_contact", {"may_attract", "cut_at_zero"}, "may_attract") == "may_attract"
               ? dem::EndOfContact::may_attract
               : dem::EndOfContact::cut_at_zero;
    if (!hertz) {
        stiffness_ = dem_.number("stiffness", "N/m", {}, positive);
        stiffness_ratio_ = dem_.number("stiffness_ratio", "1", 2.0 / 7, not_negative);
    }
    read_adhesion();
    read_film();
}

void GrainLawReader::read_adhesion() {
    const std::string adhesion = dem_.choice("adhesion", {"none", "jkr", "dmt", "van_der_waals"}, "none");
    if (adhesion == "none") return;
    if (adhesion == "jkr") {
        if (elasticity_ == Elasticity::linear)
            dem_.error("adhesion", "\"jkr\" is of Hertzian contacts, it needs law = \"hertz\"");
        if (end_ == dem::EndOfContact::cut_at_zero)
            dem_.error("adhesion", "\"jkr\" needs end_of_contact = \"may_attract\"");
        elasticity_ = Elasticity::johnson_kendall_roberts;
        return;
    }
    surface_force_ = SurfaceForce::pull_off;
    van_der_waals_ = adhesion == "van_der_waals";
    if (!van_der_waals_) return;
    pull_.separation = dem_.number("separation", "m", {}, positive);
    pull_.greatest_gap = dem_.number("adhesion_reach", "m", 9 * pull_.separation, positive);
}

void GrainLawReader::read_film() {
    if (dem_.choice("film", {"none", "viscous"}, "none") == "none") return;
    if (surface_force_ != SurfaceForce::none || elasticity_ == Elasticity::johnson_kendall_roberts)
        dem_.error("film", "\"viscous\" does not go with adhesion; allowed: adhesion = \"none\"");
    surface_force_ = SurfaceForce::lubrication;
    film_.viscosity = dem_.number("viscosity", "Pa s", {}, positive);
    film_.roughness = dem_.number("roughness", "m", {}, positive);
    film_.greatest_gap = dem_.number("film_reach", "m", {}, positive);
    if (film_.greatest_gap <= film_.roughness)
        dem_.error("film_reach", fmt::format("must be above the roughness, {:.4g} m", film_.roughness));
}

Range GrainLawReader::restitutions() const {
    return {end_ == dem::EndOfContact::cut_at_zero ? dem::least_restitution_cut : 0, 1};
}

dem::GrainMaterial GrainLawReader::read_material(const Section& table, const std::string& name) const {
    dem::GrainMaterial material;
    material.name = name;
    material.density = table.number("density", "kg/m3", {}, positive);
    if (elasticity_ != Elasticity::linear) {
        material.youngs_modulus = table.number("youngs_modulus", "Pa", {}, positive);
        material.poisson_ratio = table.number("poisson_ratio", "1", {}, {-1, 0.5, true});
    }
    material.restitution = table.number("restitution", "1", {}, restitutions());
    material.friction = table.number("friction", "1", {}, not_negative);
    if (rolling_ != Rolling::free)
        material.rolling_friction = table.number("rolling_friction", "1", {}, not_negative);
    if (rolling_ == Rolling::elastic_plastic)
        material.rolling_damping = table.number("rolling_damping", "1", 0.3, not_negative);
    if (!twists_freely_)
        material.twisting_friction = table.number("twisting_friction", "1", material.friction, not_negative);
    if (const std::optional<double> work = work_of_adhesion(table)) material.work_of_adhesion = *work;
    return material;
}

/// Of a material's table, or of a pair's if it states any [J/m2].
std::optional<double> GrainLawReader::work_of_adhesion(const Section& table) const {
    if (van_der_waals_) {
        // The work that takes surfaces from their least distance s to infinity: A / (12 pi s^2).
        const double s = pull_.separation;
        return table.number("hamaker_constant", "J", {}, positive) / (12 * std::numbers::pi * s * s);
    }
    if (surface_force_ == SurfaceForce::pull_off || elasticity_ == Elasticity::johnson_kendall_roberts)
        return table.number("work_of_adhesion", "J/m2", {}, positive);
    return std::nullopt;
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
        if (rolling_ != Rolling::free) stated.rolling_friction = given("rolling_friction", not_negative);
        if (!twists_freely_) stated.twisting_friction = given("twisting_friction", not_negative);
        if (table.has(van_der_waals_ ? "hamaker_constant" : "work_of_adhesion"))
            stated.work_of_adhesion = work_of_adhesion(table);
        pairs_->state(pair[0], pair[1], stated);
    }
}

GrainTimeStep GrainLawReader::time_step_of(const GrainBody& body) const {
    constexpr double greatest_share = 0.3, usual_share = 0.1;
    const double r = body.least_radius;
    const dem::GrainMaterial& material = body.material;
    const double density = body.least_density.value_or(material.density);
    const double mass = 4.0 / 3.0 * std::numbers::pi * r * r * r * density;
    GrainTimeStep limit{};
    if (elasticity_ == Elasticity::linear) {
        const double ratio = 0.5 * dem::linear_damping(material.restitution, end_);
        const auto lattice = [&](double damping) {
            return dem::packed_lattice_limit(mass, stiffness_, stiffness_ratio_ * stiffness_, damping);
        };
        const double one_dashpot = lattice(0) * (std::sqrt(1 + ratio * ratio) - ratio);
        limit = {one_dashpot, std::min(0.25 * one_dashpot, 0.7 * lattice(ratio)),
                 fmt::format("the limit of densely packed grains of {:.4g} m of '{}' that move and turn", r,
                             body.name),
                 lattice(ratio)};
    } else {
        const double rayleigh =
            dem::rayleigh_time(r, density, dem::shear_modulus(material), material.poisson_ratio);
        limit.greatest = greatest_share * rayleigh;
        limit.usual = usual_share * rayleigh;
        limit.reason =
            fmt::format("{} of the time in which a Rayleigh wave crosses a grain of {:.4g} m of '{}'",
                        greatest_share, r, body.name);
    }
    if (surface_force_ != SurfaceForce::lubrication) return limit;
    const double squeezed =
        dem::squeezed_film_limit(mass, r, film_.viscosity, film_.roughness, film_.greatest_gap);
    if (squeezed < limit.greatest)
        limit = {squeezed, std::min(limit.usual, 0.5 * squeezed),
                 fmt::format("the limit of the film between a grain of {:.4g} m of '{}' and two walls", r,
                             body.name),
                 limit.packed};
    return limit;
}

GrainTimeStep GrainLawReader::time_step(const std::vector<GrainBody>& bodies) const {
    GrainTimeStep limit{infinity, infinity, ""};
    double packed = infinity;
    for (const GrainBody& body : bodies) {
        if (body.held) continue;
        const GrainTimeStep found = time_step_of(body);
        packed = std::min(packed, found.packed);
        if (found.greatest < limit.greatest) limit = found;
    }
    limit.packed = packed;
    if (!(limit.greatest < infinity)) limit.usual = 1;  // nothing moves
    return limit;
}

/// Gives each part of a law the coefficients of a pair of materials.
struct GrainLawReader::Parts {
    const GrainLawReader& scene;
    dem::PairProperties pair;

    void put(dem::HertzMindlin<double>& part) const { part = dem::hertz_mindlin(pair, scene.end_); }
    void put(dem::LinearSpring<double>& part) const {
        part = dem::linear_spring(pair, scene.stiffness_, scene.stiffness_ratio_, scene.end_);
    }
    void put(dem::JohnsonKendallRoberts<double>& part) const { part = dem::johnson_kendall_roberts(pair); }
    void put(dem::ConstantRollingTorque<double>& part) const { part = {pair.rolling_friction}; }
    void put(dem::ElasticPlasticRolling<double>& part) const {
        part = {pair.rolling_friction, pair.rolling_damping};
    }
    void put(dem::ContactAreaTwisting<double>& part) const { part = {pair.twisting_friction}; }
    void put(dem::PullOff<double>& part) const {
        part = scene.pull_;
        part.force_per_radius = 2 * std::numbers::pi * pair.work_of_adhesion;
    }
    void put(dem::Lubrication<double>& part) const { part = scene.film_; }
    template <class Absent>
    void put(Absent&) const {
        static_assert(std::is_empty_v<Absent>);
    }
};

template <class Law>
bool GrainLawReader::is_chosen() const {
    using E = decltype(Law::elasticity);
    using R = decltype(Law::rolling);
    using S = decltype(Law::surface_force);
    const std::array elasticities{std::is_same_v<E, dem::HertzMindlin<double>>,
                                  std::is_same_v<E, dem::LinearSpring<double>>,
                                  std::is_same_v<E, dem::JohnsonKendallRoberts<double>>};
    const std::array resistances{std::is_same_v<R, dem::RollsFreely<double>>,
                                 std::is_same_v<R, dem::ConstantRollingTorque<double>>,
                                 std::is_same_v<R, dem::ElasticPlasticRolling<double>>};
    const std::array surface_forces{std::is_same_v<S, dem::NoSurfaceForce<double>>,
                                    std::is_same_v<S, dem::PullOff<double>>,
                                    std::is_same_v<S, dem::Lubrication<double>>};
    return elasticities[static_cast<std::size_t>(elasticity_)] &&
           resistances[static_cast<std::size_t>(rolling_)] &&
           surface_forces[static_cast<std::size_t>(surface_force_)] && Law::twists != twists_freely_;
}

/// Of all laws from place `first` on the one that the scene chose.
template <std::size_t first>
dem::AnyLawTable GrainLawReader::table_from() const {
    if constexpr (first == std::variant_size_v<dem::AnyLawTable>) {
        throw std::logic_error("parts of a law that do not go together were not refused");
    } else {
        using Table = std::variant_alternative_t<first, dem::AnyLawTable>;
        using Law = typename Table::Law;
        if (!is_chosen<Law>()) return table_from<first + 1>();
        return Table{dem::PairTable<Law>(materials_.size(), [&](std::size_t a, std::size_t b) {
            const Parts parts{*this, (*pairs_)(a, b)};
            Law law;
            parts.put(law.elasticity);
            law.friction = {parts.pair.friction};
            parts.put(law.rolling);
            parts.put(law.twisting);
            parts.put(law.surface_force);
            return law;
        })};
    }
}

dem::AnyLawTable GrainLawReader::table() const { return table_from<0>(); }

}  // namespace talus
