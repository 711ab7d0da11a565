#include "src/run/rung_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/depth/motion.hpp"
#include "src/setup/friction_reader.hpp"

namespace talus {

namespace {

constexpr double deep = 0.25;   // depth over length: beyond, run-out is a sixth and more too long
constexpr double long_ago = 5;  // times in which something ends: 1/150 of it is left

/// Depth over the shorter side of what the flow covers.
double aspect_of(const DepthScene& scene, const DepthTotals& start) {
    double length = start.greatest_place[0] - start.least_place[0];
    if (scene.simulation.box.dimension == 2)
        length = std::min(length, start.greatest_place[1] - start.least_place[1]);
    return length > 0 ? start.greatest_depth / length : 0;
}

/// Longest time in which drag ends the relative velocity, with the shares of the releases [s]; 0: none holds
/// both phases.
double drag_time(const DepthScene& scene, const depth::TwoPhase& phases, double depth) {
    double longest = 0;
    for (const Release& release : scene.releases) {
        const double solid = release.solid_fraction * depth, water = depth - solid;
        if (!(solid > 0 && water > 0)) continue;
        const double rate = phases.drag_factor(solid, water, scene.simulation.settings.gravity) *
                            (solid / phases.water_density + water / phases.solid_density);
        longest = std::max(longest, 1 / rate);
    }
    return longest;
}

std::string of_phases(const DepthScene& scene, const depth::TwoPhase& phases, double depth) {
    const double time = drag_time(scene, phases, depth);
    const auto all = [&](double share) {
        return std::all_of(scene.releases.begin(), scene.releases.end(),
                           [share](const Release& release) { return release.solid_fraction == share; });
    };
    if (all(0) || all(1))
        return "one material, without [two_phase]: all releases are of one phase; a fifth of the cost";
    if (time == 0) return "this one: solid and water start apart";
    if (!(long_ago * time < 1e-2 * scene.output.end_time))
        return fmt::format("this one: drag takes {:.3g} s to join solid and water, which is not short", time);
    return fmt::format(
        "one material with the friction of saturated solid, [friction] and no [two_phase]: drag joins solid "
        "and "
        "water within {:.3g} s of {:.3g} s; about a fifth of the cost. This one where water runs out of the "
        "solid",
        time, scene.output.end_time);
}

std::string of_pores(const DepthScene& scene, const PorePressure& pores, double depth) {
    const double mode = std::numbers::pi / 2 / depth, time = 1 / (pores.law.coefficient * mode * mode),
                 end = scene.output.end_time;
    if (long_ago * time < 1e-2 * end)
        return fmt::format("no [pore_pressure]: it drains within {:.3g} s of {:.3g} s; about the same cost",
                           time, end);
    if (pores.points > 1 && end < 1e-2 * time)
        return fmt::format("points = 1: pore pressure needs {:.3g} s to drain, the run takes {:.3g} s", time,
                           end);
    return fmt::format("this one: pore pressure drains in {:.3g} s, the run takes {:.3g} s", time, end);
}

}  // namespace

std::string rung_advice(const DepthScene& scene, const DepthTotals& start) {
    const DepthSetup& setup = scene.simulation;
    const double aspect = aspect_of(scene, start);
    const bool is_soil = friction_coefficient(setup.friction) > 0;
    const bool one = scene.releases.size() == 1;  // the length of several tells nothing of each
    if (is_soil && one && aspect > deep)
        return fmt::format(
            "a continuum in a plane (as runs/column_collapse): the flow is {:.2g} times as deep as long at "
            "the "
            "start, and beyond {} what falls and topples is no depth-integrated flow; 10 to 1000 times the "
            "cost",
            aspect, deep);
    if (setup.settings.two_phase) return of_phases(scene, *setup.settings.two_phase, start.greatest_depth);
    if (setup.pore_pressure) return of_pores(scene, *setup.pore_pressure, start.greatest_depth);
    const auto& boundary = setup.box.boundary;
    if (!one || std::find(boundary.begin(), boundary.end(), Boundary::reflecting) != boundary.end())
        return "this one: releases that meet each other or a wall have no closed form";
    const auto* coulomb = std::get_if<depth::Coulomb>(&setup.friction);
    if (!coulomb || !setup.terrain->is_plane() || coulomb->cohesion > 0 || setup.settings.entrainment > 0)
        return "this one: neither the ground nor the bed's law has a closed form";
    const depth::Tilt tilt(setup.terrain->slope(0, 0));
    const double sine = std::sqrt(1 - tilt.cosine2),
                 along = setup.settings.gravity * (sine - tilt.cosine * coulomb->friction);
    return fmt::format(
        "a sliding block, if the way of the centre is asked: on a plane with Coulomb's friction it {}; no "
        "cost. This "
        "one for the spread",
        along > 0 ? fmt::format("is accelerated by {:.4g} m/s2", along)
                  : fmt::format("is slowed by {:.4g} m/s2 once it moves", -along));
}

}  // namespace talus
