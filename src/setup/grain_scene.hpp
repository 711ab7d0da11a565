#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "io/scene.hpp"
#include "physics/dem/laws/materials.hpp"
#include "src/flow/region_statistics.hpp"
#include "src/grain_simulation.hpp"
#include "src/setup/grain_sizes.hpp"
#include "src/setup/packing.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

/// Grains of one material, before they are made: a region filled with a packing, or a list of places.
struct GrainBody {
    std::string name;
    dem::GrainMaterial material;
    bool held = false;
    bool inserted = false;  ///< by a source as time goes on: none at the start, and no shape or packing
    BodyShape shape;
    UnitCell cell;
    double spacing = 0;  ///< cube root of the volume a grain [m]
    double jitter = 0;   ///< random displacement along each axis, at most, in spacings [1]
    GrainSizes sizes;
    double least_radius = 0,
           greatest_radius = 0;  ///< of the sizes, of the list or of the clump's spheres [m]
    std::shared_ptr<const dem::ClumpShape> clump;  ///< that each place of the packing gets, if any
    bool turned = false;                           ///< clumps are, each its own way
    Point velocity{}, angular_velocity{};          ///< [m/s], [rad/s]
    Point spin{};  ///< of the whole body, besides, about its centre of mass [rad/s]
    /// Of the grains, if a file says their masses [kg/m3].
    std::optional<double> least_density;
    std::optional<ParticleSet> handed;  ///< each rank its share of the grains of a file of particle sets
    /// Rows of a file in place of all that: x y z, radius, velocity, angular velocity.
    std::vector<std::array<double, 10>> listed;
};

/// Spheres at each place of a body.
inline std::size_t spheres_of(const GrainBody& body) { return body.clump ? body.clump->radii.size() : 1; }

/// A scene of grains, read and checked.
struct GrainScene {
    std::string title;
    GrainSetup simulation;
    std::vector<GrainBody> bodies;
    double greatest_time_step = 0;  ///< that is stable [s]
    std::string time_step_limit;    ///< what limits it
    OutputPlan output;
    bool shrinks_overlapping = false;  ///< grains that overlap at the start; else they are refused
    std::vector<WatchedRegion> regions;
    bool write_contacts = false;        ///< with snapshots
    std::vector<std::string> warnings;  ///< what is doubtful, but can be used
    std::uint64_t seed = 0;
};

/// Whether the scene is one of grains: it has a table [[grains]] or [[source]].
bool is_grain_scene(const Scene& scene);

/// Reads everything such a scene says. Throws SceneError (on every rank) with all faults at once. Collective.
GrainScene read_grain_scene(const Communicator& comm, const Scene& scene);
/// The same for a scene that says more than that: faults are only recorded in it.
GrainScene read_grains_of(const Communicator& comm, const Scene& scene);

/// An empty set with the fields that the scene's grains need.
ParticleSet empty_grains(const GrainSetup& setup);

/// The scene's grains at time 0, on any ranks. Ids are numbered through in order of the bodies; those of a
/// file of particle sets keep theirs, counted on from the bodies before. Collective.
ParticleSet make_grains(const Communicator& comm, const GrainScene& scene);

}  // namespace talus
