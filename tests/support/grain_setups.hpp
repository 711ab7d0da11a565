#pragma once
#include <vector>

#include "tests/support/grain_scene.hpp"

/// Dense scenes of grains in which much happens within a hundred steps, each with all of one kind of thing.
namespace talus::test {

/// What they are made of.
extern const dem::GrainMaterial glass;

/// A dense cloud of two sizes.
std::vector<GrainState> cloud();

GrainSetup on_a_floor();
/// The same with all that a contact may remember.
GrainSetup sticky_on_a_floor();
/// Bonded to lumps and a net through the periodic boundaries that break while they fly apart.
GrainSetup bonded_on_a_floor();
/// The same floor with a rain into the cloud across the periodic edges, where places are scarce, a hole that
/// swallows grains, across an edge too, and a lid above.
GrainSetup come_and_go();
/// The same rain from before time 0 on, until grains balance somewhat and the floor begins to swing.
GrainSetup settle_first();
/// In a turning drum through which a sheet of triangles is drawn up.
GrainSetup in_a_drum();
/// The rain of come_and_go() into that drum, and a hole where its sheet is drawn through.
GrainSetup come_and_go_in_a_drum();
/// The first, with clumps of three spheres of two sizes in place of spheres.
GrainSetup clumps_on_a_floor();
/// Clumps of two kinds and spheres come into clumps of the first: one rain while they settle, the others
/// until the end, and a hole swallows clumps across the periodic edge.
GrainSetup clumps_come_and_go();
ParticleSet spheres(const Communicator& comm, const GrainSetup&);
ParticleSet many_sizes(const Communicator& comm, const GrainSetup&);
ParticleSet clumps(const Communicator& comm, const GrainSetup& setup);
/// Sheared for ever: the images across y move two diameters during the run, half a layer of grains crosses.
GrainSetup sheared();
/// The same with the clumps of clumps_on_a_floor(), which reach through the border with one sphere or two.
GrainSetup clumps_sheared();

}  // namespace talus::test
