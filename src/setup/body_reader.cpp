#include "src/setup/body_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "src/setup/glass.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

VelocityField read_velocity_field(const Section& table, int dimension) {
    if (!table.exists()) return {};
    const std::string kind =
        table.choice("kind", {"sine", "cantilever", "stretch", "radial", "vortices", "standing_wave"});
    if (kind == "cantilever")
        return CantileverVelocity{table.number("clamp", "m"), table.number("length", "m", {}, positive),
                                  table.number("tip_velocity", "m/s")};
    if (kind == "stretch")
        return StretchVelocity{origin_default(table, "centre", "m", dimension),
                               read_point(table, "rate", "s-1", dimension)};
    if (kind == "radial")
        return RadialVelocity{origin_default(table, "centre", "m", dimension), table.number("speed", "m/s"),
                              table.number("radius", "m", 0.0, not_negative)};
    if (kind == "vortices")
        return VortexVelocity{table.number("speed", "m/s"), table.number("length", "m", {}, positive)};
    if (kind == "standing_wave")
        return StandingWaveVelocity{table.number("speed", "m/s"), table.number("length", "m", {}, positive),
                                    table.number("bottom", "m", 0.0),
                                    table.number("depth", "m", {}, positive)};
    return SineVelocity{read_point(table, "amplitude", "m/s", dimension),
                        read_point(table, "wave_vector", "m-1", dimension),
                        table.number("phase", "rad", 0.0)};
}

/// A glass made by the root, which takes half a second, and handed to every rank.
UnitCell shared_glass(const BodyContext& context) {
    UnitCell glass{.edges = {}, .points = {}, .fits_boxes = false};
    std::string bytes;
    if (context.comm.is_root()) {
        glass = glass_cell(context.dimension, context.seed);
        glass.points.push_back(glass.edges);
        bytes.assign(reinterpret_cast<const char*>(glass.points.data()), glass.points.size() * sizeof(Point));
    }
    bytes = context.comm.all_broadcast(bytes);
    glass.points.resize(bytes.size() / sizeof(Point));
    std::memcpy(glass.points.data(), bytes.data(), bytes.size());
    glass.edges = glass.points.back();
    glass.points.pop_back();
    return glass;
}

UnitCell read_packing(const Section& table, const BodyContext& context) {
    const std::string name = table.choice("lattice", {"cubic", "close_packed", "glass"}, "close_packed");
    if (name == "cubic") return lattice_cell(Lattice::cubic, context.dimension);
    if (name == "close_packed") return lattice_cell(Lattice::close_packed, context.dimension);
    for (const Boundary boundary : context.boundaries)
        if (boundary != Boundary::open) {
            table.error("lattice", "a glass does not continue through closed boundaries");
            return lattice_cell(Lattice::cubic, context.dimension);
        }
    if (context.dimension == 1) {
        table.error("lattice", "there is no glass in one dimension");
        return lattice_cell(Lattice::cubic, 1);
    }
    if (context.first_body && !context.first_body->cell.fits_boxes) return context.first_body->cell;
    return shared_glass(context);
}

/// Spacing from `spacing` or from the wanted number of particles; by default from the scene's first body,
/// with its spacing or with its mass per particle.
double read_spacing(const Section& table, const Body& body, const BodyContext& context) {
    if (table.has("spacing") && table.has("particles"))
        table.error("particles", "give spacing or particles, not both");
    if (table.has("particles")) {
        const auto count = static_cast<double>(table.integer("particles", {}, 1, std::int64_t{1} << 40));
        return std::pow(volume(body.shape, context.dimension) / count, 1.0 / context.dimension);
    }
    if (table.has("spacing") || !context.first_body) return table.number("spacing", "m", {}, positive);
    const Body& first = *context.first_body;
    const bool same_mass = table.choice("resolution", {"same_spacing", "same_mass"},
                                        context.in_impact ? "same_mass" : "same_spacing") == "same_mass";
    if (!same_mass) return first.spacing;
    return first.spacing * std::pow(first.density / body.density, 1.0 / context.dimension);
}

}  // namespace

