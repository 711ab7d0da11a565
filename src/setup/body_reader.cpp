#include "src/setup/body_reader.hpp"

#include <fmt/format.h>

#include <cmath>

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

Point read_point(const Section& table, std::string_view key, std::string_view unit, int dimension,
                 std::optional<std::vector<double>> default_value = {}) {
    const auto count = static_cast<std::size_t>(dimension);
    if (default_value) default_value->resize(count);
    const std::vector<double> values = table.numbers(key, unit, count, default_value);
    Point point{};
    std::copy_n(values.begin(), std::min(values.size(), count), point.begin());
    return point;
}

Point origin_default(const Section& table, std::string_view key, std::string_view unit, int dimension) {
    return read_point(table, key, unit, dimension, std::vector<double>(3, 0.0));
}

BodyShape read_shape(const Section& table, int dimension, const BoxShape& domain) {
    const std::string kind = table.choice("shape", {"box", "sphere", "ellipsoid", "domain"});
    if (kind == "sphere") {
        SphereShape sphere{origin_default(table, "centre", "m", dimension),
                           table.number("radius", "m", {}, positive),
                           table.number("inner_radius", "m", 0.0, not_negative)};
        if (sphere.inner_radius >= sphere.radius) table.error("inner_radius", "must be below the radius");
        return sphere;
    }
    if (kind == "ellipsoid") {
        EllipsoidShape ellipsoid{origin_default(table, "centre", "m", dimension),
                                 read_point(table, "semi_axes", "m", dimension)};
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
            if (!(ellipsoid.semi_axes[a] > 0)) {
                table.error("semi_axes", "must be positive");
                ellipsoid.semi_axes[a] = 1;
            }
        return ellipsoid;
    }
    if (kind == "domain") return domain;
    BoxShape box{read_point(table, "lower", "m", dimension), read_point(table, "upper", "m", dimension)};
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        if (!(box.lower[a] < box.upper[a])) {
            table.error("upper", fmt::format("must be above lower along {}", "xyz"[a]));
            box.upper[a] = box.lower[a] + 1;
        }
    return box;
}

VelocityField read_velocity_field(const Section& table, int dimension) {
    if (!table.exists()) return {};
    const std::string kind = table.choice("kind", {"sine", "cantilever", "stretch", "radial"});
    if (kind == "cantilever")
        return CantileverVelocity{table.number("clamp", "m"), table.number("length", "m", {}, positive),
                                  table.number("tip_velocity", "m/s")};
    if (kind == "stretch")
        return StretchVelocity{origin_default(table, "centre", "m", dimension),
                               read_point(table, "rate", "s-1", dimension)};
    if (kind == "radial")
        return RadialVelocity{origin_default(table, "centre", "m", dimension), table.number("speed", "m/s"),
                              table.number("radius", "m", 0.0, not_negative)};
    return SineVelocity{read_point(table, "amplitude", "m/s", dimension),
                        read_point(table, "wave_vector", "m-1", dimension),
                        table.number("phase", "rad", 0.0)};
}

/// Spacing from `spacing` or from the wanted number of particles; by default that of the scene's first body,
/// if any.
double read_spacing(const Section& table, const BodyShape& shape, int dimension, double first_spacing) {
    if (table.has("spacing") && table.has("particles"))
        table.error("particles", "give spacing or particles, not both");
    if (table.has("particles")) {
        const auto count = static_cast<double>(table.integer("particles", {}, 1, std::int64_t{1} << 40));
        return std::pow(volume(shape, dimension) / count, 1.0 / dimension);
    }
    if (first_spacing > 0) return table.number("spacing", "m", first_spacing, positive);
    return table.number("spacing", "m", {}, positive);
}

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

}  // namespace

Body read_body(const Section& table, const Material& material, int dimension, const BoxShape& domain,
               double first_spacing) {
    Body body;
    body.name = table.text("name", table.path());
    body.shape = read_shape(table, dimension, domain);
    body.lattice = table.choice("lattice", {"cubic", "close_packed"}, "close_packed") == "cubic"
                       ? Lattice::cubic
                       : Lattice::close_packed;
    body.spacing = read_spacing(table, body.shape, dimension, first_spacing);
    body.jitter = table.number("jitter", "1", 0.0, {0, 0.5});
    body.velocity = origin_default(table, "velocity", "m/s", dimension);
    if (table.has("spin")) {
        if (dimension == 3)
            body.spin = read_point(table, "spin", "rad/s", 3);
        else
            body.spin = {0, 0, table.number("spin", "rad/s")};
    }
    body.velocity_field = read_velocity_field(table.section("velocity_field"), dimension);
    body.density = table.number("density", "kg/m3", material.reference_density, positive);
    body.internal_energy = read_energy(table, material, body.density);
    if (material.fracture) body.damage = table.number("damage", "1", 0.0, {0, 1});
    return body;
}

}  // namespace talus
