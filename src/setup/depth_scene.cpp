#include "src/setup/depth_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/depth_fields.hpp"
#include "domain/two_phase_fields.hpp"
#include "src/setup/friction_reader.hpp"
#include "src/setup/release_reader.hpp"
#include "src/setup/results_reader.hpp"
#include "src/setup/run_reader.hpp"
#include "src/setup/shape_reader.hpp"
#include "src/setup/terrain_reader.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

/// Savage and Hutter's coefficients: 2 (1 -+ sqrt(1 - cos^2 phi (1 + tan^2 delta)))/cos^2 phi - 1.
std::optional<depth::EarthPressure> read_earth_pressure(const Section& table, double bed_friction) {
    if (!table.has("internal_friction_angle")) return {};
    const double phi = table.number("internal_friction_angle", "rad", {}, positive);
    const double cos2 = std::cos(phi) * std::cos(phi), root2 = 1 - cos2 * (1 + bed_friction * bed_friction);
    if (phi >= std::numbers::pi / 2 || root2 < 0) {
        table.error(
            "internal_friction_angle",
            fmt::format("is {:.4g} degrees; allowed: from the bed's angle of friction, {:.4g} "
                        "degrees, to below 90",
                        phi * 180 / std::numbers::pi, std::atan(bed_friction) * 180 / std::numbers::pi));
        return {};
    }
    return depth::EarthPressure{.active = 2 * (1 - std::sqrt(root2)) / cos2 - 1,
                                .passive = 2 * (1 + std::sqrt(root2)) / cos2 - 1,
                                .mobilizing_strain = table.number("mobilizing_strain", "1", 0.2, positive)};
}

bool any_level(const Section& root) {
    const std::vector<Section> releases = root.sections("release");
    return std::any_of(releases.begin(), releases.end(), [](const Section& one) { return one.has("level"); });
}

/// What is not known of solid and water together.
void refuse_with_two_phase(const Section& root, const depth::Settings& settings) {
    const Section table = root.section("depth");
    const auto refuse = [](const Section& where, const char* key, bool is_asked) {
        if (is_asked) where.error(key, "is not available together with [two_phase]");
    };
    refuse(table, "gradient", settings.gradient == depth::Gradient::level);
    refuse(table, "internal_friction_angle", settings.earth_pressure.has_value());
}

/// What is not known of columns that merge.
void refuse_with_merging(const Section& root, const depth::Settings& settings, const Box& box) {
    const Section table = root.section("depth");
    const auto refuse = [&](bool is_asked, const char* what) {
        if (is_asked) table.error("merging_distance", fmt::format("is not available together with {}", what));
    };
    refuse(settings.two_phase.has_value(), "[two_phase]");
    refuse(root.has("pore_pressure"), "[pore_pressure]");
    refuse(settings.gradient == depth::Gradient::level, "gradient = \"level\"");
    refuse(settings.earth_pressure.has_value(), "internal_friction_angle");
    refuse(settings.balance, "a balanced lake");
    for (int axis = 0; axis < box.dimension; ++axis)
        refuse(box.boundary[static_cast<std::size_t>(axis)] != Boundary::open, "sides that are not open");
}

depth::Settings read_settings(const Section& root, int dimension, const DepthSetup& setup) {
    const Section table = root.section("depth");
    depth::Settings settings;
    const bool fitted = table.choice("form", {"cartesian", "bed_fitted"}, "cartesian") == "bed_fitted";
    settings.form = fitted ? depth::Form::bed_fitted : depth::Form::cartesian;
    const bool by_level = table.choice("gradient", {"potential", "level"}, "potential") == "level";
    settings.gravity = table.number("gravity", "m s-2", 9.81, positive);
    settings.two_phase = read_two_phase(root);
    if (settings.two_phase)
        settings.density = settings.two_phase->solid_density;
    else
        settings.density = table.number("density", "kg m-3", 1000.0, positive);
    // Columns of a phase pass over those of the other: the sum over these must not depend on where they
    // stand.
    const double narrow = dimension == 1 ? 1.6 : 1.3, wide = dimension == 1 ? 2.4 : 2;
    settings.eta = table.number("eta", "1", settings.two_phase ? wide : narrow, {1, 4});
    settings.viscosity = table.number("viscosity", "1", by_level ? 2.0 : 1.0, not_negative);
    settings.courant = table.number("courant", "1", 0.4, {0, 1, true});
    settings.merging_distance = table.number("merging_distance", "m", 0.0, not_negative);
    settings.entrainment = table.number("entrainment", "m-1", 0.0, not_negative);
    if (fitted) settings.curvature = table.flag("curvature", true);
    if (!fitted && any_level(root)) settings.balance = table.flag("balance", !by_level);
    settings.earth_pressure = read_earth_pressure(table, friction_coefficient(setup.friction));
    if (by_level) {
        settings.gradient = depth::Gradient::level;
        if (fitted) table.error("gradient", "level needs form = \"cartesian\"");
        if (settings.earth_pressure) table.error("internal_friction_angle", "needs gradient = \"potential\"");
    }
    if (settings.two_phase) refuse_with_two_phase(root, settings);
    if (settings.merging_distance > 0) refuse_with_merging(root, settings, setup.box);
    return settings;
}

