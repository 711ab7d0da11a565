#include "src/setup/water_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/setup/body_checks.hpp"
#include "src/setup/body_reader.hpp"
#include "src/setup/body_wall_reader.hpp"
#include "src/setup/names.hpp"
#include "src/setup/rigid_body_reader.hpp"
#include "src/setup/run_reader.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};
constexpr Range not_negative{0};
constexpr double sound_over_speed = 10;  // for changes of the density below one per cent

/// Everything but what follows from the spacing.
void read_water(const Section& table, WaterScene& scene) {
    const Box& box = scene.simulation.box;
    water::Settings& settings = scene.simulation.settings;
    settings.state.reference_density = table.number("density", "kg/m3", 1000.0, positive);
    if (table.has("greatest_speed") || !table.has("sound_speed"))
        scene.greatest_speed = table.number("greatest_speed", "m/s", {}, positive);
    settings.state.sound_speed =
        table.number("sound_speed", "m/s", sound_over_speed * scene.greatest_speed, positive);
    settings.state.exponent = static_cast<int>(table.integer("exponent", 7, 2, 20));
    settings.state.background_pressure = table.number("background_pressure", "Pa", 0.0, not_negative);
    if (table.has("rheology") && table.has("viscosity"))
        table.error("viscosity", "does not go with [water.rheology], whose `consistency` it is");
    settings.viscosity = table.number("viscosity", "Pa s", 0.0, not_negative);
    settings.artificial_viscosity = table.number("artificial_viscosity", "1", 0.0, {0, 10});
    settings.density_diffusion = table.number("density_diffusion", "1", 0.1, {0, 1});
    settings.shifting = table.number("shifting", "1", 0.0, {0, 2});
    settings.courant = table.number("courant", "1", 0.4, {0, 1, true});
    const Point gravity = origin_default(table, "gravity", "m/s2", box.dimension);
    for (std::size_t a = 0; a < 3; ++a) {
        settings.gravity[a] = gravity[a];
        if (box.boundary[a] != Boundary::periodic) settings.bearing[a] = gravity[a];
    }
}

/// Needs the smoothing length.
void read_rheology(const Section& table, water::Settings& settings) {
    if (!table.exists()) return;
    water::Rheology flow;
    flow.yield_stress = table.number("yield_stress", "Pa", 0.0, not_negative);
    flow.exponent = table.number("exponent", "1", 1.0, {0.1, 2});
    flow.consistency = table.number("consistency", flow.exponent == 1 ? "Pa s" : "1", {}, not_negative);
    if (flow.yield_stress == 0 && flow.consistency == 0)
        table.error("yield_stress", "and consistency are both 0; allowed: one of them above 0");
    // What sound allows for nothing, and enough to tell what flows from what does not.
    constexpr double many = 100;
    const bool stiffens_at_rest = flow.yield_stress > 0 || flow.exponent < 1;
    const double sound = settings.state.sound_speed, h = settings.smoothing_length,
                 rho0 = settings.state.reference_density,
                 flowing = flow.consistency * std::pow(sound / (sound_over_speed * h), flow.exponent - 1),
                 free = 0.125 / settings.courant * rho0 * sound * h;
    flow.greatest_viscosity = table.number("greatest_viscosity", "Pa s",
                                           std::max(free, (stiffens_at_rest ? many : 1) * flowing), positive);
    settings.rheology = flow;
}

/// Needs the spacing.
void read_wall_core(const Section& root, const Section& table, int dimension, water::Settings& settings) {
    constexpr double most = 0.95, usual = 0.9;  // water at rest is 1 away: docs/decisions/032
    const bool knows_cores = dimension == 3 && !table.has("rheology");
    const double core =
        table.number("wall_core", "1", root.has("grains") && knows_cores ? usual : 0.0, {0, most});
    if (core > 0 && !knows_cores)
        table.error("wall_core", "is of water of one viscosity in three dimensions; allowed: 0");
    settings.wall_core = core * settings.spacing();
}

