#include "physics/dem/clumps/clump_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"
#include "physics/dem/vectors.hpp"

namespace talus::dem {

namespace {

using GrainVectors = Vectors<ParticleSet>;

/// What the spheres of a clump know of it.
struct ClumpFields {
    explicit ClumpFields(ParticleSet& grains)
        : position(grains, field::position),
          centre(grains, field::clump_centre),
          velocity(grains, field::clump_velocity),
          acceleration(grains, field::clump_acceleration),
          angular_momentum(grains, field::clump_angular_momentum),
          torque(grains, field::clump_torque),
          orientation_vector(grains, field::orientation_vector),
          orientation_scalar(grains.data(field::orientation_scalar)) {}

    GrainVectors position, centre, velocity, acceleration, angular_momentum, torque, orientation_vector;
    double* orientation_scalar;

    ClumpState state(std::size_t i) const {
        return {centre[i], velocity[i], {orientation_scalar[i], orientation_vector[i]}, angular_momentum[i]};
    }
    void turn(std::size_t i, const Quaternion& orientation) const {
        orientation_scalar[i] = orientation.scalar;
        orientation_vector.put(i, orientation.vector);
    }
};

constexpr std::uint32_t absent = std::numeric_limits<std::uint32_t>::max();

Vector3<> rounded(const PeriodicPlaces& places, const Vector3<>& v) {
    return {places(0, v.x), places(1, v.y), places(2, v.z)};
}

}  // namespace

ClumpState clump_state(const ParticleSet& grains, std::size_t i) {
    const auto vector = [&](const Field<double>& field) {
        return Vector3<>{grains.data(field, 0)[i], grains.data(field, 1)[i], grains.data(field, 2)[i]};
    };
    return {vector(field::clump_centre),
            vector(field::clump_velocity),
            {grains.data(field::orientation_scalar)[i], vector(field::orientation_vector)},
            vector(field::clump_angular_momentum)};
}

ClumpState moving_clump(const ClumpBody& body, const Vector3<>& centre, const Quaternion& orientation,
                        const Vector3<>& velocity, const Vector3<>& spin) {
    return {centre, velocity, orientation,
            angular_momentum(spin, body.inertia(), RotationMatrix(orientation))};
}

ClumpMotion::ClumpMotion(std::vector<ClumpBody> bodies, std::vector<std::uint8_t> held)
    : bodies_(std::move(bodies)),
      held_(std::move(held)),
      exists_(std::ranges::any_of(bodies_, [](const ClumpBody& body) { return body.shape != nullptr; })) {}

void ClumpMotion::add_fields(ParticleSet& grains) {
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::clump_centre, &field::clump_velocity, &field::clump_acceleration,
             &field::clump_angular_momentum, &field::clump_torque, &field::orientation_scalar,
             &field::orientation_vector, &field::sphere_force, &field::sphere_torque})
        grains.add(*info);
}

double ClumpMotion::greatest_extent() const {
    double extent = 0;
    for (const ClumpBody& body : bodies_)
        if (body.shape) extent = std::max(extent, body.shape->extent);
    return extent;
}

/// Calls visit(i, body, sphere) for the own grains that are spheres of a clump.
template <class Visit>
void ClumpMotion::for_each_sphere(const ParticleSet& grains, Visit&& visit) const {
    if (!exists_) return;
    const std::uint64_t* id = grains.data(field::id);
    const std::uint8_t* body = grains.data(field::body);
    for (std::size_t i = 0; i < grains.size(); ++i)
        if (const ClumpBody* clump = of_body(body[i])) visit(i, *clump, clump->sphere(id[i]));
}

/// Calls visit(some, body, spheres) for the clumps that are not held; `some`: an own sphere.
template <class Visit>
void ClumpMotion::for_each_clump(const ParticleSet& grains, Visit&& visit) const {
    const std::uint8_t* body = grains.data(field::body);
    for (const Spheres& clump : clumps_) {
        const ClumpBody& shape = bodies_[body[clump.some]];
        if (held_[body[clump.some]]) continue;
        visit(clump.some, shape, std::span(spheres_).subspan(clump.begin, shape.shape->radii.size()));
    }
}

namespace {

/// How the spheres of a clump move.
struct Motion {
    RotationMatrix axes;
    Vector3<> velocity, turning;

    Motion(const ClumpBody& body, const ClumpState& state)
        : axes(state.orientation),
          velocity(state.velocity),
          turning(angular_velocity(state.angular_momentum, body.inertia(), axes)) {}

