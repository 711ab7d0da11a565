#include "src/setup/friction_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

/// tan(phi), given as an angle or as itself.
double read_coefficient(const Section& table) {
    if (table.has("angle") && table.has("coefficient"))
        table.error("coefficient", "give angle or coefficient, not both");
    if (table.has("angle") || !table.has("coefficient")) {
        const double angle = table.number("angle", "rad", {}, not_negative);
        if (angle >= std::numbers::pi / 2) {
            table.error("angle",
                        fmt::format("is {:.4g} degrees; allowed: below 90", angle * 180 / std::numbers::pi));
            return 0;
        }
        return std::tan(angle);
    }
    return table.number("coefficient", "1", {}, not_negative);
}

}  // namespace

depth::BasalFriction read_basal_friction(const Section& table) {
    const std::string law = table.choice("law",
                                         {"none", "coulomb", "voellmy", "manning", "chezy", "newtonian",
                                          "bingham", "herschel_bulkley", "perzyna"},
                                         "none");
    if (law == "coulomb") {
        const double coefficient = read_coefficient(table);
        return depth::Coulomb{coefficient, table.number("cohesion", "Pa", 0.0, not_negative)};
    }
    if (law == "voellmy") {
        const double coefficient = read_coefficient(table);
        return depth::Voellmy{coefficient, table.number("turbulence", "m s-2", {}, positive)};
    }
    if (law == "manning") return depth::Manning{table.number("roughness", "1", {}, not_negative)};
    if (law == "chezy") return depth::Chezy{table.number("coefficient", "m(1/2) s-1", {}, positive)};
    if (law == "newtonian") return depth::Newtonian{table.number("viscosity", "Pa s", {}, not_negative)};
    if (law == "bingham") {
        const double yield = table.number("yield_stress", "Pa", {}, not_negative);
        return depth::Bingham{yield, table.number("viscosity", "Pa s", {}, positive)};
    }
    if (law == "herschel_bulkley") {
        const double yield = table.number("yield_stress", "Pa", {}, not_negative),
                     consistency = table.number("consistency", "1", {}, positive);
        return depth::HerschelBulkley{yield, consistency, table.number("exponent", "1", {}, positive)};
    }
    if (law == "perzyna") {
        const double coefficient = read_coefficient(table),
                     cohesion = table.number("cohesion", "Pa", 0.0, not_negative),
                     fluidity = table.number("fluidity", "s-1", {}, positive),
                     reference = table.number("reference_stress", "Pa", {}, positive);
        return depth::PerzynaViscoplastic{cohesion, coefficient, fluidity, reference,
                                          table.number("exponent", "1", 1.0, positive)};
    }
    return depth::Frictionless{};
}

double friction_coefficient(const depth::BasalFriction& friction) {
    return std::visit(
        []<class Law>(const Law& law) -> double {
            if constexpr (requires { law.friction; })
                return law.friction;
            else
                return 0;
        },
        friction);
}

std::optional<depth::TwoPhase> read_two_phase(const Section& root) {
    const Section table = root.section("two_phase");
    if (!table.exists()) return {};
    depth::TwoPhase phases;
    phases.solid_density = table.number("solid_density", "kg m-3", 2700.0, positive);
    phases.water_density = table.number("water_density", "kg m-3", 1000.0, positive);
    if (phases.solid_density < phases.water_density)
        table.error("solid_density", "is below that of the water; allowed: solid that sinks");
    const std::string law = table.choice("drag", {"anderson_jackson", "darcy", "none"}, "anderson_jackson");
    if (law == "none") phases.drag = depth::DragLaw::none;
    if (law == "darcy") {
        phases.drag = depth::DragLaw::darcy;
        phases.speed = table.number("conductivity", "m s-1", {}, positive);
    }
    if (law == "anderson_jackson") {
        phases.speed = table.number("settling_velocity", "m s-1", {}, positive);
        phases.exponent = table.number("exponent", "1", 3.65, not_negative);
    }
    phases.porosity = table.number("porosity", "1", 0.4, {0, 0.99, true});
    if (root.section("depth").has("entrainment")) {
        phases.bed_porosity = table.number("bed_porosity", "1", phases.porosity, {0, 0.99, true});
        phases.bed_saturation = table.number("bed_saturation", "1", 1.0, {0, 1});
    }
    phases.water_friction = read_basal_friction(root.section("water_friction"));
    return phases;
}

std::optional<PorePressure> read_pore_pressure(const Section& table) {
    if (!table.exists()) return {};
    PorePressure model{};
    model.law.coefficient = table.number("consolidation", "m2 s-1", {}, not_negative);
    model.points = static_cast<int>(table.integer("points", 1, 1, 1000));
    model.ratio = table.number("ratio", "1", 1.0, {0, 1});
    model.loaded_share = table.number("loaded_share", "1", 1.0, {0, 1});
    if (model.points > 1 && table.choice("base", {"impermeable", "drained"}, "impermeable") == "drained")
        model.law.base = depth::Base::drained;
    return model;
}

}  // namespace talus