/// What follows from all bodies, of which `first` is the first of water.
void complete_open_ends(std::uint8_t first, WaterScene& water) {
    OpenPlan& open = water.simulation.open;
    if (std::ranges::none_of(open.buffers, [](const water::Buffer& buffer) { return buffer.is_open(); })) {
        open.buffers.clear();
        return;
    }
    for (std::size_t b = 0; b < open.buffers.size(); ++b)
        open.buffers[b].particle_volume = water.census[b].particle_volume;
    open.names = water.body_names();
    open.water = first;
    open.spacing = water.spacing;
}

void read_bodies(const Communicator& comm, const Scene& scene, double smoothing, WaterScene& water) {
    const Section root = scene.root();
    WaterSetup& setup = water.simulation;
    const Box& box = setup.box;
    const std::vector<Section> tables = root.sections("body");
    if (tables.empty()) root.error("body", "a scene needs at least one [[body]]");
    if (tables.size() > 255) root.error("body", "more than 255 bodies");
    water.bodies.reserve(tables.size());
    RigidBodyReader rigid(root, box.dimension);
    for (const Section& table : tables) {
        const BodyContext context{.comm = comm,
                                  .scene = scene,
                                  .dimension = box.dimension,
                                  .domain = {box.lower, box.upper},
                                  .boundaries = box.boundary,
                                  .first_body = water.bodies.empty() ? nullptr : &water.bodies.front(),
                                  .in_impact = false,
                                  .gravitational_constant = 0,
                                  .seed = water.seed};
        const Body body = read_body_form(table, setup.settings.state.reference_density, context);
        refuse_same_name(table, water.bodies, body.name);
        if (table.has("density"))
            table.error("density",
                        "is not of a body: water.density is that of all water, `surface` gives its weight");
        water.bodies.push_back(body);
        setup.walls.push_back(read_body_wall(table, box.dimension, false));
        setup.records_force.push_back(table.flag("record_force", false));
        if (setup.records_force.back() && !setup.walls.back())
            table.error("record_force", "is of walls; allowed with wall = \"no_slip\" and \"free_slip\"");
        OpenEnd end = read_open_end(table, body, box);
        if (setup.walls.back() && end.buffer.is_open())
            table.error("wall", "does not go with inflow and outflow");
        if (setup.walls.back()) end.buffer.kind = water::Buffer::Kind::wall;
        setup.open.buffers.push_back(end.buffer);
        water.profiles.push_back(std::move(end.profile));
        rigid.read(table, setup.walls.back().has_value());
        if (setup.records_force.back() && rigid.is_rigid(water.bodies.size() - 1))
            table.error("record_force",
                        "is of walls that are not rigid bodies; their forces are always written");
        water.surface.emplace_back();
        if (!setup.walls.back() && table.has("surface")) water.surface.back() = table.number("surface", "m");
    }
    if (!scene.faulty()) refuse_too_many_places(tables, water.bodies, box.dimension);
    if (scene.faulty()) return;
    const auto makes_room = [&](std::size_t a, std::size_t b) {
        return setup.open.buffers[a].kind == water::Buffer::Kind::water && rigid.is_rigid(b);
    };
    for (std::size_t a = 0; a < tables.size(); ++a)
        for (std::size_t b = 0; b < tables.size(); ++b)
            if (makes_room(a, b)) water.bodies[a].left_out.push_back(water.bodies[b].shape);
    water.census = take_census(water.bodies, box.dimension, water.seed);
    refuse_empty_bodies(tables, water.bodies, water.census);
    for (std::size_t b = 0; b < tables.size(); ++b) refuse_outside(tables[b], water.bodies[b], box);
    if (!scene.faulty())
        refuse_overlaps(tables, water.bodies, box.dimension,
                        [&](std::size_t a, std::size_t b) { return makes_room(a, b) || makes_room(b, a); });
    const auto spacing = [&](std::size_t b) {
        return std::pow(water.census[b].particle_volume, 1.0 / box.dimension);
    };
    std::size_t first = 0;  // body of water
    while (first < tables.size() && setup.open.buffers[first].kind != water::Buffer::Kind::water) ++first;
    if (first < tables.size() && !scene.faulty()) water.spacing = spacing(first);
    for (std::size_t b = 0; b < tables.size() && !scene.faulty(); ++b) {
        constexpr double alike = 0.1;
        if (water.spacing > 0 && std::abs(spacing(b) / water.spacing - 1) > alike)
            tables[b].error("spacing",
                            fmt::format("particles are {:.4g} m apart, those of the water {:.4g} m; "
                                        "allowed: the same within a tenth",
                                        spacing(b), water.spacing));
    }
    if (water.spacing == 0 && !scene.faulty())
        root.error("body", "there is no water: all bodies are walls, inflows or outflows");
    if (!scene.faulty()) complete_open_ends(static_cast<std::uint8_t>(first), water);
    if (rigid.any() && !scene.faulty()) {
        const double radius = water::Settings::support() * smoothing * water.spacing;
        setup.rigid = rigid.make(comm, scene, box, water.bodies, water.census, radius, water.warnings);
    }
    if (std::none_of(setup.walls.begin(), setup.walls.end(),
                     [](const auto& wall) { return wall.has_value(); }))
        setup.walls.clear();
    if (std::ranges::none_of(setup.records_force, [](std::uint8_t records) { return records != 0; }))
        setup.records_force.clear();
}

