#include "src/setup/body_wall_reader.hpp"

#include "src/setup/shape_reader.hpp"
#include "src/setup/wall_reader.hpp"

namespace talus {

std::optional<sph::Wall> read_body_wall(const Section& body, int dimension, bool has_normal) {
    const std::string kind = body.choice("wall", {"none", "no_slip", "free_slip"}, "none");
    if (kind == "none") return {};
    sph::Wall wall;
    if (kind == "free_slip") wall.slip = sph::WallSlip::free_slip;
    const bool keeps_normal = kind == "free_slip" && has_normal;
    if (keeps_normal) {
        const Point normal = read_point(body, "normal", "1", dimension);
        if (const double length = norm(normal); length > 0)
            wall.normal = {normal[0] / length, normal[1] / length, normal[2] / length};
        else
            body.error("normal", "has no direction; it points from the wall into the matter");
    }
    for (const char* key : {"held", "spin", "spin_period", "velocity", "velocity_field"})
        if (body.has(key)) body.error(key, "does not go with wall: [body.motion] says how a wall moves");
    wall.motion = read_motion(body.section("motion"), dimension);
    if (wall.motion.angular_velocity != 0 && keeps_normal)
        body.section("motion").error("angular_velocity",
                                     "a wall that slips keeps its normal: it cannot turn");
    return wall;
}

}  // namespace talus