void read_releases(const Communicator& comm, const Scene& scene, const SceneTerrain& terrain,
                   DepthScene& setup) {
    const Section root = scene.root();
    const Box& box = setup.simulation.box;
    const std::vector<Section> tables = root.sections("release");
    std::vector<const Section*> table_of;  // of each release
    if (tables.empty()) root.error("release", "a depth-integrated scene needs at least one [[release]]");
    for (const Section& table : tables) {
        const BodyContext context{.comm = comm,
                                  .scene = scene,
                                  .dimension = box.dimension,
                                  .domain = {box.lower, box.upper},
                                  .boundaries = box.boundary,
                                  .first_body = nullptr,
                                  .in_impact = false,
                                  .gravitational_constant = 0,
                                  .seed = 0};
        const double spacing = setup.releases.empty() ? 0 : setup.releases.front().spacing;
        for (Release& release : read_release(table, context, terrain, spacing)) {
            setup.releases.push_back(std::move(release));
            table_of.push_back(&table);
        }
    }
    if (scene.faulty()) return;
    for (std::size_t k = 0; k < table_of.size(); ++k)
        if (setup.simulation.settings.balance && setup.simulation.settings.two_phase &&
            setup.releases[k].level && setup.releases[k].solid_fraction > 0)
            table_of[k]->error("level",
                               "is that of a lake at rest, which holds no solid; allowed: "
                               "solid_fraction = 0, or depth.balance = false");
    if (scene.faulty()) return;
    const double merging = setup.simulation.settings.merging_distance;
    for (std::size_t k = 0; k < table_of.size(); ++k) {
        const Section& table = *table_of[k];
        if (merging >= setup.releases[k].spacing)
            root.section("depth").error(
                "merging_distance",
                fmt::format("would merge {} as it is released, {:.4g} m apart; allowed: less",
                            setup.releases[k].name, setup.releases[k].spacing));
        const auto [released, beyond, unknown, cut, outside_box] =
            columns_of(setup.releases[k], *setup.simulation.terrain, setup.simulation.settings, box);
        if (unknown)
            table.error("", fmt::format("reaches beyond the terrain, at ({:.6g}, {:.6g}) m {}", (*unknown)[0],
                                        (*unknown)[1],
                                        setup.simulation.terrain->cell_name((*unknown)[0], (*unknown)[1])));
        else if (outside_box)
            table.error("", fmt::format("reaches out of the box, at ({:.6g}, {:.6g}) m", (*outside_box)[0],
                                        (*outside_box)[1]));
        else if (released.empty())
            table.error(table.has("level") ? "level" : "spacing",
                        "has no particles: none of its lattice is wet; make it finer or higher");
        if (cut)
            setup.notes.push_back(fmt::format(
                "the water of {} ends where the terrain does, at ({:.6g}, {:.6g}) m, and flows out there",
                setup.releases[k].name, (*cut)[0], (*cut)[1]));
    }
}

/// Of what a release is made, where there are two phases.
struct Phase {
    double share = 1;  ///< of the volume
    bool is_water = false;
};

/// Appends this rank's share of some columns.
void append_share(const Communicator& comm, const std::vector<ReleasedColumn>& columns, const Point& velocity,
                  std::uint64_t first_id, ParticleSet& particles, Phase phase = {}) {
    const auto ranks = static_cast<std::uint64_t>(comm.size()),
               rank = static_cast<std::uint64_t>(comm.rank());
    const std::uint64_t count = columns.size(), begin = count * rank / ranks,
                        end = count * (rank + 1) / ranks;
    const std::size_t place = particles.size();
    particles.resize(place + end - begin);
    for (std::uint64_t k = begin; k < end; ++k) {
        const std::size_t i = place + k - begin;
        const ReleasedColumn& column = columns[k];
        particles.data(field::id)[i] = first_id + k;
        for (int a = 0; a < particles.dimension(); ++a) {
            particles.data(field::position, a)[i] = column.place[static_cast<std::size_t>(a)];
            particles.data(field::velocity, a)[i] = velocity[static_cast<std::size_t>(a)];
        }
        particles.data(field::volume)[i] = phase.share * column.volume;
        particles.data(field::depth)[i] = phase.share * column.depth;
        if (particles.has(field::is_water)) particles.data(field::is_water)[i] = phase.is_water ? 1 : 0;
        particles.data(field::smoothing_length)[i] = column.smoothing_length;
    }
}

