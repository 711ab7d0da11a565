#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "domain/particles.hpp"
#include "physics/dem/clumps/clump_shape.hpp"
#include "physics/dem/clumps/rotation.hpp"
#include "physics/dem/force_sum.hpp"
#include "physics/dem/grain_rows.hpp"
#include "physics/dem/motion.hpp"
#include "physics/dem/shear.hpp"

namespace talus::dem {

/// What the grains of a body are spheres of: a clump of n spheres has n ids one after the other.
struct ClumpBody {
    std::shared_ptr<const ClumpShape> shape;  ///< none: its grains are spheres of their own
    std::uint64_t first_id = 0;               ///< of the body
    double density = 0;                       ///< [kg/m3]

    std::uint64_t sphere(std::uint64_t id) const { return (id - first_id) % shape->radii.size(); }
    /// The first id at or above `id` that the first sphere of a clump may have.
    std::uint64_t first_from(std::uint64_t id) const {
        return sphere(id) == 0 ? id : id + shape->radii.size() - sphere(id);
    }
    double mass() const { return density * shape->volume; }         ///< of a clump [kg]
    Vector3<> inertia() const { return density * shape->inertia; }  ///< principal moments [kg m2]
};

/// State of a clump, of which each of its spheres has a copy of its own.
struct ClumpState {
    Vector3<> centre, velocity;  ///< [m], [m/s]
    Quaternion orientation;      ///< turns the principal axes into place
    Vector3<> angular_momentum;  ///< about the centre [kg m2/s]
};
ClumpState clump_state(const ParticleSet& grains, std::size_t i);

/// A clump of this orientation that moves with `velocity` [m/s] and turns with `spin` [rad/s].
ClumpState moving_clump(const ClumpBody& body, const Vector3<>& centre, const Quaternion& orientation,
                        const Vector3<>& velocity, const Vector3<>& spin);

/// Makes grain i a sphere of a new clump: all its fields but id and body.
void place_new_sphere(ParticleSet& grains, std::size_t i, const ClumpBody& body, std::size_t sphere,
                      const ClumpState& state);

/// Moves spheres of clumps as the rigid bodies they belong to. Every sphere is a grain with contacts of its
/// own; every rank that owns one computes the motion of the whole clump from the forces on all its spheres,
/// in their order: all to the same bits, whoever owns them. The mass of each is that of its clump: what a
/// contact feels.
class ClumpMotion {
  public:
    /// One entry a body; `held`: one a body, 1 if its clumps never move.
    ClumpMotion(std::vector<ClumpBody> bodies, std::vector<std::uint8_t> held);

    static void add_fields(ParticleSet& grains);
    bool exists() const { return exists_; }
    /// Null for a body of single spheres.
    const ClumpBody* of_body(std::uint8_t body) const {
        return exists_ && bodies_[body].shape ? &bodies_[body] : nullptr;
    }
    /// Greatest distance of two spheres of a clump: so far must copies reach [m].
    double greatest_extent() const;

    /// Whether a grain stands for all of its clump where clumps are counted; those that are spheres of their
    /// own do.
    bool counts(std::uint8_t body, std::uint64_t id) const {
        const ClumpBody* clump = of_body(body);
        return !clump || clump->sphere(id) == 0;
    }

    /// Brings the spheres of new clumps, stored from `first` on, to places that PeriodicPlaces allows.
    void start(ParticleSet& grains, const PeriodicPlaces& places, std::size_t first = 0) const;
    /// After the drift of the spheres for themselves, which it replaces. In a sheared box clump_velocity is
    /// always that of the image of the centre within the box, and changes at the step at which the centre
    /// crosses, for all spheres at once, wherever they are themselves.
    void drift(ParticleSet& grains, double time_step, const PeriodicPlaces& places, const Shear* shear) const;
    /// Velocities of the end of the step, as GrainRows::predict() and, in a sheared box,
    /// Shear::place_velocities() after it.
    void predict(ParticleSet& grains, double time_step, GrainRows& rows, const Shear* shear) const;
    /// Centres along with their spheres, before Shear::bring_back().
    void bring_centres_back(ParticleSet& grains, const Shear& shear) const;

    /// Which pairs are of spheres of one clump; empty without clumps.
    std::function<bool(std::uint32_t, std::uint32_t)> inner_pairs(const ParticleSet& grains) const;
    /// After the order of grains has changed: finds the spheres of the clumps. Returns the id of a grain of
    /// which one is neither own nor a copy, or `everybody`.
    std::uint64_t find_spheres(const ParticleSet& grains);
    /// The same among own grains alone, which is enough for drift().
    void find_own_spheres(const ParticleSet& grains) { list_spheres(grains); }
    static constexpr std::uint64_t everybody = ~std::uint64_t{0};

    /// What the copies need: force and torque on each own sphere.
    void take_forces(ParticleSet& grains, std::span<const ForceSum> sums,
                     std::span<const double> units) const;
    /// How far spheres get until the end of the next drift.
    struct Path {
        double moved2 = 0;  ///< square of the distance from `responses.start`, at most [m2]
        double bent = 0;    ///< from where their velocities of now take them in a step, at most [m]
    };
    /// The part of the velocities that dem::finish_step() leaves out. Of `impulse` only times count.
    Path finish_step(ParticleSet& grains, const Responses& responses, const Vector3<>& gravity,
                     const Impulse& impulse, double kick_step, double time_step, double remaining,
                     const Shear* shear) const;

    /// Under self-gravity: the fields for it, what each own grain attracts with, what the copies need of the
    /// attraction, and the motion that it gives in a time [s].
    static void add_gravity_fields(ParticleSet& grains);
    void share_masses(ParticleSet& grains) const;
    void take_attraction(ParticleSet& grains) const;
    void kick_by_attraction(ParticleSet& grains, double time) const;

    /// Of the clump of own grain i [J].
    double rotational_energy(const ParticleSet& grains, std::size_t i) const;

    std::size_t bytes() const {
        return clumps_.capacity() * sizeof(Spheres) + spheres_.capacity() * sizeof(std::uint32_t);
    }

  private:
    /// The spheres of one clump of which this rank owns some.
    struct Spheres {
        std::uint32_t some;   ///< an own one, as stored
        std::uint32_t begin;  ///< of all in spheres_, in order
    };
    /// What the others' gravity does to a clump.
    struct Attraction {
        Vector3<> acceleration;  ///< [m s-2]
        Vector3<> torque;        ///< about its centre [N m]
    };
    Attraction attraction(ParticleSet& grains, const ClumpBody& body, const RotationMatrix& axes,
                          std::span<const std::uint32_t> spheres) const;
    std::uint64_t list_spheres(const ParticleSet& grains);
    template <class Visit>
    void for_each_sphere(const ParticleSet& grains, Visit&& visit) const;
    template <class Visit>
    void for_each_clump(const ParticleSet& grains, Visit&& visit) const;

    std::vector<ClumpBody> bodies_;
    std::vector<std::uint8_t> held_;
    bool exists_ = false;
    std::vector<Spheres> clumps_;
    std::vector<std::uint32_t> spheres_;  ///< as stored, own or copies; `absent` if neither
};

}  // namespace talus::dem