Point read_spin(const Section& table, int dimension) {
    Point spin{};
    if (table.has("spin"))
        spin = dimension == 3 ? read_point(table, "spin", "rad/s", 3)
                              : Point{0, 0, table.number("spin", "rad/s")};
    if (!table.has("spin_period")) return spin;
    if (table.has("spin")) table.error("spin_period", "give spin or spin_period, not both");
    const Point axis = dimension == 3 ? read_point(table, "spin_axis", "1", 3, {{0, 0, 1}}) : Point{0, 0, 1};
    const double length = norm(axis), period = table.number("spin_period", "s", {}, positive);
    if (length == 0) {
        table.error("spin_axis", "has no direction");
        return spin;
    }
    return times(2 * std::numbers::pi / period / length, axis);
}

namespace {

/// Specific internal energy: given, or from a given pressure of a gas.
double read_energy(const Section& table, const Material& material, double density) {
    if (!table.has("pressure"))
        return table.number("internal_energy", "J/kg", material.initial_internal_energy);
    if (table.has("internal_energy")) table.error("pressure", "give pressure or internal_energy, not both");
    const double wanted = table.number("pressure", "Pa");
    // Pressure is linear in the energy for gases; two states give the line.
    const double at_zero = pressure(material.eos, density, 0), at_one = pressure(material.eos, density, 1);
    if (std::holds_alternative<Tillotson>(material.eos) || !(at_one > at_zero)) {
        table.error("pressure", "can be given for gases only; give density and internal_energy");
        return 0;
    }
    return (wanted - at_zero) / (at_one - at_zero);
}

DensityProfile read_profile(const Section& table, const Body& body, const Material& material, int dimension) {
    const std::string name =
        table.choice("density_profile", {"even", "inverse_radius", "polytrope_1"}, "even");
    if (name == "even") return DensityProfile::even;
    const auto* sphere = std::get_if<SphereShape>(&body.shape);
    if (!sphere || sphere->inner_radius > 0 || dimension != 3) {
        table.error("density_profile", "only a sphere in 3D that is not hollow has one; others are even");
        return DensityProfile::even;
    }
    if (!std::holds_alternative<IdealGas>(material.eos) || material.shear_modulus > 0)
        table.error("density_profile", fmt::format("material '{}' is no ideal gas: where its density is not "
                                                   "its own, it would burst",
                                                   material.name));
    if (body.jitter > 0) table.error("jitter", "is for bodies of even density");
    if (table.has("pressure")) table.error("pressure", "would vary with the density; give internal_energy");
    return name == "polytrope_1" ? DensityProfile::polytrope_1 : DensityProfile::inverse_radius;
}

/// Internal energy of a polytrope that was given none: in equilibrium with its own gravity.
void balance(const Section& table, const Material& material, double gravitational_constant, Body& body) {
    if (gravitational_constant == 0) {
        table.error("density_profile", "a polytrope needs [gravity] or an internal_energy of its own");
        return;
    }
    const auto* gas = std::get_if<IdealGas>(&material.eos);
    if (!gas) return;
    const double radius = std::get<SphereShape>(body.shape).radius;
    body.hydrostatic = true;
    body.internal_energy =
        polytropic_constant(radius, gravitational_constant) * body.density / (gas->gamma - 1);
}

}  // namespace

Body read_body_form(const Section& table, double density, const BodyContext& context) {
    const int dimension = context.dimension;
    Body body;
    body.name = table.text("name", table.path());
    body.density = table.number("density", "kg/m3", density, positive);
    body.shape = read_shape(table, body.density, context);
    body.cell = read_packing(table, context);
    body.spacing = read_spacing(table, body, context);
    body.jitter = table.number("jitter", "1", 0.0, {0, 0.5});
    if (context.in_impact) {
        for (const std::string_view key : {"velocity", "centre"})
            if (table.has(key)) table.error(key, "is set by [impact], which names this body");
    } else {
        body.velocity = origin_default(table, "velocity", "m/s", dimension);
    }
    body.spin = read_spin(table, dimension);
    body.velocity_field = read_velocity_field(table.section("velocity_field"), dimension);
    return body;
}

Body read_body(const Section& table, const Material& material, const BodyContext& context) {
    Body body = read_body_form(table, material.reference_density, context);
    body.profile = read_profile(table, body, material, context.dimension);
    if (body.profile == DensityProfile::polytrope_1 && !table.has("internal_energy"))
        balance(table, material, context.gravitational_constant, body);
    else
        body.internal_energy = read_energy(table, material, body.density);
    if (material.fracture)
        body.damage = table.number("damage", "1", 0.0, {0, 1});
    else if (table.has("damage"))
        table.error("damage",
                    fmt::format("material '{}' cannot crack: it has no [fracture] table", material.name));
    return body;
}

}  // namespace talus
