#include "src/setup/impact.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/setup/contact.hpp"

namespace talus {

namespace {

/// Angle and distance at contact; nothing if the bodies miss each other.
std::optional<Contact> find_contact(const ImpactPlan& plan, const BodyShape& target,
                                    const BodyShape& impactor, int dimension) {
    if (!plan.offset) {
        const Point line{std::cos(plan.angle), std::sin(plan.angle), 0};
        const auto distance = contact_distance(target, impactor, line, {}, dimension);
        if (!distance) return {};
        return Contact{*distance, plan.angle, 0};
    }
    const auto ahead = contact_distance(target, impactor, {1, 0, 0}, {0, *plan.offset, 0}, dimension);
    if (!ahead || *ahead < 0) return {};
    return Contact{std::hypot(*ahead, *plan.offset), std::atan2(*plan.offset, *ahead), 0};
}

void move_to(Body& body, BodyCensus& census, const Point& by) {
    body.shape = moved(body.shape, by);
    census.centre_of_mass = plus(census.centre_of_mass, by);
}

}  // namespace

std::optional<RelativeState> state_before(const Contact& contact, double distance,
                                          double gravitational_parameter) {
    const double cosine = std::cos(contact.angle), sine = std::sin(contact.angle);
    const double tangential = contact.speed * contact.distance * sine / distance;
    const double speed2 =
        contact.speed * contact.speed - 2 * gravitational_parameter * (1 / contact.distance - 1 / distance);
    const double radial2 = speed2 - tangential * tangential;
    if (radial2 < 0) return {};
    const double radial = -std::sqrt(radial2);
    double turned = std::asin(std::min(1.0, contact.distance * sine / distance)) - contact.angle;
    if (gravitational_parameter > 0 && sine > 0) {
        // e (cos f, sin f) of the true anomaly f = (p/r - 1, v_r L/mu), with p = L^2/mu.
        const double L = contact.distance * contact.speed * sine, p = L * L / gravitational_parameter;
        const auto anomaly = [&](double r, double inward) {
            return std::atan2(inward * L / gravitational_parameter, p / r - 1);
        };
        turned = anomaly(distance, radial) - anomaly(contact.distance, -contact.speed * cosine);
    }
    const double c = std::cos(contact.angle + turned), s = std::sin(contact.angle + turned);
    return RelativeState{{distance * c, distance * s, 0},
                         {radial * c - tangential * s, radial * s + tangential * c, 0}};
}

PlannedImpact plan_impact(const ImpactPlan& plan, const std::vector<Body>& bodies,
                          const std::vector<BodyCensus>& census, int dimension) {
    const Body &target = bodies[plan.target], &impactor = bodies[plan.impactor];
    const double target_mass = census[plan.target].mass, impactor_mass = census[plan.impactor].mass,
                 both = target_mass + impactor_mass;
    const auto contact = find_contact(plan, target.shape, impactor.shape, dimension);
    if (!contact)
        return {{}, plan.offset ? "offset" : "angle", "at this offset or angle the bodies pass each other"};

    Impact impact{.plan = plan, .contact = *contact};
    const double mu = plan.gravitational_constant * both;
    impact.escape_speed = std::sqrt(2 * mu / contact->distance);
    impact.contact.speed = plan.speed_at_infinity ? std::hypot(plan.speed, impact.escape_speed) : plan.speed;
    const double speed2 = impact.contact.speed * impact.contact.speed;
    impact.speed_at_infinity = std::sqrt(std::max(0.0, speed2 - impact.escape_speed * impact.escape_speed));
    impact.impact_parameter = contact->distance * std::sin(contact->angle);
    impact.specific_energy = 0.5 * speed2 * target_mass / both * (impactor_mass / both);
    impact.energy_per_target = 0.5 * speed2 * impactor_mass / target_mass;

    const double spacing = std::max(target.spacing, impactor.spacing);
    const double start = plan.distance.value_or(contact->distance + plan.gap * spacing);
    if (start < contact->distance)
        return {{}, "distance", fmt::format("the bodies touch at {:.6g} m", contact->distance)};
    const auto before = state_before(impact.contact, start, plan.along_orbit ? mu : 0);
    if (!before)
        return {
            {},
            plan.distance ? "distance" : "gap",
            fmt::format(
                "at {:.6g} m/s, below the escape speed of {:.6g} m/s, the bodies never were {:.6g} m apart",
                impact.contact.speed, impact.escape_speed, start)};
    impact.start = *before;
    return {impact, {}, {}};
}

void place(const Impact& impact, std::vector<Body>& bodies, std::vector<BodyCensus>& census) {
    const std::size_t t = impact.plan.target, i = impact.plan.impactor;
    const double share =
        impact.plan.centre_of_mass_frame ? census[i].mass / (census[t].mass + census[i].mass) : 0;
    bodies[t].velocity = times(-share, impact.start.velocity);
    bodies[i].velocity = times(1 - share, impact.start.velocity);
    move_to(bodies[i], census[i], impact.start.position);
    if (!impact.plan.centre_of_mass_frame) return;
    const Point middle =
        plus(times(1 - share, census[t].centre_of_mass), times(share, census[i].centre_of_mass));
    move_to(bodies[t], census[t], times(-1, middle));
    move_to(bodies[i], census[i], times(-1, middle));
}

}  // namespace talus