/// Appends the columns of a lake with the acceleration that they would have at rest, if the lake went on
/// where its region ends. Collective.
void append_lake(const Communicator& comm, const DepthSetup& setup, const Release& release,
                 const ReleasedColumns& columns, std::uint64_t first_id, ParticleSet& particles) {
    DepthSetup still = setup;
    still.settings.balance = false;
    still.pore_pressure.reset();
    ParticleSet all = empty_columns(still);
    const std::uint64_t end_id = first_id + columns.released.size();
    const Phase water{1, release.solid_fraction == 0};
    append_share(comm, columns.released, {}, first_id, all, water);
    append_share(comm, columns.beyond, {}, end_id, all, water);
    DepthSimulation lake(comm, still, std::move(all));
    lake.start();
    const ParticleSet& found = lake.particles();
    for (std::size_t k = 0; k < found.size(); ++k) {
        if (found.data(field::id)[k] >= end_id) continue;
        const std::size_t i = particles.size();
        particles.resize(i + 1);
        for (const Field<double>* copied : {&field::volume, &field::depth, &field::smoothing_length})
            particles.data(*copied)[i] = found.data(*copied)[k];
        particles.data(field::id)[i] = found.data(field::id)[k];
        if (particles.has(field::is_water)) particles.data(field::is_water)[i] = 1;
        for (int a = 0; a < particles.dimension(); ++a) {
            particles.data(field::position, a)[i] = found.data(field::position, a)[k];
            particles.data(field::velocity, a)[i] = release.velocity[static_cast<std::size_t>(a)];
            particles.data(field::still_acceleration, a)[i] = found.data(field::acceleration, a)[k];
        }
    }
}

}  // namespace

bool is_depth_scene(const Scene& scene) { return scene.root().has("depth"); }

DepthScene read_depth_scene(const Communicator& comm, const Scene& scene) {
    const Section root = scene.root();
    DepthScene setup;
    setup.title = root.text("title", scene.file().stem().string());
    const int dimension = static_cast<int>(root.integer("dimension", 2, 1, 2));
    DepthSetup& simulation = setup.simulation;
    simulation.box = read_box(root.section("box"), dimension);
    const SceneTerrain terrain = read_terrain(comm, scene, root.section("terrain"), dimension);
    simulation.terrain = terrain.ground;
    simulation.friction = read_basal_friction(root.section("friction"));
    simulation.pore_pressure = read_pore_pressure(root.section("pore_pressure"));
    simulation.settings = read_settings(root, dimension, simulation);
    read_releases(comm, scene, terrain, setup);
    double widest = 0;
    for (const Release& release : setup.releases) widest = std::max(widest, release.spacing);
    const double most_growth = dimension == 1 ? 50 : 5;  // of the smoothing length, where columns fly apart
    simulation.settings.largest_smoothing_length = root.section("depth").number(
        "largest_smoothing_length", "m", most_growth * simulation.settings.eta * widest,
        {simulation.settings.eta * widest});
    setup.output = read_output(root);
    setup.results = read_results(root, terrain, dimension);
    setup.gauges = read_gauge_places(root, *terrain.ground, dimension);
    const Section run = root.section("run");
    simulation.partition = read_partition(run);
    simulation.rebalance_interval = read_rebalance_interval(run);
    scene.finish();
    return setup;
}

ParticleSet empty_columns(const DepthSetup& setup) {
    ParticleSet particles("columns", setup.box.dimension);
    DepthSimulation::add_fields(particles, setup);
    return particles;
}

ParticleSet make_columns(const Communicator& comm, const DepthScene& scene) {
    ParticleSet particles = empty_columns(scene.simulation);
    std::uint64_t first_id = 0;
    for (const Release& release : scene.releases) {
        const ReleasedColumns columns =
            columns_of(release, *scene.simulation.terrain, scene.simulation.settings, scene.simulation.box);
        if (scene.simulation.settings.balance && release.level) {
            append_lake(comm, scene.simulation, release, columns, first_id, particles);
            first_id += columns.released.size();
            continue;
        }
        if (release.solid_fraction > 0)
            append_share(comm, columns.released, release.velocity, first_id, particles,
                         {release.solid_fraction, false});
        if (release.solid_fraction > 0) first_id += columns.released.size();
        if (release.solid_fraction < 1) {  // in the same places
            append_share(comm, columns.released, release.velocity, first_id, particles,
                         {1 - release.solid_fraction, true});
            first_id += columns.released.size();
        }
    }
    return particles;
}

}  // namespace talus