/// Needs the kernel's radius.
void refuse_thin_buffers(const Section& root, const WaterScene& water) {
    const std::vector<water::Buffer>& buffers = water.simulation.open.buffers;
    const std::vector<Section> tables = root.sections("body");
    const double radius = water.simulation.settings.radius();
    for (std::size_t b = 0; b < buffers.size(); ++b)
        if (buffers[b].is_open() && buffers[b].depth() < radius * (1 - 1e-9))
            tables[b].error(
                buffers[b].kind == water::Buffer::Kind::inflow ? "inflow" : "outflow",
                fmt::format("is {:.4g} m deep along its direction; allowed: as deep as the kernel "
                            "reaches, {:.4g} m, or deeper",
                            buffers[b].depth(), radius));
}

std::vector<WaterGauge> read_gauges(const Section& root, const Box& box, std::vector<std::string>& warnings) {
    std::vector<WaterGauge> gauges;
    const bool has_ends = root.section("box").has("lower");
    for (const Section& table : root.sections("gauge")) {
        const WaterGauge gauge{table.text("name"), read_point(table, "place", "m", box.dimension)};
        refuse_same_name(table, gauges, gauge.name);
        for (std::size_t a = 0; a < static_cast<std::size_t>(box.dimension); ++a) {
            if (gauge.place[a] >= box.lower[a] && gauge.place[a] <= box.upper[a]) continue;
            const std::string where = fmt::format("is outside the box along {}", "xyz"[a]);
            if (box.boundary[a] != Boundary::open)
                table.error("place", where);
            else if (has_ends)
                warnings.push_back(
                    fmt::format("gauge '{}' {}, which is open there: it shows water that flies past, if any",
                                gauge.name, where));
        }
        gauges.push_back(gauge);
    }
    return gauges;
}

/// What the first fault keeps from being read.
void ignore_unread(const Section& root) {
    root.section("water").ignore("rheology");
    for (const Section& body : root.sections("body"))
        if (body.has("rigid"))
            for (const char* key : {"contact", "dem", "materials", "wall"}) root.ignore(key);
}

}  // namespace

bool is_water_scene(const Scene& scene) { return scene.root().section("water").exists(); }

WaterScene read_water_scene(const Communicator& comm, const Scene& scene) {
    WaterScene water = read_water(comm, scene);
    scene.finish();
    return water;
}

