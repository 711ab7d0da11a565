#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/cell_grid.hpp"
#include "domain/particles.hpp"
#include "domain/random.hpp"
#include "physics/dem/clumps/clump_motion.hpp"
#include "physics/dem/motion.hpp"
#include "physics/dem/walls/wall.hpp"
#include "src/flow/grain_region.hpp"
#include "src/setup/grain_sizes.hpp"

namespace talus {

/// Takes out the grains whose centre is in a region: clumps by theirs, whole.
struct GrainSink {
    std::string name;
    GrainRegion region;
    double begin = 0, end = 1e300;  ///< acts at times between [s]
    std::uint64_t interval = 1;     ///< at every so many steps, counted from the first of the run
};

/// Puts grains into a region at a rate.
struct GrainSource {
    std::string name;
    std::uint8_t body = 0;  ///< that they belong to
    double density = 0;     ///< [kg/m3]
    BodyShape region;       ///< of their centres
    GrainSizes sizes{};
    std::shared_ptr<const dem::ClumpShape> clump = {};       ///< in place of sizes, if any
    bool turned = false;                                     ///< clumps are, each its own way
    Point velocity{}, angular_velocity{};                    ///< [m/s], [rad/s]
    bool by_mass = false;                                    ///< `rate` and `total` are masses, not numbers
    double rate = 0;                                         ///< [1/s], [kg/s]
    double total = std::numeric_limits<double>::infinity();  ///< [1], [kg]
    double begin = 0, end = 1e300;                           ///< [s]
    std::uint64_t interval = 1;                              ///< steps between insertions
    int tries = 1;                                           ///< places tried for a grain before it is missed

    double greatest_radius() const;  ///< of its spheres [m]
};

/// What comes and goes in a scene.
struct GrainFlowPlan {
    std::vector<GrainSink> sinks;
    std::vector<GrainSource> sources;
    std::uint64_t seed = 0;
    bool empty() const { return sinks.empty() && sources.empty(); }
};

/// What there is when grains come and go.
struct FlowMoment {
    double time;         ///< [s]
    std::uint64_t step;  ///< about to be done
    const dem::PeriodicPlaces& places;
    std::span<const dem::Wall> walls;
    std::span<const dem::WallPose> poses;  ///< at `time`
    std::span<const std::uint8_t> held;    ///< one a body
    const dem::ClumpMotion& clumps;
    const dem::Vector3<>& gravity;  ///< [m s-2]
};

/// Grains that come and go, and the ledger of them, in which a clump is one grain. When something happens,
/// and what, follows from time, steps and places of grains alone: it is the same on any number of ranks and
/// across restarts.
class GrainFlow {
  public:
    struct Passed {
        std::uint64_t count = 0;
        double mass = 0;  ///< [kg]
    };
    struct Came {
        std::uint64_t count = 0, missed = 0, attempts = 0;
        double mass = 0;  ///< [kg]
        double due = 0;   ///< part of rate times time that was tried so far [1], [kg]
    };
    struct Change {
        Decomposition::Ledger added, removed;  ///< of spheres
        bool any() const { return added.count() + removed.count() > 0; }
    };

    /// `largest_radius`: of all grains that are or may come [m].
    GrainFlow(const Communicator& comm, const Box& box, GrainFlowPlan plan, double largest_radius);

    /// A new run begins with these grains. Collective.
    void begin(const ParticleSet& grains, const dem::ClumpMotion& clumps);
    /// Goes on with the ledger of the checkpoint that holds these grains; from one of a run without sinks and
    /// sources it begins. Throws AgreedError if grains begun with, come and gone do not add up. Collective.
    void restore(const std::map<std::string, double>& numbers, double time, const ParticleSet& grains,
                 const dem::ClumpMotion& clumps);
    /// What a checkpoint must know.
    void save(std::map<std::string, double>& numbers) const;

    bool due(std::uint64_t step) const;
    /// Removes and adds own grains. Grains must be brought to their owners afterwards. Collective.
    Change apply(ParticleSet& grains, const FlowMoment& now);
    /// Whether a source that began before `time` has grains left to insert.
    bool inserting(double time) const;

    const GrainFlowPlan& plan() const { return plan_; }
    std::span<const Passed> passed() const { return passed_; }  ///< one a sink
    std::span<const Came> came() const { return came_; }        ///< one a source
    /// What a user should know, once.
    std::vector<std::string> take_notes();

  private:
    struct Candidate;
    struct Candidates;
    Decomposition::Ledger remove(ParticleSet& grains, const FlowMoment& now);
    Decomposition::Ledger insert(ParticleSet& grains, const FlowMoment& now);
    RandomStream random(std::size_t source) const;
    double radius_of(std::size_t source, std::uint64_t attempt) const;
    double mass_of(std::size_t source, std::uint64_t attempt) const;
    double amount_of(std::size_t source, std::uint64_t attempt) const;
    dem::Quaternion orientation_of(std::size_t source, std::uint64_t attempt) const;
    bool complete(std::size_t source) const;
    void draw_due(std::size_t source, const FlowMoment& now, Candidates& candidates);
    void put(const Candidate& grain, const FlowMoment& now, ParticleSet& grains,
             Decomposition::Ledger& added);

    const Communicator& comm_;
    GrainFlowPlan plan_;
    CellGrid grid_;  ///< in which grains of neighbouring cells may overlap
    std::vector<Passed> passed_;
    std::vector<Came> came_;
    std::uint64_t first_count_ = 0, next_id_ = 0;
    std::vector<bool> noted_;  ///< of each source: that it is full
    std::vector<std::string> notes_;
};

}  // namespace talus
