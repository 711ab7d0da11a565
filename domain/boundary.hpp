#pragma once
#include "domain/box.hpp"
#include "domain/particles.hpp"

namespace talus {

/// Sign that a component of a field takes in a mirror image, `flip[a]` telling whether axis a is mirrored.
double mirror_sign(Shape shape, int component, int dimension, const std::array<bool, 3>& flip);

/// A coordinate brought into [lower, upper) by whole lengths.
double wrapped(double coordinate, double lower, double upper);

/// Brings own particles back into the box: across a periodic boundary by whole lengths, with all points of
/// their state, across a reflecting
/// one by mirroring the position and every vector and tensor of the particle's state.
void apply_boundaries(ParticleSet& particles, const Box& box);

}  // namespace talus