    Vector3<> velocity_at(const Vector3<>& arm) const { return velocity + cross(turning, axes.turned(arm)); }
    void give(const GrainVectors& velocities, const GrainVectors& spins, std::size_t i,
              const Vector3<>& arm) const {
        spins.put(i, turning);
        velocities.put(i, velocity_at(arm));
    }
};

}  // namespace

void place_new_sphere(ParticleSet& grains, std::size_t i, const ClumpBody& body, std::size_t sphere,
                      const ClumpState& state) {
    const ClumpFields clump(grains);
    clump.centre.put(i, state.centre);
    clump.velocity.put(i, state.velocity);
    clump.angular_momentum.put(i, state.angular_momentum);
    clump.turn(i, state.orientation);
    const Vector3<>& arm = body.shape->centres[sphere];
    clump.position.put(i, state.centre + RotationMatrix(state.orientation).turned(arm));
    Motion(body, state).give({grains, field::velocity}, {grains, field::angular_velocity}, i, arm);
    grains.data(field::radius)[i] = body.shape->radii[sphere];
    grains.data(field::mass)[i] = body.mass();
}

void ClumpMotion::start(ParticleSet& grains, const PeriodicPlaces& places, std::size_t first) const {
    if (!exists_) return;
    const ClumpFields clump(grains);
    for_each_sphere(grains, [&](std::size_t i, const ClumpBody& body, std::size_t sphere) {
        if (i < first) return;
        const ClumpState state = clump.state(i);
        const Vector3<> centre = rounded(places, state.centre),
                        arm = RotationMatrix(state.orientation).turned(body.shape->centres[sphere]);
        clump.centre.put(i, centre);
        clump.position.put(i, centre + rounded(places, arm));
    });
}

void ClumpMotion::drift(ParticleSet& grains, double time_step, const PeriodicPlaces& places,
                        const Shear* shear) const {
    if (!exists_) return;
    const ClumpFields clump(grains);
    const auto own = static_cast<std::uint32_t>(grains.size());
    for_each_clump(
        grains, [&](std::size_t some, const ClumpBody& body, std::span<const std::uint32_t> spheres) {
            const ClumpState state = clump.state(some);
            const Vector3<> moved =
                rounded(places, time_step * (state.velocity + (0.5 * time_step) * clump.acceleration[some]));
            const Vector3<> momentum = state.angular_momentum + (0.5 * time_step) * clump.torque[some];
            const Quaternion turned = turned_freely(state.orientation, momentum, body.inertia(), time_step);
            const RotationMatrix axes(turned);
            for (std::size_t k = 0; k < spheres.size(); ++k) {
                const std::uint32_t i = spheres[k];
                if (i >= own) continue;
                // Spheres on both sides of a periodic boundary each have their own image of the centre.
                Vector3<> centre = clump.centre[i] + moved;
                if (shear) {
                    const double before = shear->turns_of(clump.centre[i].y);
                    centre.x += before * shear->advance();
                    Vector3<> velocity = state.velocity;
                    velocity.x -= (shear->turns_of(centre.y) - before) * shear->velocity();
                    clump.velocity.put(i, velocity);
                }
                clump.centre.put(i, centre);
                clump.turn(i, turned);
                clump.position.put(i, centre + rounded(places, axes.turned(body.shape->centres[k])));
            }
        });
}

void ClumpMotion::predict(ParticleSet& grains, double time_step, GrainRows& rows, const Shear* shear) const {
    if (!exists_) return;
    const ClumpFields clump(grains);
    const auto own = static_cast<std::uint32_t>(grains.size());
    for_each_clump(
        grains, [&](std::size_t some, const ClumpBody& body, std::span<const std::uint32_t> spheres) {
            ClumpState state = clump.state(some);
            state.velocity += time_step * clump.acceleration[some];
            state.angular_momentum += time_step * clump.torque[some];
            const Motion motion(body, state);
            for (std::size_t k = 0; k < spheres.size(); ++k) {
                if (spheres[k] >= own) continue;
                Vector3<> velocity = motion.velocity_at(body.shape->centres[k]);
                if (shear)
                    velocity.x = shear->placed(velocity.x, shear->turns_of(clump.centre[spheres[k]].y));
                rows.put_velocities(spheres[k], velocity, motion.turning);
            }
        });
}

void ClumpMotion::bring_centres_back(ParticleSet& grains, const Shear& shear) const {
    if (!exists_) return;
    const ClumpFields clump(grains);
    for_each_sphere(grains, [&](std::size_t i, const ClumpBody&, std::size_t) {
        clump.centre.put(i, shear.brought_back(clump.centre[i], shear.turns_of(clump.position[i].y)));
    });
}

