#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "io/run_state.hpp"
#include "io/scene.hpp"
#include "src/analysis/fragments.hpp"
#include "src/analysis/remnants.hpp"
#include "src/setup/bodies.hpp"
#include "src/simulation.hpp"

namespace talus {

/// The material opposite the point that a body was hit at.
struct Antipode {
    std::size_t body;      ///< index of the body that was hit
    Point point;           ///< on its surface, where the line from the point hit through its centre ends [m]
    Point outward;         ///< unit vector from its centre to that point
    double radius;         ///< material within this distance of the point counts [m]
    Point first_velocity;  ///< of the body before the impact [m/s]
};

/// Linking length in spacings (D-th root of the volume per particle): above the distance of nearest
/// neighbours in a close-packed (1.12) or cubic (1) lattice with room for a third of strain, below the least
/// distance across a crack one layer wide (1.59, 2).
inline constexpr double default_linking_length = 1.5;

/// What is to be found out about a run's state; the scene's [analysis] table.
struct AnalysisPlan {
    bool fragments = false;
    FragmentRules rules;
    std::optional<Antipode> antipode;
    std::optional<RemnantRules> remnants;

    bool asks_for_anything() const { return fragments || remnants; }
};

/// Reads [analysis] (keys: docs/analysis.md). Faults are recorded in the scene.
AnalysisPlan read_analysis(const Section& table, const std::vector<Body>& bodies, const Setup& setup);

/// What came out: fragments and what is told of them if asked for, remnants if asked for.
struct Breakup {
    double mass = 0;           ///< of the bodies looked at, whole and dust [kg]
    Point velocity{};          ///< of their centre of mass [m/s]
    double fully_damaged = 0;  ///< share of the mass with D = 1
    double in_fragments = 0;   ///< share of the mass
    std::vector<Fragment> fragments;
    std::optional<double> antipode_speed;  ///< mean outward velocity around the antipode [m/s]
    double antipode_mass = 0;              ///< that this is the mean of [kg]
    std::optional<Remnants> remnants;
};

/// Collective.
Breakup analyse(const Communicator& comm, const AnalysisPlan& plan, const Box& box,
                const ParticleSet& particles);

/// Writes to `folder` analysis.json; fragments.csv and distribution.csv (the heaviest first) if fragments
/// were asked for; the particles of the remnants as a snapshot if those were. Throws AgreedError (exit code
/// 3). Collective.
void write_breakup(const Communicator& comm, const std::filesystem::path& folder, const RunState& state,
                   const AnalysisPlan& plan, const Breakup& breakup);

/// The figures in a few words, for people.
std::string describe(const AnalysisPlan& plan, const Breakup& breakup);

}  // namespace talus
