#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "domain/water_fields.hpp"
#include "physics/water/passes.hpp"
#include "physics/water/rheology.hpp"
#include "src/setup/water_scene.hpp"

namespace talus::test {
namespace {

using water::Rheology;

// tau_y/rate + K rate^(n-1), by hand; never above the greatest, however slow.
TEST(Rheology, IsThatOfHerschelAndBulkley) {
    const Rheology mud{.yield_stress = 10, .consistency = 3, .exponent = 0.5, .greatest_viscosity = 1000};
    EXPECT_DOUBLE_EQ(mud.viscosity(4), 10.0 / 4 + 3.0 / 2);
    EXPECT_DOUBLE_EQ(mud.viscosity(1e-3), 1000);
    EXPECT_DOUBLE_EQ(mud.viscosity(0), 1000);
    EXPECT_DOUBLE_EQ(mud.creep_rate(), 0.01);
    const Rheology newtonian{.consistency = 3, .greatest_viscosity = 1000};
    EXPECT_DOUBLE_EQ(newtonian.viscosity(0), 3);
    const Rheology thickens{.consistency = 3, .exponent = 2, .greatest_viscosity = 1000};
    EXPECT_DOUBLE_EQ(thickens.viscosity(2), 6);
    EXPECT_LT(thickens.viscosity(0), 1e-20);
}

/// A ball (a disc in 2D) of mud that turns, without pressure.
constexpr const char* turning = R"(dimension = {}
[water]
sound_speed = 10
density_diffusion = 0
[water.rheology]
yield_stress = 1
consistency = 10
[[body]]
name = "mud"
shape = "sphere"
radius = 0.5
lattice = "cubic"
spacing = 0.1
jitter = 0.1
spin = {}
[run]
end_time = 1
)";

class TurningMud : public testing::TestWithParam<int> {
  protected:
    TurningMud()
        : scene_(
              read_water_scene(world_, Scene::parse(fmt::format(fmt::runtime(turning), GetParam(),
                                                                GetParam() == 2 ? "2.0" : "[1.0, -0.5, 2.0]"),
                                                    "turning.toml"))),
          run_(world_, scene_.simulation, make_water(world_, scene_)) {
        run_.start();
    }

    /// Greatest acceleration if each particle has a viscosity of its own.
    double greatest_acceleration() {
        ParticleSet& particles = run_.access().particles;
        for (std::size_t i = 0; i < particles.size(); ++i)
            particles.data(water_field::partner_viscosity)[i] =
                0.01F * static_cast<float>(1 + particles.data(field::id)[i] % 7);
        sph::PassCount count;
        count.work_of_cell.assign(run_.decomposition().own_cells().size(), 0.0);
        water::force_pass(particles, run_.decomposition().table(), Cells::all, scene_.simulation.settings,
                          count);
        double greatest = 0;
        for (int a = 0; a < particles.dimension(); ++a)
            for (const double value : particles.own(field::acceleration, a))
                greatest = std::max(greatest, std::abs(value));
        return greatest;
    }

    const Communicator world_{MPI_COMM_WORLD};
    WaterScene scene_;
    WaterSimulation run_;
};

// A rigid turn has no rate of strain and no stress, to the rounding of single precision, however uneven the
// viscosity; it has without the transposed gradient.
TEST_P(TurningMud, HasNoStress) {
    for (const double viscosity : run_.particles().own(water_field::viscosity))
        EXPECT_DOUBLE_EQ(viscosity, scene_.simulation.settings.rheology->greatest_viscosity);
    const double rounding = greatest_acceleration();
    ParticleSet& particles = run_.access().particles;
    for (int c = 0; c < GetParam() * GetParam(); ++c)
        for (float& value : particles.own(water_field::partner_gradient, c)) value = 0;
    const double spurious = greatest_acceleration();
    EXPECT_LT(rounding, 1e-4 * spurious);
    EXPECT_GT(spurious, 1);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, TurningMud, testing::Values(2, 3));

}  // namespace
}  // namespace talus::test
