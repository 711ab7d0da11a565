#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/scene.hpp"
#include "src/rigid_bodies.hpp"
#include "src/setup/bodies.hpp"
#include "src/setup/grain_law_reader.hpp"

namespace talus {

/// What the table [body.rigid] of a body says.
struct RigidTable {
    double density = 0, mass = 0;          ///< one of them; 0: not given [kg/m3], [kg]
    std::optional<std::uint8_t> material;  ///< of its contacts
    dem::Vector3<> velocity, spin;         ///< at the start [m/s], [rad/s]
    dem::Vector3<> force;                  ///< besides those of water, gravity and contacts [N]
};

/// Reads the tables [body.rigid] of a scene, and once its bodies are counted makes rigid bodies of them.
/// Faults are recorded in the scene.
class RigidBodyReader {
  public:
    RigidBodyReader(const Section& root, int dimension) : root_(root), dimension_(dimension) {}

    /// Of the next body; `is_wall`: it has the key wall.
    void read(const Section& body, bool is_wall);
    bool is_rigid(std::size_t body) const { return tables_[body].has_value(); }
    bool any() const;

    /// Collective. `kernel_radius`: of the water [m].
    RigidSetup make(const Communicator& comm, const Scene& scene, const Box& box,
                    const std::vector<Body>& bodies, const std::vector<BodyCensus>& census,
                    double kernel_radius, std::vector<std::string>& warnings);

  private:
    rigid::Body make_body(std::size_t b, const Body& body, const BodyCensus& census,
                          rigid::State& state) const;

    Section root_;
    int dimension_;
    std::optional<GrainLawReader> laws_;
    std::vector<std::optional<RigidTable>> tables_;
    std::vector<Section> sections_;
};

/// Gives own particles of rigid bodies their places in them.
void put_places_in_bodies(const RigidSetup& setup, ParticleSet& particles);

}  // namespace talus
