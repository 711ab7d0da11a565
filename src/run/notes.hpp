#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "src/setup/water_scene.hpp"
#include "src/water_simulation.hpp"

/// What families of models that share water or grains tell of them.
namespace talus {

/// Before the first step: choices of a scene's water that are known to fail somewhere, each with its number
/// and its remedy. `time_step`: what is taken [s], that of sound and viscosity in water at rest if
/// nothing is said.
std::vector<std::string> water_warnings(const WaterScene& scene, std::optional<double> time_step = {});

/// Of water that begins within the cores of walls (water::Settings::wall_core), or nothing. Of the first
/// state. Collective.
std::vector<std::string> core_warnings(const WaterSimulation& water);

/// Tells once that a figure has grown beyond what a model bears.
class Watch {
  public:
    explicit Watch(double most) : most_(most) {}
    void see(double value) { greatest_ = std::max(greatest_, value); }
    double greatest() const { return greatest_; }
    /// True once, when the most or more has been seen.
    bool is_due() {
        if (told_ || greatest_ < most_) return false;
        told_ = true;
        return true;
    }

  private:
    double most_, greatest_ = 0;
    bool told_ = false;
};

/// Of the speed of sound [1]: densities then change by about a per cent.
inline constexpr double most_speed_of_water = 0.15;
std::string speed_note(double time, double speed, double sound);

/// Of the smaller radius [1]: tests/stability/grain_contacts.cpp.
inline constexpr double most_overlap_of_hard_grains = 0.05;
std::string overlap_note(double time, double overlap);

/// `stable_step`: what a grain pressed in by `overlap` of its radius bears [s], [1].
std::string pressed_note(double time, double stable_step, double overlap);

}  // namespace talus
