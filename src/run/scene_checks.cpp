#include "src/run/scene_checks.hpp"

#include <fmt/format.h>

#include "io/snapshot.hpp"

namespace talus {

void check_plan(const Scene& scene, const SceneSetup& setup, double end_time) {
    const std::vector<Section> tables = scene.root().sections("body");
    for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
        const Body& body = setup.bodies[b];
        const EquationOfState& eos = setup.simulation.materials[b].eos;
        if (evaluate(eos, body.density, body.internal_energy).sound_speed > 0) continue;
        tables[b].error(
            tables[b].has("pressure") ? "pressure" : "internal_energy",
            fmt::format("a gas of {} J/kg has no sound speed; allowed: more than 0", body.internal_energy));
    }
    check_snapshots(scene, setup.output, end_time);
}

void check_snapshots(const Scene& scene, const OutputPlan& output, double end_time) {
    const double interval = output.snapshot_interval;
    if (interval > 0 && end_time / interval > static_cast<double>(most_snapshots - 2))
        scene.root().section("output").error(
            "snapshots",
            fmt::format("makes {:.3g} files until {} s; allowed: 0 or at least {:.3g} s", end_time / interval,
                        end_time, end_time / static_cast<double>(most_snapshots - 2)));
    scene.finish();
}

void check_box(const Scene& scene, const Simulation& simulation) {
    refuse_short_box(scene, simulation.setup().box, simulation.interaction_radius());
}

void refuse_short_box(const Scene& scene, const Box& box, double radius) {
    for (int axis = 0; axis < box.dimension; ++axis)
        if (box.boundary[static_cast<std::size_t>(axis)] != Boundary::open && box.length(axis) < radius)
            scene.root().section("box").error(
                "upper", fmt::format("the box is {} m long along {}, where it is closed, shorter than the "
                                     "interaction radius of {:.4g} m: a wider box or smaller spacings",
                                     box.length(axis), "xyz"[axis], radius));
    scene.finish();
}

void refuse_first_overlap(const Scene& scene, double greatest_overlap) {
    constexpr double most = 0.2;  // of the smaller radius
    if (greatest_overlap > most)
        scene.root().error(
            "grains",
            fmt::format("they overlap at the start, by up to {:.3g} of the smaller radius; allowed: {}",
                        greatest_overlap, most));
}

}  // namespace talus
