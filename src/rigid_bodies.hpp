#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/box.hpp"
#include "domain/particles.hpp"
#include "physics/dem/law_table.hpp"
#include "physics/dem/walls/wall.hpp"
#include "physics/rigid/body.hpp"
#include "physics/rigid/contacts.hpp"
#include "physics/sph/motion.hpp"
#include "physics/sph/walls.hpp"
#include "physics/water/settings.hpp"

namespace talus {

/// The rigid bodies of a scene: what it says, resolved.
struct RigidSetup {
    std::vector<rigid::Body> bodies;       ///< none: the scene has none
    std::vector<rigid::State> states;      ///< at time 0, without forces
    std::optional<dem::AnyLawTable> laws;  ///< of contacts; none: bodies pass through each other
    std::vector<dem::Wall> walls;          ///< that they meet
};

/// What a rigid body does, for records.
struct RigidTotals {
    rigid::State state;
    dem::Vector3<> turning;                           ///< angular velocity [rad/s]
    dem::Vector3<> force, torque;                     ///< of the water
    double kinetic_energy = 0, potential_energy = 0;  ///< [J], in even gravity from the origin
};

/// Bodies of wall particles that move as the water and their contacts drive them. Their states are a handful
/// of numbers, known on every rank; each rank moves the particles it owns and adds up the forces on them
/// (docs/decisions/028).
class RigidBodies {
  public:
    RigidBodies(const Communicator& comm, RigidSetup setup, const Box& box, const water::Settings& settings);
    RigidBodies(const RigidBodies&) = delete;
    RigidBodies& operator=(const RigidBodies&) = delete;

    static void add_fields(ParticleSet& particles);

    /// Half of a step's push by the water.
    void kick(double time);
    /// Moves on by a step, through contacts in as many steps of their own as they need. Throws AgreedError
    /// naming a body that leaves the box or whose state is not finite.
    void move(double time, double time_step);
    /// Brings own particles to where they belong, with velocities `time_ahead` of the state.
    void place(ParticleSet& particles, double time_ahead) const;
    /// What walls are told of the bodies among them, at the time of an evaluation.
    void complete(std::span<sph::WallNow> walls) const;
    /// Takes up wall_force of all own particles. Collective.
    void take_forces(const ParticleSet& particles);

    /// One a body of the scene: whether its particles feel forces.
    std::span<const std::uint8_t> feels() const { return feels_; }
    /// The longest step with which the water's push on the lightest body is stable, and its first particle.
    const sph::StepLimit& step_limit() const { return limit_; }
    int substeps() const { return substeps_; }  ///< of contacts in the last step

    std::size_t count() const { return setup_.bodies.size(); }
    const rigid::Body& body(std::size_t k) const { return setup_.bodies[k]; }
    RigidTotals totals(std::size_t k) const;
    /// Greatest overlap of contacts where bodies are, over the radius of their contact spheres.
    rigid::Contacts::Overlap greatest_overlap(double time);

    /// The states as a set, all on the root; and what contacts remember.
    ParticleSet saved_states() const;
    ParticleSet saved_contacts() const;
    /// Empty ones to read them into.
    static ParticleSet empty_states();
    static ParticleSet empty_contacts(const RigidSetup& setup);
    /// Takes up what was saved, each rank holding a share of it. Collective.
    void restore(const ParticleSet& states, const ParticleSet& contacts);

  private:
    void check(double time) const;
    sph::StepLimit stable_step() const;

    const Communicator& comm_;
    const RigidSetup setup_;
    const Box box_;
    const water::Settings settings_;
    std::vector<rigid::State> states_;
    std::vector<std::uint8_t> feels_;
    std::optional<rigid::Contacts> contacts_;
    sph::StepLimit limit_;
    int substeps_ = 1;
};

}  // namespace talus
