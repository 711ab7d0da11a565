#include "src/setup/coupled_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <variant>

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};

coupling::DragLaw read_drag(const Section& table) {
    using namespace coupling;
    const std::string name =
        table.choice("drag",
                     {DiFelice::name, Stokes::name, SchillerNaumann::name, WenYu::name, Ergun::name,
                      Gidaspow::name, HuilinGidaspow::name, KochHill::name, Beetstra::name},
                     std::string(DiFelice::name));
    DragLaw law = DiFelice{};
    const auto take = [&]<class Law>(Law candidate) {
        if (name == Law::name) law = candidate;
    };
    take(Stokes{});
    take(SchillerNaumann{});
    take(WenYu{});
    take(Ergun{});
    take(Gidaspow{});
    take(HuilinGidaspow{});
    take(KochHill{});
    take(Beetstra{});
    return law;
}

/// Flat walls at rest, behind which grains have images.
std::vector<coupling::MirrorPlane> planes_of(const std::vector<dem::Wall>& walls) {
    std::vector<coupling::MirrorPlane> planes;
    for (const dem::Wall& wall : walls) {
        const dem::WallMotion& m = wall.motion;
        if (norm(m.velocity) > 0 || norm(m.amplitude) > 0 || m.angular_velocity != 0 ||
            m.angle_amplitude != 0)
            continue;
        if (const auto* plane = std::get_if<dem::PlaneShape>(&wall.shape)) {
            planes.push_back({plane->point, plane->normal});
        } else if (const auto* box = std::get_if<dem::ContainerShape>(&wall.shape)) {
            planes.insert(planes.end(), {{box->lower, {1, 0, 0}},
                                         {box->lower, {0, 1, 0}},
                                         {box->lower, {0, 0, 1}},
                                         {box->upper, {-1, 0, 0}},
                                         {box->upper, {0, -1, 0}},
                                         {box->upper, {0, 0, -1}}});
        }
    }
    return planes;
}

void read_coupling(const Section& root, CoupledScene& scene) {
    const Section table = root.section("coupling");
    const WaterSetup& water = scene.water.simulation;
    CouplingSetup& how = scene.coupling;
    using namespace coupling;
    how.laws.drag = read_drag(table);
    how.laws.model = table.choice("model", {"A", "B"}, "A") == "A" ? PressureModel::a : PressureModel::b;
    how.laws.viscosity = table.number("viscosity", "Pa s", water.settings.viscosity, {0});
    how.laws.virtual_mass = table.number("virtual_mass", "1", 0.0, {0, 5});
    if (table.flag("basset", false)) {
        const double shortest = scene.grains.simulation.time_step;
        const double longest =
            table.number("basset_memory", "s", std::max(scene.water.output.end_time, 2 * shortest),
                         {2 * shortest, 1e12 * shortest});
        how.laws.basset.emplace(shortest, longest);
    }
    const std::string lift = table.choice("lift", {"none", "saffman_mei", "magnus", "both"}, "none");
    how.laws.saffman = lift == "saffman_mei" || lift == "both";
    how.laws.magnus = lift == "magnus" || lift == "both";
    how.laws.torque = table.flag("torque", false);
    how.laws.feedback = table.flag("feedback", true);
    how.laws.least_fluid_fraction = table.number("least_fluid_fraction", "1", 0.2, {0.05, 1});
    how.laws.gravity = {water.settings.gravity[0], water.settings.gravity[1], water.settings.gravity[2]};
    how.fraction =
        table.choice("volume_fraction", {"normalised_kernel", "kernel"}, "normalised_kernel") == "kernel"
            ? VolumeFraction::raw
            : VolumeFraction::normalised;
    how.spreading.shape = table.choice("kernel", {"wendland", "mollifier"}, "wendland") == "mollifier"
                              ? Spreading::Shape::mollifier
                              : Spreading::Shape::wendland;
    how.spreading.radius = table.number("averaging_length", "m", scene.kernel_radius, positive);
    if (table.flag("mirror", true)) how.spreading.planes = planes_of(scene.grains.simulation.walls);
    if (how.spreading.radius > scene.kernel_radius * (1 + 1e-12))
        table.error(
            "averaging_length",
            fmt::format("is {} m, more than the kernel of the water reaches; allowed: at most {:.4g} m",
                        how.spreading.radius, scene.kernel_radius));
    if (scene.greatest_diameter > how.spreading.radius)
        table.error(
            table.has("averaging_length") ? "averaging_length" : "",
            fmt::format(
                "grains of up to {:.4g} m across are larger than the averaging length, {:.4g} m: a grain "
                "that is larger than what it is spread over has no place in mean equations; allowed: "
                "grains at most half as large, or bodies of water particles of their own",
                scene.greatest_diameter, how.spreading.radius));
    if (how.laws.viscosity == 0 && how.laws.basset)
        table.error("basset", "needs water.viscosity or coupling.viscosity above 0");
    if (how.laws.viscosity == 0 && std::holds_alternative<Stokes>(how.laws.drag))
        table.error("drag", "stokes needs water.viscosity or coupling.viscosity above 0");
}

