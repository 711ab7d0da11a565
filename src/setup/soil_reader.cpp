#include "src/setup/soil_reader.hpp"

#include <fmt/format.h>

#include <cmath>

#include "src/setup/names.hpp"
#include "src/setup/plasticity_reader.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};
constexpr Range not_negative{0};

soil::YieldSurface read_surface(const Section& table, const SoilSetup& setup) {
    const std::string kind = table.choice("kind", {"von_mises", "drucker_prager", "cam_clay"});
    if (kind == "von_mises")
        return soil::VonMises{.yield_stress = table.number("yield_stress", "Pa", {}, positive),
                              .hardening = table.number("hardening", "Pa", 0.0),
                              .residual = table.number("residual", "Pa", 0.0, not_negative)};
    if (kind == "drucker_prager") {
        const double friction = read_angle(table, "friction_angle");
        const double dilation = read_angle(table, "dilation_angle", 0.0);
        refuse_dilation_above_friction(table, "dilation_angle", dilation, friction);
        return soil::DruckerPrager{.cohesion = table.number("cohesion", "Pa", {}, not_negative),
                                   .friction = std::tan(friction),
                                   .dilation = std::tan(dilation),
                                   .hardening = table.number("hardening", "Pa", 0.0),
                                   .residual = table.number("residual", "Pa", 0.0, not_negative),
                                   .match = read_cone_match(table, setup.dimension)};
    }
    if (!setup.strength_factor.times.empty())
        table.error("kind", "modified Cam-Clay does not go with soil.strength_change");
    soil::CamClay clay{.slope = table.number("slope", "1", {}, positive),
                       .compression = table.number("compression", "1", {}, positive),
                       .swelling = table.number("swelling", "1", {}, positive),
                       .void_ratio = table.number("void_ratio", "1", {}, positive),
                       .preconsolidation = table.number("preconsolidation", "Pa", {}, positive)};
    if (clay.swelling >= clay.compression) table.error("swelling", "must be below compression");
    return clay;
}

double default_reference(const soil::YieldSurface& surface) {
    if (const auto* mises = std::get_if<soil::VonMises>(&surface)) return mises->yield_stress;
    if (const auto* prager = std::get_if<soil::DruckerPrager>(&surface)) return prager->cohesion;
    if (const auto* clay = std::get_if<soil::CamClay>(&surface)) return clay->preconsolidation;
    return 1;
}

}  // namespace

soil::Material read_soil_material(const Section& root, const Section& body, const SoilSetup& setup) {
    soil::Material material;
    material.name = body.text("material");
    const Section table = root.section("materials").section(material.name);
    if (!table.exists()) {
        body.error("material", fmt::format("there is no table [materials.{}] in the scene", material.name));
        return material;
    }
    material.density = table.number("density", "kg/m3", {}, positive);
    material.elasticity.youngs_modulus = table.number("youngs_modulus", "Pa", {}, positive);
    material.elasticity.poisson_ratio = table.number("poisson_ratio", "1", {}, {0, 0.495});
    if (setup.saturated) {
        material.permeability = table.number("permeability", "m3 s kg-1", {}, not_negative);
        material.storage = 1 / table.number("mixture_stiffness", "Pa", {}, positive);
    }
    const Section yield = table.section("yield");
    if (!yield.exists()) return material;
    material.surface = read_surface(yield, setup);
    material.overstress.fluidity = yield.number("fluidity", "s-1", {}, positive);
    material.overstress.exponent = yield.number("exponent", "1", 1.0, {1, 10});
    const double reference = default_reference(material.surface);
    material.overstress.reference = reference > 0 ? yield.number("reference", "Pa", reference, positive)
                                                  : yield.number("reference", "Pa", {}, positive);
    return material;
}