double ClumpMotion::rotational_energy(const ParticleSet& grains, std::size_t i) const {
    const ClumpState state = clump_state(grains, i);
    return 0.5 * dot(state.angular_momentum,
                     angular_velocity(state.angular_momentum, of_body(grains.data(field::body)[i])->inertia(),
                                      RotationMatrix(state.orientation)));
}

std::function<bool(std::uint32_t, std::uint32_t)> ClumpMotion::inner_pairs(const ParticleSet& grains) const {
    if (!exists_) return {};
    return [this, id = grains.data(field::copied_id), body = grains.data(field::body)](std::uint32_t i,
                                                                                       std::uint32_t j) {
        const ClumpBody* clump = body[i] == body[j] ? of_body(body[i]) : nullptr;
        return clump && id[i] - clump->sphere(id[i]) == id[j] - clump->sphere(id[j]);
    };
}

std::uint64_t ClumpMotion::find_spheres(const ParticleSet& grains) {
    const std::uint64_t missing = list_spheres(grains);
    if (missing != everybody) clumps_.clear();  // nobody can move them
    return missing;
}

std::uint64_t ClumpMotion::list_spheres(const ParticleSet& grains) {
    clumps_.clear();
    spheres_.clear();
    if (!exists_) return everybody;
    const std::uint64_t *id = grains.data(field::id), *copied_id = grains.data(field::copied_id);
    const std::uint8_t* body = grains.data(field::body);
    std::unordered_map<std::uint64_t, std::uint32_t> stored;
    for (std::uint32_t i = 0; i < grains.size_with_halo(); ++i)
        if (of_body(body[i])) stored.emplace(i < grains.size() ? id[i] : copied_id[i], i);
    std::uint64_t missing = everybody;
    for_each_sphere(grains, [&](std::size_t i, const ClumpBody& clump, std::uint64_t sphere) {
        const std::uint64_t first = id[i] - sphere;
        // The first own sphere of a clump lists it.
        for (std::uint64_t k = 0; k < sphere; ++k)
            if (const auto found = stored.find(first + k);
                found != stored.end() && found->second < grains.size())
                return;
        clumps_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(spheres_.size())});
        for (std::uint64_t k = 0; k < clump.shape->radii.size(); ++k) {
            const auto found = stored.find(first + k);
            if (found == stored.end()) missing = std::min(missing, id[i]);
            spheres_.push_back(found == stored.end() ? absent : found->second);
        }
    });
    return missing;
}

void ClumpMotion::take_forces(ParticleSet& grains, std::span<const ForceSum> sums,
                              std::span<const double> units) const {
    const double* radius = grains.data(field::radius);
    const GrainVectors sphere_force(grains, field::sphere_force), sphere_torque(grains, field::sphere_torque);
    for_each_sphere(grains, [&](std::size_t i, const ClumpBody&, std::size_t) {
        const auto vector = [](const std::int64_t* sum, double unit) {
            return Vector3<>{unit * static_cast<double>(sum[0]), unit * static_cast<double>(sum[1]),
                             unit * static_cast<double>(sum[2])};
        };
        sphere_force.put(i, vector(sums[i].force, units[i]));
        sphere_torque.put(i, vector(sums[i].torque, units[i] * radius[i]));
    });
}

void ClumpMotion::add_gravity_fields(ParticleSet& grains) {
    grains.add(field::attracting_mass);
    grains.add(field::sphere_attraction);
}

void ClumpMotion::share_masses(ParticleSet& grains) const {
    std::ranges::copy(grains.own(field::mass), grains.data(field::attracting_mass));
    for_each_sphere(grains, [&](std::size_t i, const ClumpBody& body, std::size_t sphere) {
        grains.data(field::attracting_mass)[i] = body.mass() * body.shape->mass_shares[sphere];
    });
}

void ClumpMotion::take_attraction(ParticleSet& grains) const {
    const GrainVectors of_all(grains, field::gravity_acceleration),
        of_spheres(grains, field::sphere_attraction);
    for (std::size_t i = 0; i < grains.size(); ++i) of_spheres.put(i, of_all[i]);
}

ClumpMotion::Attraction ClumpMotion::attraction(ParticleSet& grains, const ClumpBody& body,
                                                const RotationMatrix& axes,
                                                std::span<const std::uint32_t> spheres) const {
    const GrainVectors of_spheres(grains, field::sphere_attraction);
    Attraction sum;
    for (std::size_t k = 0; k < spheres.size(); ++k) {
        const Vector3<> given = body.shape->mass_shares[k] * of_spheres[spheres[k]];
        sum.acceleration += given;
        sum.torque += body.mass() * cross(axes.turned(body.shape->centres[k]), given);
    }
    return sum;
}