/// What neither family of models knows of the other.
void refuse_together(const Section& root, const CoupledScene& scene) {
    const GrainSetup& grains = scene.grains.simulation;
    for (const char* name : {"source", "sink", "bond", "gravity"})
        if (root.has(name)) root.error(name, "does not go with grains in water");
    if (!scene.water.simulation.open.buffers.empty())
        root.error("body", "inflows and outflows of water do not go with grains in it");
    if (scene.water.simulation.settings.rheology)
        root.section("water").error(
            "rheology", "does not go with grains: their drag is that in a fluid of one viscosity");
    if (!scene.water.simulation.rigid.bodies.empty())
        root.error("body", "rigid bodies do not go with grains in water");
    if (!grains.clumps.empty()) root.error("grains", "clumps do not go with grains in water");
    // Where the box is periodic, each phase may feel gravity less what the mean gradient of the pressure
    // bears.
    const WaterSetup& water = scene.water.simulation;
    const std::array<double, 3> of_grains{grains.gravity.x, grains.gravity.y, grains.gravity.z};
    const bool all_held = std::ranges::all_of(grains.held, [](std::uint8_t held) { return held != 0; });
    for (std::size_t a = 0; a < 3; ++a)
        if (!all_held && water.box.boundary[a] != Boundary::periodic &&
            water.settings.gravity[a] != of_grains[a])
            root.section("dem").error(
                "gravity",
                fmt::format("differs from water.gravity along {}; allowed: the same where the box is "
                            "not periodic",
                            "xyz"[a]));
}

void judge_resolution(CoupledScene& scene) {
    constexpr double least_spacing = 2;  // in diameters, Robinson, Ramaioli & Luding (2014)
    const double ratio = scene.water.spacing / scene.greatest_diameter;
    if (ratio < least_spacing)
        scene.warnings.push_back(
            fmt::format("grains of up to {:.4g} m across in water of spacing {:.4g} m: mean equations hold "
                        "for water coarser than {} "
                        "diameters; for grains larger than the spacing the resolved coupling serves, bodies "
                        "that move in water",
                        scene.greatest_diameter, scene.water.spacing, least_spacing));
    constexpr double least_average = 1.25;  // in diameters, 1.212: tests/stability/solid_fraction.cpp
    const double average = scene.coupling.spreading.radius, least = least_average * scene.greatest_diameter;
    if (average < least)
        scene.warnings.push_back(fmt::format(
            "grains of up to {:.4g} m across are averaged over {:.4g} m: where they are packed they "
            "fill more than all of the space; {}",
            scene.greatest_diameter, average,
            least < scene.kernel_radius
                ? fmt::format("coupling.averaging_length = {:.4g} keeps below that", least)
                : "coarser water keeps below that"));
    if (scene.coupling.laws.viscosity == 0)
        scene.warnings.emplace_back("the water has no viscosity: it does not drag the grains");
}

}  // namespace

bool is_coupled_scene(const Scene& scene) {
    return scene.root().section("water").exists() &&
           (scene.root().has("grains") || scene.root().has("coupling"));
}

CoupledScene read_coupled_scene(const Communicator& comm, const Scene& scene) {
    const Section root = scene.root();
    if (!root.has("grains")) root.error("coupling", "is for scenes with [[grains]]");
    CoupledScene coupled{
        .water = read_water(comm, scene), .grains = read_grains_of(comm, scene), .coupling = {}};
    coupled.kernel_radius = coupled.water.simulation.settings.radius();
    for (const GrainBody& body : coupled.grains.bodies)
        coupled.greatest_diameter = std::max(coupled.greatest_diameter, 2 * body.greatest_radius);
    if (!scene.faulty()) {
        read_coupling(root, coupled);
        refuse_together(root, coupled);
    } else {
        root.ignore("coupling");
    }
    scene.finish();
    judge_resolution(coupled);
    const CoupledSetup completed = CoupledSimulation::completed(coupled.simulation());
    coupled.water.simulation = completed.water;
    coupled.grains.simulation.fluid_cells = completed.grains.fluid_cells;
    coupled.grains.simulation.slip_memories = completed.grains.slip_memories;
    return coupled;
}

void take_history_kernel(const Scene& scene, const std::map<std::string, double>& numbers,
                         CoupledScene& coupled) {
    const Section table = scene.root().section("coupling"), dem = scene.root().section("dem");
    std::optional<coupling::HistoryKernel>& kernel = coupled.coupling.laws.basset;
    const auto shortest = numbers.find(CoupledSimulation::shortest_memory),
               longest = numbers.find(CoupledSimulation::longest_memory);
    const bool remembers = shortest != numbers.end() && longest != numbers.end();
    if (remembers != kernel.has_value())
        table.error("basset", remembers ? "the checkpoint goes on with memories of past slips; allowed: true"
                                        : "the checkpoint has no memories of past slips; allowed: false");
    if (remembers && kernel) {
        const double step = coupled.grains.simulation.time_step;
        if (step < shortest->second)
            dem.error("time_step", fmt::format("{} s is below the shortest time of the memories of "
                                               "coupling.basset in the checkpoint; allowed: at least {} s",
                                               step, shortest->second));
        if (table.has("basset_memory") && kernel->longest() != longest->second)
            table.error(
                "basset_memory",
                fmt::format("the memories in the checkpoint last for {} s; allowed: that, or to leave "
                            "out basset_memory",
                            longest->second));
        kernel.emplace(shortest->second, longest->second);
        coupled.grains.simulation.slip_memories = kernel->size();
    }
    scene.finish();
}

}  // namespace talus
