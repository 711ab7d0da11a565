#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/particles.hpp"
#include "physics/water/buffers.hpp"
#include "src/setup/point.hpp"

namespace talus {

/// Which bodies are inflows and outflows.
struct OpenPlan {
    std::vector<water::Buffer> buffers{};  ///< one a body; empty: none is open
    std::vector<std::string> names{};      ///< of the bodies
    std::uint8_t water = 0;                ///< the body that an inflow's particles become one of
    double spacing = 0;                    ///< of particles [m]
};

/// Inflows and outflows of water, and the ledger of them. What happens follows from places and ids alone: it
/// is the same on any number of ranks and across restarts.
class OpenBoundaries {
  public:
    struct Passed {
        std::uint64_t count = 0;
        double mass = 0;  ///< [kg]
    };

    OpenBoundaries(const Communicator& comm, OpenPlan plan);

    /// A new run begins with these particles. Collective.
    void begin(const ParticleSet& particles);
    /// Goes on with the ledger of the checkpoint that holds these particles. Throws AgreedError if particles
    /// begun with, come and gone do not add up. Collective.
    void restore(const std::map<std::string, double>& numbers, const ParticleSet& particles);
    /// What a checkpoint must know.
    void save(std::map<std::string, double>& numbers) const;

    struct Change {
        Decomposition::Ledger added, removed;
    };
    /// After particles have moved: an inflow's that are through its face become water, and each is followed
    /// by another one where it was a depth of the buffer ago, whose id is greater by the number of particles
    /// at the start; water behind the face of an outflow becomes its; an outflow's that are out of it are
    /// deleted, and water more than half a spacing behind the face of an inflow. Throws AgreedError (exit
    /// code 1) if an inflow pushes into a region that is full. Collective.
    Change apply(ParticleSet& particles, const water::Settings& settings, double time);

    /// Takes note of buffers in front of which there is no water. `seeing`: this rank's from buffer_pass().
    /// Collective.
    void look(std::vector<std::uint64_t> seeing);
    std::vector<std::string> take_notes();

    const OpenPlan& plan() const { return plan_; }
    /// Through the face of a body's buffer, along its direction.
    const Passed& passed(std::size_t body) const { return passed_[body]; }
    /// Deleted behind the face of an inflow.
    const Passed& returned(std::size_t body) const { return returned_[body]; }

  private:
    /// What a step makes of a particle, and at which body's buffer.
    struct Fate {
        enum What : std::uint8_t { stays, enters, leaves, returns, ends } what = stays;
        std::size_t buffer = 0;
    };
    Fate fate_of(std::size_t body, const Point& x, int dimension) const;
    static Point place(const ParticleSet& particles, std::size_t i);
    static void stop_rates(ParticleSet& particles, std::size_t i);
    void follow(ParticleSet& particles, std::vector<std::uint32_t> kept,
                const std::vector<std::uint32_t>& followed) const;
    void refuse_full(const ParticleSet& particles, const water::Settings& settings, double time) const;

    const Communicator& comm_;
    OpenPlan plan_;
    std::vector<Passed> passed_, returned_;  ///< one a body
    std::uint64_t first_count_ = 0, created_ = 0, deleted_ = 0;
    std::vector<std::string> notes_;
};

}  // namespace talus