void ClumpMotion::kick_by_attraction(ParticleSet& grains, double time) const {
    const ClumpFields clump(grains);
    const auto own = static_cast<std::uint32_t>(grains.size());
    for_each_clump(
        grains, [&](std::size_t some, const ClumpBody& body, std::span<const std::uint32_t> spheres) {
            const ClumpState state = clump.state(some);
            const Attraction given = attraction(grains, body, RotationMatrix(state.orientation), spheres);
            for (const std::uint32_t i : spheres) {
                if (i >= own) continue;
                clump.velocity.put(i, state.velocity + time * given.acceleration);
                clump.angular_momentum.put(i, state.angular_momentum + time * given.torque);
            }
        });
}

ClumpMotion::Path ClumpMotion::finish_step(ParticleSet& grains, const Responses& responses,
                                           const Vector3<>& gravity, const Impulse& impulse, double kick_step,
                                           double time_step, double remaining, const Shear* shear) const {
    if (!exists_) return {};
    const ClumpFields clump(grains);
    const GrainVectors sphere_force(grains, field::sphere_force), sphere_torque(grains, field::sphere_torque),
        sphere_velocity(grains, field::velocity), sphere_spin(grains, field::angular_velocity);
    const auto own = static_cast<std::uint32_t>(grains.size());
    const double half_kick = 0.5 * kick_step, half_step = 0.5 * time_step;
    double most = 0, bent = 0, spoilt = 0;  // the last 0 unless a value is infinite or NaN
    for_each_clump(grains, [&](std::size_t some, const ClumpBody& body,
                               std::span<const std::uint32_t> spheres) {
        ClumpState state = clump.state(some);
        const RotationMatrix axes(state.orientation);
        Vector3<> force, torque;
        for (std::size_t k = 0; k < spheres.size(); ++k) {
            const Vector3<> on_sphere = sphere_force[spheres[k]];
            force += on_sphere;
            torque += sphere_torque[spheres[k]] + cross(axes.turned(body.shape->centres[k]), on_sphere);
        }
        const Vector3<> now = (1 / body.mass()) * force + gravity;
        state.velocity = remaining * (state.velocity + half_kick * (clump.acceleration[some] + now));
        state.angular_momentum =
            remaining * (state.angular_momentum + half_kick * (clump.torque[some] + torque));
        ClumpState next = state;  // what the next drift begins with
        if (impulse.next > 0) {
            const Attraction given = attraction(grains, body, axes, spheres);
            state.velocity += impulse.now * given.acceleration;
            state.angular_momentum += impulse.now * given.torque;
            next.velocity = state.velocity + impulse.next * given.acceleration;
            next.angular_momentum = state.angular_momentum + impulse.next * given.torque;
        }
        const Motion motion(body, state);

        // Each of the angles by which turned_freely() turns is at most time x momentum over moment.
        const double momentum = norm(next.angular_momentum) + half_step * norm(torque);
        const Vector3<> moments = body.inertia();
        const double angle = 3 * time_step * momentum / std::min({moments.x, moments.y, moments.z});
        const double along = time_step * (norm(next.velocity) + half_step * norm(now));
        for (std::size_t k = 0; k < spheres.size(); ++k) {
            const std::uint32_t i = spheres[k];
            if (i >= own) continue;
            clump.velocity.put(i, state.velocity);
            clump.acceleration.put(i, now);
            clump.angular_momentum.put(i, state.angular_momentum);
            clump.torque.put(i, torque);
            motion.give(sphere_velocity, sphere_spin, i, body.shape->centres[k]);
            const Vector3<> arm = body.shape->centres[k];
            if (shear) {
                Vector3<> velocity = sphere_velocity[i];
                velocity.x += (shear->turns_of(clump.centre[i].y) - shear->turns_of(clump.position[i].y)) *
                              shear->velocity();
                sphere_velocity.put(i, velocity);
            }
            const Vector3<> start{responses.start[0][i], responses.start[1][i], responses.start[2][i]};
            const double moved = norm(clump.position[i] - start) + along + angle * norm(arm);
            spoilt += moved * 0.0;
            most = std::max(most, moved);
            bent = std::max(bent, time_step * half_step * norm(now) + 2 * angle * norm(arm));
        }
    });
    if (spoilt != 0) return {std::numeric_limits<double>::infinity(), 0};
    return {most * most, bent};
}

}  // namespace talus::dem
