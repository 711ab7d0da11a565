#pragma once
#include "io/scene.hpp"
#include "src/setup/scene_setup.hpp"
#include "src/simulation.hpp"

namespace talus {

/// What can be wrong with a scene that is read without a fault; to be asked before anything is written.
/// Throws SceneError (on every rank) naming the place in the scene: gases without a sound speed, and more
/// snapshots until `end_time` [s] than their numbers have digits.
void check_plan(const Scene& scene, const SceneSetup& setup, double end_time);
/// The second of these alone.
void check_snapshots(const Scene& scene, const OutputPlan& output, double end_time);

/// The same for a box that is shorter, along an axis where it is closed, than particles reach. Collective.
void check_box(const Scene& scene, const Simulation& simulation);
/// The same of any model: `radius` is how far its particles reach [m].
void refuse_short_box(const Scene& scene, const Box& box, double radius);
/// Records in the scene that grains overlap at the start by more than contacts bear, if they do.
void refuse_first_overlap(const Scene& scene, double greatest_overlap);

}  // namespace talus
