#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "src/setup/bodies.hpp"

namespace talus {

/// How one body of a scene meets another; the scene's [impact] table (docs/scene.md).
struct ImpactPlan {
    std::size_t target = 0, impactor = 1;  ///< indices of bodies
    double speed = 0;                      ///< relative speed [m/s]
    bool speed_at_infinity = false;        ///< else at contact
    double angle = 0;                      ///< at contact, between the velocity and the line of centres [rad]
    std::optional<double> offset{};        ///< at contact, instead of the angle [m]
    double gap = 1;                        ///< between the surfaces at the start, in spacings [1]
    std::optional<double> distance{};      ///< of the centres at the start, instead of the gap [m]
    bool along_orbit = false;              ///< back from contact under mutual gravity, else straight
    bool centre_of_mass_frame = true;      ///< else that of the target
    double gravitational_constant = newton_constant;  ///< [m3 kg-1 s-2]
};

/// Two bodies at the moment that they touch.
struct Contact {
    double distance;  ///< of their centres [m]
    double angle;     ///< between the relative velocity and the line of centres, 0 head-on [rad]
    double speed;     ///< relative [m/s]
};

/// Position and velocity of the impactor's centre relative to the target's. The velocity at contact is along
/// -x, the impact parameter along y.
struct RelativeState {
    Point position;  ///< [m]
    Point velocity;  ///< [m/s]
};

/// The state from which two bodies come into contact, at a greater distance of their centres: back in time on
/// the Kepler orbit of two points, or straight if `gravitational_parameter` G (m1 + m2) [m3/s2] is zero.
/// Nothing if they never were that far apart.
std::optional<RelativeState> state_before(const Contact& contact, double distance,
                                          double gravitational_parameter);

/// An impact as it will be, for people.
struct Impact {
    ImpactPlan plan;
    Contact contact{};
    double impact_parameter = 0;   ///< contact.distance sin(angle) [m]
    double escape_speed = 0;       ///< of the two bodies from contact [m/s]
    double speed_at_infinity = 0;  ///< 0 if bound [m/s]
    double specific_energy = 0;    ///< kinetic, in the centre-of-mass frame, over the mass of both [J/kg]
    double energy_per_target = 0;  ///< kinetic, of the impactor, over the target's mass [J/kg]
    RelativeState start{};
};

/// What a plan comes to for given bodies, or in words why it cannot be. `bodies` must lie around the origin.
struct PlannedImpact {
    std::optional<Impact> impact{};
    std::string key, fault;  ///< what is wrong with which key of the table
};
PlannedImpact plan_impact(const ImpactPlan& plan, const std::vector<Body>& bodies,
                          const std::vector<BodyCensus>& census, int dimension);

/// Moves the two bodies of an impact to where they start and gives them their velocities. In the
/// centre-of-mass frame the momentum and the first moment of their particles vanish.
void place(const Impact& impact, std::vector<Body>& bodies, std::vector<BodyCensus>& census);

}  // namespace talus
