#pragma once
#include <fmt/format.h>

#include <string>

#include "src/setup/scene_setup.hpp"

namespace talus::test {

/// A ball of rock of 50 km radius in its own gravity. `more` is added to the scene.
inline SceneSetup rock_ball(const Communicator& comm, int particles, const std::string& more) {
    const std::string text = fmt::format(R"([materials.rock]
density = 2700
shear_modulus = "22.7 GPa"
equation_of_state = {{ kind = "linear", sound_speed = "3 km/s" }}
fracture = {{ weibull_k = 4e35, weibull_m = 9 }}

[[body]]
name = "ball"
material = "rock"
shape = "sphere"
radius = "50 km"
particles = {}
spin_period = "20 h"

[gravity]

[run]
end_time = 1
{})",
                                         particles, more);
    return read_scene(comm, Scene::parse(text, "rock_ball.toml"));
}

}  // namespace talus::test
