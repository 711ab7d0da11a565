#include "src/setup/hard_impacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "domain/grain_fields.hpp"
#include "physics/dem/laws/time_step.hpp"
#include "physics/dem/pressed_contacts.hpp"
#include "src/setup/shapes.hpp"

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What of a body counts in an impact.
struct Impactor {
    std::string name;
    std::uint8_t material = 0;
    bool is_wall = false;
    double least_radius = 0, least_mass = 0, greatest_radius = 0, greatest_mass = 0;
    dem::Vector3<> velocity{};  ///< the middle of all
    double spread = 0;          ///< of it, at most [m/s]
    double highest = 0;         ///< against gravity, above the lowest of all grains [m]
};

double sphere_mass(double radius, double density) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;
}

/// Height of a place: against gravity, 0 without [m].
class Heights {
  public:
    explicit Heights(const GrainSetup& setup) : strength_(norm(setup.gravity)) {
        const std::array<double, 3> g{setup.gravity.x, setup.gravity.y, setup.gravity.z};
        for (std::size_t a = 0; a < 3; ++a)
            if (g[a] != 0 && setup.box.boundary[a] != Boundary::open) strength_ = 0;
        if (strength_ > 0) up_ = (-1 / strength_) * setup.gravity;
    }
    double operator()(const dem::Vector3<>& place) const { return dot(up_, place); }
    double squared_speed(double fall) const { return 2 * strength_ * std::max(fall, 0.0); }

  private:
    double strength_;
    dem::Vector3<> up_;
};

std::vector<Impactor> impactors_of(const Communicator& comm, const GrainScene& scene,
                                   const ParticleSet& grains, const Heights& height) {
    enum Which : std::size_t { vx, vy, vz, radius, mass, above, count };
    const std::size_t bodies = scene.bodies.size();
    std::vector<double> most(bodies * 2 * count, -infinity);
    const auto include = [&](std::size_t body, std::size_t which, double value) {
        double* at = &most[2 * (body * count + which)];
        at[0] = std::max(at[0], value);
        at[1] = std::max(at[1], -value);
    };
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const auto value = [&](const Field<double>& field, int axis) { return grains.data(field, axis)[i]; };
        const std::size_t b = grains.data(field::body)[i];
        for (int axis = 0; axis < 3; ++axis)
            include(b, vx + static_cast<std::size_t>(axis), value(field::velocity, axis));
        include(b, radius, grains.data(field::radius)[i]);
        include(b, mass, grains.data(field::mass)[i]);
        include(b, above,
                height({value(field::position, 0), value(field::position, 1), value(field::position, 2)}));
    }
    comm.all_max(std::span<double>(most));
    for (const GrainSource& source : scene.simulation.flow.sources) {
        const GrainBody& body = scene.bodies[source.body];
        for (std::size_t a = 0; a < 3; ++a) include(source.body, vx + a, source.velocity[a]);
        for (const double r : {body.least_radius, body.greatest_radius}) {
            include(source.body, radius, r);
            include(source.body, mass,
                    source.clump ? source.density * source.clump->volume : sphere_mass(r, source.density));
        }
        const BoxShape room = bounds(source.region, 3);
        for (int corner = 0; corner < 8; ++corner) {
            const auto side = [&](std::size_t a) {
                return (corner >> a & 1) != 0 ? room.upper[a] : room.lower[a];
            };
            include(source.body, above, height({side(0), side(1), side(2)}));
        }
    }
    double lowest = infinity;
    for (std::size_t b = 0; b < bodies; ++b) lowest = std::min(lowest, -most[2 * (b * count + above) + 1]);
    std::vector<Impactor> found;
    for (std::size_t b = 0; b < bodies; ++b) {
        const auto greatest = [&](std::size_t which) { return most[2 * (b * count + which)]; };
        const auto least = [&](std::size_t which) { return -most[2 * (b * count + which) + 1]; };
        if (greatest(radius) < 0) continue;  // no grains
        const dem::Vector3<> upper{greatest(vx), greatest(vy), greatest(vz)},
            lower{least(vx), least(vy), least(vz)};
        found.push_back({.name = scene.bodies[b].name,
                         .material = scene.simulation.material[b],
                         .is_wall = false,
                         .least_radius = least(radius),
                         .least_mass = least(mass),
                         .greatest_radius = greatest(radius),
                         .greatest_mass = greatest(mass),
                         .velocity = 0.5 * (upper + lower),
                         .spread = 0.5 * norm(upper - lower),
                         .highest = greatest(above) - lowest});
    }
    for (const dem::Wall& wall : scene.simulation.walls)
        found.push_back({.name = wall.name, .material = wall.material, .is_wall = true});
    return found;
}

