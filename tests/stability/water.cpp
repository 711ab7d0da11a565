#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "domain/water_fields.hpp"
#include "physics/water/sound_waves.hpp"
#include "src/setup/water_scene.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/stability_row.hpp"

/// Walls of the time step of water: sound that the diffusion of density must damp, and viscosity.
namespace talus::test {
namespace {

/// Twelve particles a side, a metre apart, in a periodic square.
constexpr const char* square = R"(dimension = 2
[box]
boundaries = ["periodic", "periodic"]
lower = [0, 0]
upper = [12, 12]
[water]
density = 1
gravity = [0, 0]
{}
[[body]]
name = "water"
shape = "box"
lower = [0, 0]
upper = [12, 12]
lattice = "cubic"
spacing = 1
[run]
end_time = 1
)";

using Wave = std::array<double, 3>;

/// What a step of `time_step` makes of a wave of `wave` that moves water along `direction`: the mean factor
/// of speeds and densities over the second half of the steps. No more steps once they have grown 1e5 times or
/// faded to a thousandth.
double growth(const Communicator& comm, const WaterScene& scene, const Wave& wave, const Wave& direction,
              double time_step, int steps) {
    WaterSimulation run(comm, scene.simulation, make_water(comm, scene));
    ParticleSet& particles = run.access().particles;
    const double sound = scene.simulation.settings.state.sound_speed, slow = 1e-9 * sound;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double phase =
            wave[0] * particles.data(field::position, 0)[i] + wave[1] * particles.data(field::position, 1)[i];
        for (std::size_t axis = 0; axis < 2; ++axis)
            particles.data(field::velocity, static_cast<int>(axis))[i] =
                slow * direction[axis] * std::cos(phase + 1);
    }
    run.start();
    const auto amplitude = [&] {
        double sum = 0;
        const ParticleSet& now = run.particles();
        for (std::size_t i = 0; i < now.size(); ++i)
            sum += std::pow(now.data(field::velocity, 0)[i], 2) +
                   std::pow(now.data(field::velocity, 1)[i], 2) +
                   std::pow(sound * (now.data(field::density)[i] - 1), 2);
        return std::sqrt(sum);
    };
    std::vector<double> history{amplitude()};
    while (static_cast<int>(history.size()) <= steps && history.back() < 1e5 * history.front() &&
           history.back() > 1e-3 * history.front()) {
        run.set_time_step(time_step);
        run.step();
        history.push_back(amplitude());
    }
    const std::size_t half = history.size() / 2, rest = history.size() - 1 - half;
    return std::pow(history.back() / history[half], 1.0 / static_cast<double>(rest));
}

WaterScene scene_of(const Communicator& comm, const std::string& keys) {
    return read_water_scene(comm, Scene::parse(fmt::format(fmt::runtime(square), keys), "square.toml"));
}

double step_of(const water::Settings& settings, double courant) {
    return courant * settings.smoothing_length / settings.state.sound_speed;
}

/// Linear theory of the scheme on the lattice (physics/water/sound_waves.hpp), with 0.02 and 0.1 (the
/// default) of diffusion: at 0.95 of the greatest Courant number the wave that fades least fades, at 1.05 it
/// grows as theory says to 2 % of what it grows by. Without diffusion no step is short enough: sound grows by
/// (omega dt)^4/4 a step.
TEST(WaterTimeStep, SoundGrowsBeyondTheCourantNumberThatDiffusionBears) {
    const std::vector<double> shares{0.8, 0.95, 1.05, 1.2};
    struct Point {
        double diffusion, courant, wall;
    };
    std::vector<Point> points;
    const auto keys = [](double diffusion) {
        return fmt::format("sound_speed = 1\ndensity_diffusion = {}", diffusion);
    };
    const Communicator alone(MPI_COMM_SELF);
    for (const double diffusion : {0.0, 0.02, 0.1}) {
        const double wall =
            water::greatest_courant(scene_of(alone, keys(diffusion)).simulation.settings, 2, 2);
        for (const double share : shares)
            points.push_back(
                {diffusion, diffusion > 0 ? share * wall : 0.4 * share, diffusion > 0 ? wall : 0});
    }
    const auto theory = [&](const Communicator& comm, const Point& point) {
        const water::Settings settings = scene_of(comm, keys(point.diffusion)).simulation.settings;
        return water::fastest_growing(settings, 2, step_of(settings, point.courant));
    };
    const auto found = on_shared_ranks(points.size(), [&](const Communicator& comm, std::size_t p) {
        const WaterScene scene = scene_of(comm, keys(points[p].diffusion));
        // all but the longest waves fade below the wall: one of those that grow first
        const double courant = std::max(points[p].courant, 1.05 * points[p].wall);
        const Wave wave = theory(comm, {points[p].diffusion, courant, 0}).wave;
        const double size = std::hypot(wave[0], wave[1]);
        return growth(comm, scene, wave, {wave[0] / size, wave[1] / size},
                      step_of(scene.simulation.settings, points[p].courant), 1500);
    });
    for (std::size_t p = 0; p < points.size(); ++p) {
        const auto& [diffusion, courant, wall] = points[p];
        const bool stable = courant < wall;
        const double expected = theory(alone, points[p]).growth - 1;
        if (stable)
            EXPECT_LT(found[p], 1) << diffusion << ", " << courant;
        else
            EXPECT_NEAR(found[p] - 1, expected, 0.02 * expected) << diffusion << ", " << courant;
        if (is_root())
            print({"sound in water", fmt::format("density_diffusion {}", diffusion), "courant", courant, wall,
                   "growth a step", found[p], stable});
    }
}

