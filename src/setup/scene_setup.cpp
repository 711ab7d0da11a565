#include "src/setup/scene_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/setup/body_checks.hpp"
#include "src/setup/body_reader.hpp"
#include "src/setup/body_wall_reader.hpp"
#include "src/setup/geostatic.hpp"
#include "src/setup/gravity_reader.hpp"
#include "src/setup/impact_reader.hpp"
#include "src/setup/material_reader.hpp"
#include "src/setup/run_reader.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

sph::KernelKind kernel_named(const std::string& name) {
    if (name == "cubic_spline") return sph::KernelKind::cubic_spline;
    if (name == "wendland_c2") return sph::KernelKind::wendland_c2;
    if (name == "wendland_c4") return sph::KernelKind::wendland_c4;
    if (name == "wendland_c6") return sph::KernelKind::wendland_c6;
    return sph::KernelKind::gaussian;
}

void read_interpolation(const Section& table, int dimension, sph::Settings& settings) {
    const std::string name =
        table.choice("interpolation", {"automatic", "linear", "cubic", "quintic"}, "automatic");
    settings.compressed = sph::stable_compressed(dimension);
    settings.stretched = sph::stable_stretched(dimension);
    if (name == "linear") settings.compressed = settings.stretched = sph::Interpolation::linear;
    if (name == "cubic") settings.compressed = settings.stretched = sph::Interpolation::cubic;
    if (name == "quintic") settings.compressed = settings.stretched = sph::Interpolation::quintic;
}

/// `materials`: those of the bodies, which decide some defaults. `widest_spacing`: of the bodies in an open
/// box, where particles may fly off alone and h would grow without bound; 0 in a closed one.
sph::Settings read_sph(const Section& table, int dimension, const std::vector<Material>& materials,
                       double widest_spacing) {
    sph::Settings settings;
    bool all_gas = !materials.empty(), any_strength = false;
    double shock_slope = 1;
    for (const Material& material : materials) {
        const auto* gas = std::get_if<IdealGas>(&material.eos);
        all_gas &= gas != nullptr;
        any_strength |= material.shear_modulus > 0;
        if (gas) shock_slope = std::max(shock_slope, 0.5 * (gas->gamma + 1));
        // dU/du_p of most solids is near 1.5, which makes 1.5 (strong shocks) to 3 (weak ones).
        if (std::holds_alternative<Tillotson>(material.eos)) shock_slope = std::max(shock_slope, 2.0);
    }
    const bool godunov = table.choice("formulation", {"godunov", "standard"}, "godunov") == "godunov";
    settings.formulation = godunov ? sph::Formulation::godunov : sph::Formulation::standard;
    if (godunov) {
        settings.kernel = kernel_named(table.choice("kernel", {"gaussian"}, "gaussian"));
        read_interpolation(table, dimension, settings);
        settings.riemann = table.flag("riemann", true);
        settings.second_order = table.integer("order", 2, 1, 2) == 2;
        settings.riemann_velocity = table.flag("riemann_velocity", all_gas);
        settings.shock_slope = table.number("shock_slope", "1", shock_slope, positive);
    } else {
        settings.kernel = kernel_named(
            table.choice("kernel", {"gaussian", "cubic_spline", "wendland_c2", "wendland_c4", "wendland_c6"},
                         dimension == 1 ? "wendland_c4" : "wendland_c2"));
        settings.viscosity_alpha = table.number("viscosity_alpha", "1", 1.0, not_negative);
        settings.viscosity_beta = table.number("viscosity_beta", "1", 2.0, not_negative);
    }
    const std::string density = all_gas ? "summation" : "continuity";
    settings.density = table.choice("density", {"continuity", "summation"}, density) == "summation"
                           ? sph::DensityMethod::summation
                           : sph::DensityMethod::continuity;
    if (settings.density == sph::DensityMethod::summation && any_strength)
        table.error("density", "a solid with strength needs density = \"continuity\"");
    settings.variable_smoothing_length = table.choice("smoothing_length", {"constant", "variable"},
                                                      all_gas ? "variable" : "constant") == "variable";
    double eta = dimension == 1 ? 1.6 : dimension == 2 ? 1.3 : 1.45, courant = 0.3;
    if (godunov) {
        const auto [width, cutoff] = sph::gaussian_defaults(dimension, settings.variable_smoothing_length);
        settings.cutoff = table.number("cutoff", "1", cutoff, {1, 4});
        eta = width;
        courant = 0.5 / width;
    }
    settings.eta = table.number("eta", "1", eta, {0.5, 5});
    if (settings.variable_smoothing_length) {
        settings.smoothing_widening = table.number("smoothing_widening", "1", 1.0, {1, 5});
        constexpr double most_growth = 4;  // to 1/64 of the first density in 3D
        if (widest_spacing > 0 || table.has("largest_smoothing_length"))
            settings.largest_smoothing_length = table.number(
                "largest_smoothing_length", "m", most_growth * settings.eta * widest_spacing, positive);
    }
    settings.courant = table.number("courant", "1", courant, {0, 2, true});
    return settings;
}

