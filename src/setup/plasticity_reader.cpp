#include "src/setup/plasticity_reader.hpp"

#include <limits>
#include <numbers>

namespace talus {

double read_angle(const Section& table, std::string_view key, std::optional<double> default_value) {
    const double angle = table.number(key, "rad", default_value);
    if (angle >= 0 && angle < std::numbers::pi / 2) return angle;
    table.error(key, "must be from 0 to less than 90 deg (1.5708 rad); angles in degrees read \"30 deg\"");
    return 0;
}

ConeMatch read_cone_match(const Section& table, int dimension) {
    const std::string name = table.choice("cone", {"plane_strain", "compression", "extension"},
                                          dimension == 3 ? "compression" : "plane_strain");
    if (name == "compression") return ConeMatch::compression;
    return name == "extension" ? ConeMatch::extension : ConeMatch::plane_strain;
}

void refuse_dilation_above_friction(const Section& table, std::string_view key, double dilation_angle,
                                    double friction_angle) {
    if (dilation_angle > friction_angle)
        table.error(key, "is above the friction angle: flow would gain energy");
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};
constexpr Range not_negative{0};

/// What a cone is made of.
struct ConeKeys {
    double cohesion, friction_angle, dilation_angle;
};

ConeKeys read_residual(const Section& table, const ConeKeys& peak) {
    const ConeKeys keys{.cohesion = table.number("residual_cohesion", "Pa", peak.cohesion, not_negative),
                        .friction_angle = read_angle(table, "residual_friction_angle", peak.friction_angle),
                        .dilation_angle = read_angle(table, "residual_dilation_angle", 0.0)};
    refuse_dilation_above_friction(table, "residual_dilation_angle", keys.dilation_angle,
                                   keys.friction_angle);
    return keys;
}

bool read_gaps(const Section& table) {
    return table.choice("gaps", {"forgotten", "close"}, "forgotten") == "forgotten";
}

DruckerPrager read_drucker_prager(const Section& table, int dimension) {
    const ConeMatch match = read_cone_match(table, dimension);
    const ConeKeys peak{.cohesion = table.number("cohesion", "Pa", 0.0, not_negative),
                        .friction_angle = read_angle(table, "friction_angle"),
                        .dilation_angle = read_angle(table, "dilation_angle", 0.0)};
    refuse_dilation_above_friction(table, "dilation_angle", peak.dilation_angle, peak.friction_angle);
    if (peak.cohesion == 0 && peak.friction_angle == 0)
        table.error("friction_angle",
                    "soil without friction and cohesion bears no shear: leave out its "
                    "strength and its shear modulus");
    const auto made = [match](const ConeKeys& keys) {
        return cone(match, keys.cohesion, keys.friction_angle, keys.dilation_angle);
    };
    DruckerPrager model{.peak = made(peak), .residual = made(peak)};
    model.tensile_strength =
        table.has("tensile_strength") ? table.number("tensile_strength", "Pa", {}, not_negative) : infinity;
    model.forgets_gaps = read_gaps(table);
    if (table.has("softening_strain")) {
        model.softening_strain = table.number("softening_strain", "1", {}, positive);
        model.residual = made(read_residual(table, peak));
    }
    return model;
}

GranularFlow read_granular_flow(const Section& table) {
    GranularFlow model{.friction_static = table.number("friction_static", "1", {}, positive),
                       .friction_limit = table.number("friction_limit", "1", {}, positive),
                       .inertial_number = table.number("inertial_number", "1", 0.3, positive),
                       .grain_diameter = table.number("grain_diameter", "m", {}, positive),
                       .grain_density = table.number("grain_density", "kg/m3", {}, positive),
                       .forgets_gaps = read_gaps(table)};
    if (model.friction_limit < model.friction_static)
        table.error("friction_limit", "is below friction_static, from which it rises with the rate");
    return model;
}

}  // namespace

bool is_plasticity(const std::string& kind) { return kind == "drucker_prager" || kind == "mu_i"; }

Plasticity read_plasticity(const Section& table, const std::string& kind, int dimension) {
    if (kind == "mu_i") return read_granular_flow(table);
    return read_drucker_prager(table, dimension);
}

}  // namespace talus