/// Friction alone: waves across bear x = 1 (physics/water/sound_waves.hpp), with the sum over the lattice
/// nu dt = 0.151 h^2, where the program allows 0.125 h^2.
TEST(WaterTimeStep, FrictionBearsHalfOfWhatTheFirstMethodOfEulerDoes) {
    const Communicator alone(MPI_COMM_SELF);
    const std::string keys = "sound_speed = 1e-3\nviscosity = 1";
    const water::Settings settings = scene_of(alone, keys).simulation.settings;
    const auto rate = [&](const Wave& wave) { return water::wave_rates(settings, 2, wave).viscosity; };
    const double h = settings.smoothing_length;
    Wave fastest{};  // of the shear waves along x
    for (int mode = 1; mode <= 6; ++mode)
        if (const Wave wave{mode * std::numbers::pi / 6, 0, 0}; rate(wave) > rate(fastest)) fastest = wave;
    const double wall = 1 / (rate(fastest) * h * h);
    EXPECT_LT(0.125, 0.95 * wall);
    const std::vector<double> shares{0.8, 0.95, 1.05, 1.2};
    const auto found = on_shared_ranks(shares.size(), [&](const Communicator& comm, std::size_t p) {
        return growth(comm, scene_of(comm, keys), fastest, {0, 1}, shares[p] * wall * h * h, 200);
    });
    for (std::size_t p = 0; p < shares.size(); ++p) {
        const double mean = (1 - 1.5 * shares[p]) / 2,
                     expected = std::abs(mean) + std::sqrt(mean * mean + shares[p] / 2);
        if (shares[p] < 1)
            EXPECT_LT(found[p], 1) << shares[p];
        else
            EXPECT_NEAR(found[p], expected, 1e-3) << shares[p];
        if (is_root())
            print({"viscosity of water", "square lattice", "nu dt/h2", shares[p] * wall, wall,
                   "growth a step", found[p], shares[p] < 1});
    }
}

/// Twenty layers of water on a floor of some.
constexpr const char* tank = R"(dimension = 2
[box]
boundaries = ["periodic", "open"]
lower = [0, -20]
upper = [12, 40]
[water]
density = 1
greatest_speed = 6
gravity = [0, -1]
artificial_viscosity = 0.02
[[body]]
name = "water"
shape = "box"
lower = [0, 0]
upper = [12, 20]
lattice = "cubic"
spacing = 1
surface = 20
[[body]]
name = "floor"
shape = "box"
lower = [0, {}]
upper = [12, 0]
lattice = "cubic"
wall = "free_slip"
[run]
end_time = 40
)";

/// A floor of one or two layers lets water through within 40 units of time, nine times sqrt(depth/g). Three
/// hold it, and four, as thick as the kernel reaches and what `talus check` asks for, hold it at the same
/// height.
TEST(WaterWalls, ThinOnesLeak) {
    const std::vector<double> layers{1, 2, 3, 4};
    const auto found = on_shared_ranks(layers.size(), [&](const Communicator& comm, std::size_t k) {
        const std::string text = fmt::format(fmt::runtime(tank), -layers[k]);
        const WaterScene scene = read_water_scene(comm, Scene::parse(text, "tank.toml"));
        WaterSimulation run(comm, scene.simulation, make_water(comm, scene));
        run.start();
        while (run.time() < scene.output.end_time && run.totals().least_place[1] > -1) run.step();
        return run.totals().least_place[1];
    });
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const bool holds = found[k] > 0;
        EXPECT_EQ(holds, layers[k] > 2) << layers[k] << ": " << found[k];
        if (is_root())
            print({"wall of particles", "floor under 20 layers", "layers", layers[k], INFINITY,
                   "lowest water (spacings)", found[k], holds});
    }
    EXPECT_NEAR(found[2], found[3], 0.01);
}

}  // namespace
}  // namespace talus::test
