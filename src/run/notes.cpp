#include "src/run/notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "physics/water/sound_waves.hpp"
#include "src/run/warnings.hpp"
#include "src/water/wall_gap.hpp"

namespace talus {

namespace {

/// Sound that the time step makes grow: physics/water/sound_waves.hpp, tests/stability/water.cpp.
void warn_of_sound(const water::Settings& settings, int dimension, double step,
                   std::vector<std::string>& found) {
    constexpr double slow = 1e-4;  // a thousand steps then make a tenth more of it
    const double growth = water::fastest_growing(settings, dimension, step).growth;
    if (growth < 1 + slow) return;
    water::Settings diffusive = settings;
    diffusive.density_diffusion = 0.1;
    std::string remedy;
    if (const double most = water::greatest_courant(diffusive, dimension, 1);
        settings.density_diffusion < diffusive.density_diffusion && settings.courant <= most)
        remedy = fmt::format("water.density_diffusion = {}", diffusive.density_diffusion);
    else
        remedy =
            fmt::format("water.courant = {:.2g}", 0.95 * water::greatest_courant(settings, dimension, 1));
    found.push_back(
        fmt::format("sound in still water grows {:.2g} times in a hundred steps with water.courant = {} and "
                    "water.density_diffusion = {}; {} damps it",
                    std::pow(growth, 100), settings.courant, settings.density_diffusion, remedy));
}

}  // namespace

std::vector<std::string> water_warnings(const WaterScene& scene, std::optional<double> time_step) {
    std::vector<std::string> found = scene.warnings;
    const water::Settings& settings = scene.simulation.settings;
    const int dimension = scene.simulation.box.dimension;
    if (settings.artificial_viscosity == 0)
        warn_of_sound(settings, dimension,
                      time_step.value_or(
                          std::min(settings.courant * settings.smoothing_length / settings.state.sound_speed,
                                   settings.viscous_time_step())),
                      found);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        if (!scene.simulation.walls.empty() && scene.simulation.walls[b])
            warn_of_thin_wall(scene.bodies[b], settings.radius(), dimension, found);
    for (int axis = 0; axis < dimension; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (scene.simulation.box.boundary[a] == Boundary::reflecting && settings.gravity[a] != 0)
            found.push_back(
                fmt::format("gravity acts across the reflecting boundaries along {}, whose images "
                            "do not bear the weight of water; walls of particles do",
                            "xyz"[a]));
    }
    return found;
}

std::vector<std::string> core_warnings(const WaterSimulation& water) {
    const water::Settings& settings = water.setup().settings;
    const double core = settings.wall_core;
    if (!(core > 0)) return {};
    const WallGap gap = find_wall_gap(water, core);
    if (gap.within == 0) return {};
    return {
        fmt::format("{} particles of water begin nearer to a wall's particles than {:.3g} m, the nearest "
                    "at {:.3g} m: walls with a core push such water off, that with {:.3g} Pa; "
                    "lattice = \"cubic\" without jitter leaves a spacing between them",
                    gap.within, core, gap.least,
                    water::core_hardness * settings.state.reference_density * settings.state.sound_speed *
                        settings.state.sound_speed * (1 - gap.least / core))};
}

std::string speed_note(double time, double speed, double sound) {
    return fmt::format(
        "time {:.4g} s: water moves at {:.4g} m/s, {:.2g} of the speed of sound, {:.4g} m/s; above "
        "a tenth its density changes by more than a per cent: a greater water.greatest_speed?",
        time, speed, speed / sound, sound);
}

std::string overlap_note(double time, double overlap) {
    return fmt::format(
        "time {:.4g} s: grains overlap by {:.2g} of the smaller radius; above {} contacts last "
        "longer and pack closer than those of hard grains: a greater stiffness?",
        time, overlap, most_overlap_of_hard_grains);
}

std::string pressed_note(double time, double stable_step, double overlap) {
    return fmt::format(
        "time {:.4g} s: contacts of a grain pressed in by {:.2g} of its radius bear steps up to {:.3g} s; "
        "beyond that grains that are squeezed shake, and take energy from what squeezes them or give it: "
        "dem.time_step = {:.2g} s?",
        time, overlap, stable_step, 0.8 * stable_step);
}

}  // namespace talus