/// Gravity that is the same everywhere, [sph] gravity.
std::optional<std::array<double, 3>> read_even_gravity(const Section& root, int dimension) {
    const Section table = root.section("sph");
    if (!table.has("gravity")) return {};
    if (root.section("gravity").exists())
        table.error("gravity", "the scene has self-gravity, [gravity]; it can have only one of them");
    return read_point(table, "gravity", "m s-2", dimension);
}

std::optional<LatePhase> read_late_phase(const Section& root, const Setup& simulation) {
    const Section table = root.section("late_phase");
    if (!table.exists()) return {};
    if (simulation.sph.density != sph::DensityMethod::continuity)
        table.error("", "needs sph.density = \"continuity\"");
    for (const Material& material : simulation.materials)
        if (std::holds_alternative<IdealGas>(material.eos))
            table.error(
                "", fmt::format("'{}' is an ideal gas, which has no stiffness of its own", material.name));
    return LatePhase{.from = table.number("from", "s", {}, not_negative),
                     .stiffness = table.number("stiffness", "1", 0.01, {0, 1, true})};
}

void arrange_impact(const ImpactPlan& plan, const Section& table, SceneSetup& setup) {
    const PlannedImpact planned =
        plan_impact(plan, setup.bodies, setup.census, setup.simulation.box.dimension);
    if (!planned.impact) {
        table.error(planned.key, planned.fault);
        return;
    }
    setup.impact = planned.impact;
    place(*setup.impact, setup.bodies, setup.census);
}

void read_bodies(const Communicator& comm, const Scene& scene, SceneSetup& setup) {
    const Section root = scene.root();
    const Box& box = setup.simulation.box;
    const std::vector<Section> tables = root.sections("body");
    if (tables.empty()) root.error("body", "a scene needs at least one [[body]]");
    if (tables.size() > 255) root.error("body", "more than 255 bodies");
    std::vector<std::string> names;
    names.reserve(tables.size());
    for (const Section& table : tables) names.push_back(table.text("name", table.path()));
    std::optional<ImpactPlan> plan = read_impact(root, names, box.dimension);
    if (plan) plan->gravitational_constant = setup.gravitational_constant;
    setup.bodies.reserve(tables.size());
    for (std::size_t b = 0; b < tables.size(); ++b) {
        setup.simulation.materials.push_back(find_material(comm, scene, tables[b], box.dimension));
        const BodyContext context{
            .comm = comm,
            .scene = scene,
            .dimension = box.dimension,
            .domain = {box.lower, box.upper},
            .boundaries = box.boundary,
            .first_body = b == 0 ? nullptr : &setup.bodies.front(),
            .in_impact = plan && (plan->target == b || plan->impactor == b),
            .gravitational_constant = setup.simulation.gravity ? setup.simulation.gravity->constant : 0,
            .seed = setup.seed};
        setup.bodies.push_back(read_body(tables[b], setup.simulation.materials.back(), context));
        setup.bodies.back().geostatic =
            read_geostatic(tables[b], setup.simulation.materials.back(), setup.simulation.even_gravity,
                           setup.bodies.back().shape, box.dimension);
        setup.simulation.walls.push_back(read_body_wall(tables[b], box.dimension));
        if (setup.simulation.walls.back() && setup.bodies.back().geostatic)
            tables[b]
                .section("geostatic")
                .error("", "does not go with wall: walls take the stress of what is in front");
        setup.simulation.held.push_back(tables[b].flag("held", false));
    }
    if (scene.faulty()) return;  // sizes and spacings may not fit each other
    auto& walls = setup.simulation.walls;
    if (std::none_of(walls.begin(), walls.end(), [](const auto& wall) { return wall.has_value(); }))
        walls.clear();
    refuse_too_many_places(tables, setup.bodies, box.dimension);
    if (scene.faulty()) return;
    setup.census = take_census(setup.bodies, box.dimension, setup.seed);
    refuse_empty_bodies(tables, setup.bodies, setup.census);
    if (scene.faulty()) return;
    if (plan) arrange_impact(*plan, root.section("impact"), setup);
    for (std::size_t b = 0; b < tables.size(); ++b) refuse_outside(tables[b], setup.bodies[b], box);
    if (!scene.faulty()) refuse_overlaps(tables, setup.bodies, box.dimension);
}