soil::TimeFactor read_time_factor(const Section& table, std::string_view key) {
    const Section change = table.section(key);
    soil::TimeFactor factor;
    if (!change.exists()) return factor;
    if (change.has("frequency")) {
        factor.frequency = change.number("frequency", "Hz", {}, positive);
        factor.phase = change.number("phase", "rad", 0.0);
    }
    if (change.has("frequency") && !change.has("times")) return factor;
    factor.times = change.numbers("times", "s", 0);
    factor.values = change.numbers("values", "1", 0);
    bool rising = true;
    for (std::size_t k = 1; k < factor.times.size(); ++k) rising &= factor.times[k - 1] < factor.times[k];
    if (!rising) change.error("times", "must rise");
    if (factor.values.size() != factor.times.size()) {
        change.error("values",
                     fmt::format("has {} values for {} times", factor.values.size(), factor.times.size()));
        return {};
    }
    return factor;
}

soil::TimeFactor read_strength_factor(const Section& table, std::string_view key) {
    const soil::TimeFactor factor = read_time_factor(table, key);
    if (factor.frequency > 0) table.section(key).error("frequency", "a strength has no frequency");
    for (const double value : factor.values)
        if (!(value > 0)) {
            table.section(key).error("values",
                                     fmt::format("{} is not above 0: leave out the strength", value));
            break;
        }
    return factor;
}

namespace {

soil::Face read_face(const Section& table, int dimension) {
    const std::string name = table.text("face");
    const auto found = std::find(face_names.begin(), face_names.begin() + 2 * dimension, name);
    if (found != face_names.begin() + 2 * dimension)
        return static_cast<soil::Face>(found - face_names.begin());
    table.error("face", fmt::format("'{}' is no face (allowed: {})", name,
                                    fmt::join(face_names.begin(), face_names.begin() + 2 * dimension, ", ")));
    return 0;
}

void read_velocity(const Section& table, int dimension, soil::BoundaryCondition& condition) {
    condition.value = read_point(table, "velocity", "m/s", dimension);
    condition.factor = read_time_factor(table, "change");
    const std::vector<std::string> all{"x", "y", "z"};
    const std::vector<std::string> axes =
        table.texts("axes", 0, std::vector<std::string>(all.begin(), all.begin() + dimension));
    for (const std::string& axis : axes) {
        const auto found = std::find(all.begin(), all.begin() + dimension, axis);
        if (found == all.begin() + dimension)
            table.error("axes", fmt::format("'{}' is no axis of this scene", axis));
        else
            condition.held[static_cast<std::size_t>(found - all.begin())] = true;
    }
}

}  // namespace

void read_soil_boundaries(const Section& root, SoilScene& scene) {
    using Kind = soil::BoundaryCondition::Kind;
    const int dimension = scene.simulation.dimension;
    const std::vector<Section> tables = root.sections("boundary");
    if (tables.size() > 32) root.error("boundary", "more than 32 boundary conditions");
    for (const Section& table : tables) {
        soil::BoundaryCondition condition;
        condition.name = table.text("name", table.path());
        refuse_same_name(table, scene.simulation.conditions, condition.name);
        const std::string kind =
            table.choice("kind", {"fixed", "free_slip", "velocity", "traction", "drained"});
        if (table.has("face") || kind == "free_slip" || kind == "traction")
            condition.face = read_face(table, dimension);
        condition.kind = Kind::velocity;
        if (kind == "fixed") condition.held = {true, true, true};
        if (kind == "velocity") read_velocity(table, dimension, condition);
        if (kind == "free_slip") {
            condition.kind = Kind::free_slip;
            condition.held[static_cast<std::size_t>(soil::axis_of(condition.face))] = true;
        }
        if (kind == "traction") {
            condition.kind = Kind::traction;
            condition.value = read_point(table, "traction", "Pa", dimension);
            condition.factor = read_time_factor(table, "change");
        }
        if (kind == "drained") {
            condition.kind = Kind::pore_pressure;
            condition.value[0] = table.number("pore_pressure", "Pa", 0.0);
            condition.factor = read_time_factor(table, "change");
            if (!scene.simulation.saturated) table.error("kind", "needs soil.saturated = true");
        }
        condition.lower.fill(-infinity);
        condition.upper.fill(infinity);
        if (table.has("lower")) condition.lower = read_point(table, "lower", "m", dimension);
        if (table.has("upper")) condition.upper = read_point(table, "upper", "m", dimension);
        scene.simulation.conditions.push_back(condition);
    }
}

}  // namespace talus