WaterScene read_water(const Communicator& comm, const Scene& scene) {
    const Section root = scene.root();
    WaterScene water;
    WaterSetup& setup = water.simulation;
    water.title = root.text("title", scene.file().stem().string());
    water.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0));
    const int dimension = static_cast<int>(root.integer("dimension", 3, 2, 3));
    setup.box = read_box(root.section("box"), dimension);
    const Section table = root.section("water");
    read_water(table, water);
    const double smoothing = table.number("smoothing", "1", dimension == 2 ? 2.0 : std::sqrt(3.0), {1, 4});
    read_bodies(comm, scene, smoothing, water);
    setup.settings.smoothing_length = smoothing * water.spacing;
    setup.settings.radius_in_spacings = water::Settings::support() * smoothing;
    read_wall_core(root, table, dimension, setup.settings);
    if (!scene.faulty()) read_rheology(table.section("rheology"), setup.settings);
    if (!scene.faulty()) refuse_thin_buffers(root, water);
    water.gauges = read_gauges(root, setup.box, water.warnings);
    water.output = read_output(root);
    const Section run = root.section("run");
    setup.partition = read_partition(run);
    setup.rebalance_interval = read_rebalance_interval(run);
    if (scene.faulty()) ignore_unread(root);
    return water;
}

std::vector<std::string> WaterScene::body_names() const {
    std::vector<std::string> names;
    for (const Body& body : bodies) names.push_back(body.name);
    return names;
}

double WaterScene::particles_across(std::size_t body) const {
    const int dimension = simulation.box.dimension;
    return thickness(bodies[body].shape, dimension) / std::pow(census[body].particle_volume, 1.0 / dimension);
}

ParticleSet empty_water(const WaterSetup& setup) {
    ParticleSet particles("water", setup.box.dimension);
    WaterSimulation::add_fields(particles, setup);
    return particles;
}

namespace {

/// Gives a body the pressure of its own weight, along axes that have an end, under a level surface, and the
/// mass of its compressed water.
void put_weight(const WaterSetup& setup, double surface, std::uint8_t body, ParticleSet& particles) {
    const water::Settings& settings = setup.settings;
    const auto& g = settings.bearing;
    const double gravity = std::hypot(g[0], g[1], g[2]);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (particles.data(field::body)[i] != body) continue;
        double depth = gravity * surface;
        for (int a = 0; a < particles.dimension(); ++a)
            depth += g[static_cast<std::size_t>(a)] * particles.data(field::position, a)[i];
        const double rest = settings.state.reference_density,
                     density = settings.state.density(settings.state.background_pressure +
                                                      rest * std::max(0.0, depth));
        particles.data(field::mass)[i] *= density / particles.data(field::density)[i];
        particles.data(field::density)[i] = density;
    }
}

/// Of inflows.
void put_speeds(const WaterScene& scene, ParticleSet& particles) {
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const std::size_t b = particles.data(field::body)[i];
        const water::Buffer& buffer = scene.simulation.open.buffers[b];
        if (buffer.kind != water::Buffer::Kind::inflow) continue;
        Point x{};
        for (int a = 0; a < particles.dimension(); ++a)
            x[static_cast<std::size_t>(a)] = particles.data(field::position, a)[i];
        particles.data(field::velocity, buffer.axis)[i] = buffer.sign * scene.profiles[b].speed(x);
    }
}

}  // namespace

ParticleSet make_water(const Communicator& comm, const WaterScene& scene) {
    const std::vector<Material> none(scene.bodies.size());
    ParticleSet particles =
        make_particles(comm, scene.bodies, none, empty_water(scene.simulation), {}, scene.seed);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        if (scene.surface[b])
            put_weight(scene.simulation, *scene.surface[b], static_cast<std::uint8_t>(b), particles);
    if (!scene.simulation.open.buffers.empty()) put_speeds(scene, particles);
    if (!scene.simulation.rigid.bodies.empty()) put_places_in_bodies(scene.simulation.rigid, particles);
    return particles;
}

}  // namespace talus