/// Widest spacing of the bodies if the box is open along any axis, else 0.
double widest_open_spacing(const SceneSetup& setup) {
    const Box& box = setup.simulation.box;
    const auto end = box.boundary.begin() + box.dimension;
    double widest = 0;
    if (std::find(box.boundary.begin(), end, Boundary::open) != end)
        for (const Body& body : setup.bodies) widest = std::max(widest, body.spacing);
    return widest;
}

/// Solids in contact bear neither tension nor shear across it, unless they are said to be bonded; standard
/// SPH and walls know bonded ones alone.
void read_contacts(const Section& root, SceneSetup& setup) {
    bool solid = false;
    for (const Material& material : setup.simulation.materials) solid |= material.shear_modulus > 0;
    if (setup.bodies.size() < 2) return;
    sph::Settings& sph = setup.simulation.sph;
    const Section table = root.section("sph");
    if (!solid || sph.formulation == sph::Formulation::standard || !setup.simulation.walls.empty())
        table.choice("contacts", {"bonded"}, "bonded");
    else
        sph.several_bodies =
            table.choice("contacts", {"frictionless", "bonded"}, "frictionless") == "frictionless";
}

}  // namespace

SceneSetup read_scene(const Communicator& comm, const Scene& scene) {
    const Section root = scene.root();
    SceneSetup setup;
    setup.title = root.text("title", scene.file().stem().string());
    setup.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0));
    const int dimension = static_cast<int>(root.integer("dimension", 3, 1, 3));
    setup.simulation.box = read_box(root.section("box"), dimension);
    setup.simulation.gravity = read_gravity(root, setup.simulation.box);
    if (setup.simulation.gravity) setup.gravitational_constant = setup.simulation.gravity->constant;
    setup.simulation.even_gravity = read_even_gravity(root, dimension);
    read_bodies(comm, scene, setup);
    setup.simulation.sph =
        read_sph(root.section("sph"), dimension, setup.simulation.materials, widest_open_spacing(setup));
    read_contacts(root, setup);
    setup.simulation.late_phase = read_late_phase(root, setup.simulation);
    if (scene.faulty())
        root.ignore("settle");  // it needs all bodies and their particles
    else
        setup.settle = read_settle(root, setup.bodies, setup.census, setup.simulation);
    const Section run = root.section("run");
    setup.output = read_output(root);
    setup.simulation.first_time_step = run.has("first_time_step")
                                           ? run.number("first_time_step", "s", {}, positive)
                                           : std::numeric_limits<double>::infinity();
    setup.simulation.largest_damage_step = run.number("largest_damage_step", "1", 0.1, {0, 1, true});
    setup.simulation.partition = read_partition(run);
    setup.simulation.rebalance_interval = read_rebalance_interval(run);
    setup.analysis = read_analysis(root.section("analysis"), setup.bodies, setup.simulation);
    setup.hand_off = read_hand_off(root, setup.bodies, setup.simulation, setup.output.end_time);
    scene.finish();
    return setup;
}

ParticleSet empty_particles(const SceneSetup& setup) {
    ParticleSet particles("sph", setup.simulation.box.dimension);
    add_fields(particles, setup.simulation);
    return particles;
}

ParticleSet make_particles(const Communicator& comm, const SceneSetup& setup) {
    return make_particles(comm, setup.bodies, setup.simulation.materials, empty_particles(setup),
                          setup.simulation.sph, setup.seed);
}

}  // namespace talus