/// The shortest collision.
struct Worst {
    double steps = infinity, speed = 0;
    std::string pair;
    void see(double duration_in_steps, double at_speed, const Impactor& a, const Impactor& b) {
        if (!(duration_in_steps < steps)) return;
        steps = duration_in_steps;
        speed = at_speed;
        pair = fmt::format("'{}' and '{}'", a.name, b.name);
    }
};

/// Least stable step while the grain is pressed in from both sides up to `deepest` [s].
double borne_when_caught(const dem::AnyLawTable& laws, const Impactor& mover, const Impactor& caught,
                         double deepest) {
    constexpr int depths = 32;
    const double r = caught.least_radius, m = caught.least_mass;
    const double R = r * mover.greatest_radius / (r + mover.greatest_radius),
                 effective = m * mover.greatest_mass / (m + mover.greatest_mass);
    double least = infinity;
    for (int k = 1; k <= depths; ++k) {
        const double overlap = deepest * k / depths;
        const dem::PressedContact contact =
            dem::pressed_contact(laws, mover.material, caught.material, overlap, R, effective);
        dem::PressedGrain grain;
        for (int side = 0; side < 2; ++side) grain.add(contact, dem::contact_arm(r, overlap) / r);
        least = std::min(least, grain.stable_step(m));
    }
    return least;
}

}  // namespace

ImpactFindings find_hard_impacts(const Communicator& comm, const GrainScene& scene,
                                 const ParticleSet& grains) {
    constexpr double fewest_steps = 6, enough_steps = 10;
    const GrainSetup& setup = scene.simulation;
    ImpactFindings found;
    if (setup.box.shear_rate != 0 || !dem::effective_modulus(setup.laws, 0, 0)) return found;
    const Heights height(setup);
    const std::vector<Impactor> all = impactors_of(comm, scene, grains, height);
    Worst named, likely;
    struct Caught {
        double step = infinity, overlap = 0, speed = 0;
        const Impactor *mover = nullptr, *grain = nullptr;
    } caught;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = 0; j < all.size(); ++j) {
            const Impactor &a = all[i], &b = all[j];  // a strikes b
            if (a.is_wall) continue;
            const double modulus = *dem::effective_modulus(setup.laws, a.material, b.material);
            const double R = b.is_wall ? a.least_radius
                                       : a.least_radius * b.least_radius / (a.least_radius + b.least_radius),
                         m = b.is_wall ? a.least_mass
                                       : a.least_mass * b.least_mass / (a.least_mass + b.least_mass);
            const double meeting = norm(a.velocity - b.velocity);
            const double fastest = std::sqrt(std::pow(meeting + a.spread + b.spread, 2) +
                                             height.squared_speed(std::max(a.highest, b.highest)));
            const auto steps = [&](double speed) {
                return speed > 0 ? dem::hertz_collision_time(modulus, R, m, speed) / setup.time_step
                                 : infinity;
            };
            named.see(steps(meeting), meeting, a, b);
            likely.see(steps(fastest), fastest, a, b);
            if (b.is_wall || !(fastest > 0)) continue;
            const double r = b.least_radius, radius = r * a.greatest_radius / (r + a.greatest_radius);
            // Half of the energy in each of two contacts, but not deeper than to the middle.
            const double overlap = std::min(r, std::pow(15 * 0.5 * a.greatest_mass * fastest * fastest /
                                                            (16 * modulus * std::sqrt(radius)),
                                                        0.4));
            if (const double step = borne_when_caught(setup.laws, a, b, overlap); step < caught.step)
                caught = {step, overlap / r, fastest, &a, &b};
        }
    const auto lasts = [&](const Worst& worst, double enough) {
        return fmt::format(
            "a collision of {} at {:.3g} m/s lasts {:.3g} steps of {:.4g} s, too few for the "
            "restitution of the materials; {} {:.3g} s",
            worst.pair, worst.speed, worst.steps, setup.time_step,
            enough == fewest_steps ? "allowed: at most" : "dem.time_step =",
            worst.steps / enough * setup.time_step);
    };
    if (named.steps < fewest_steps)
        found.faults.push_back(lasts(named, fewest_steps));
    else if (likely.steps < enough_steps)
        found.warnings.push_back(lasts(likely, enough_steps));
    if (setup.time_step > caught.step)
        found.warnings.push_back(fmt::format(
            "a grain of '{}' caught under one of '{}' that comes with {:.3g} m/s is pressed in by up to "
            "{:.2g} "
            "of its radius and bears steps of {:.3g} s, not {:.4g} s: it would shake and spoil the rebound; "
            "dem.time_step = {:.2g} s",
            caught.grain->name, caught.mover->name, caught.speed, caught.overlap, caught.step,
            setup.time_step, 0.8 * caught.step));
    return found;
}

}  // namespace talus
