#include <gtest/gtest.h>

#include "src/simulation.hpp"
#include "tests/support/solid_materials.hpp"

namespace talus::test {
namespace {

std::size_t bytes_of(const Setup& setup) {
    ParticleSet particles("sph", setup.box.dimension);
    add_fields(particles, setup);
    return particles.bytes_per_particle();
}

// What a particle costs is what its scene names, no more. The sums are those of the fields' sizes: a change
// here is a change of every user's memory and must be meant.
TEST(Memory, RockIn3D) {
    talus::Setup setup;
    setup.box.dimension = 3;
    setup.materials = {
        Material{.name = "basalt", .eos = basalt(), .shear_modulus = 22.7e9, .fracture = Fracture{4e35, 9}}};
    setup.sph.compressed = sph::stable_compressed(3);
    setup.sph.stretched = sph::stable_stretched(3);
    // id, x, v, m, u, h, body | a, power, grad v | predicted v, u, rho, P, c, grad P, grad V
    const std::size_t fluid = 8 + 24 + 24 + 8 + 8 + 8 + 1 + 24 + 8 + 72 + 24 + 8 + 8 + 8 + 8 + 24 + 24;
    EXPECT_EQ(bytes_of(setup), fluid + 8 + 48 + 48 + 8 + 12);  // rho, stress twice, damage, flaws
    setup.materials[0].fracture.reset();
    EXPECT_EQ(bytes_of(setup), fluid + 8 + 48 + 48);
    setup.materials[0].shear_modulus = 0;
    EXPECT_EQ(bytes_of(setup), fluid + 8);
}

TEST(Memory, GasIn1DWithStandardSph) {
    talus::Setup setup;
    setup.box.dimension = 1;
    setup.materials = {Material{.name = "gas", .eos = IdealGas{}}};
    setup.sph.formulation = sph::Formulation::standard;
    setup.sph.density = sph::DensityMethod::summation;
    // id, x, v, m, u, h, body | a, power | predicted v, u, rho, P, c, viscous speed: no gradients, no density
    // state
    EXPECT_EQ(bytes_of(setup), 8u + 8 + 8 + 8 + 8 + 8 + 1 + 8 + 8 + 8 + 8 + 8 + 8 + 8 + 8);
}

}  // namespace
}  // namespace talus::test
