#include "src/setup/buffer_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <variant>

namespace talus {

namespace {

/// The axis and the sense in which water flows through.
void read_direction(const Section& table, const Box& box, water::Buffer& buffer) {
    const std::string found = box.dimension == 2
                                  ? table.choice("direction", {"+x", "-x", "+y", "-y"})
                                  : table.choice("direction", {"+x", "-x", "+y", "-y", "+z", "-z"});
    buffer.sign = found.front() == '+' ? 1 : -1;
    buffer.axis = found.back() - 'x';
    if (box.boundary[static_cast<std::size_t>(buffer.axis)] != Boundary::open)
        table.error("direction", fmt::format("is along {}, where the box is closed; allowed: along axes with "
                                             "box.boundaries \"open\"",
                                             found.back()));
}

InflowProfile read_profile(const Section& table, const water::Buffer& buffer, int dimension) {
    InflowProfile profile;
    if (table.has("speed")) {
        profile.speeds = {table.number("speed", "m/s", {}, {0})};
        if (table.has("speeds")) table.error("speeds", "does not go with speed");
        return profile;
    }
    const std::string usual(1, "xyz"[(buffer.axis + 1) % dimension]);
    profile.across = table.choice("across", {"x", "y", "z"}, usual).front() - 'x';
    if (profile.across == buffer.axis || profile.across >= dimension)
        table.error("across",
                    fmt::format("is not an axis across the inflow, which is along {}", "xyz"[buffer.axis]));
    profile.places = table.numbers("places", "m", 0);
    profile.speeds = table.numbers("speeds", "m/s", profile.places.size());
    if (profile.places.size() < 2 || !std::is_sorted(profile.places.begin(), profile.places.end()))
        table.error("places", "must be two or more, rising");
    if (std::any_of(profile.speeds.begin(), profile.speeds.end(), [](double speed) { return speed < 0; }))
        table.error("speeds", "must not be negative: they are along `direction`");
    return profile;
}

}  // namespace

double InflowProfile::speed(const Point& x) const {
    if (places.empty()) return speeds.front();
    const double at = x[static_cast<std::size_t>(across)];
    if (at <= places.front()) return speeds.front();
    if (at >= places.back()) return speeds.back();
    const auto above =
        static_cast<std::size_t>(std::upper_bound(places.begin(), places.end(), at) - places.begin());
    const double share = (at - places[above - 1]) / (places[above] - places[above - 1]);
    return (1 - share) * speeds[above - 1] + share * speeds[above];
}

OpenEnd read_open_end(const Section& table, const Body& body, const Box& box) {
    OpenEnd end;
    const Section inflow = table.section("inflow"), outflow = table.section("outflow");
    if (!inflow.exists() && !outflow.exists()) return end;
    if (inflow.exists() && outflow.exists())
        table.error("outflow", "does not go with inflow of the same body");
    const Section& found = inflow.exists() ? inflow : outflow;
    water::Buffer& buffer = end.buffer;
    buffer.kind = inflow.exists() ? water::Buffer::Kind::inflow : water::Buffer::Kind::outflow;
    read_direction(found, box, buffer);
    if (inflow.exists()) {
        end.profile = read_profile(inflow, buffer, box.dimension);
        for (const char* key : {"velocity", "velocity_field", "spin", "spin_period"})
            if (table.has(key)) table.error(key, "does not go with inflow: inflow.speed says how fast it is");
    } else {
        buffer.holds_pressure = outflow.choice("pressure", {"held", "free"}, "held") == "held";
    }
    if (table.has("surface")) buffer.surface = table.number("surface", "m");
    if (const auto* shape = std::get_if<BoxShape>(&body.shape)) {
        buffer.lower = shape->lower;
        buffer.upper = shape->upper;
    } else {
        table.error("shape", "of an inflow or outflow must be \"box\"");
    }
    return end;
}

}  // namespace talus
