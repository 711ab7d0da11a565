#include "src/setup/depth_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/depth_fields.hpp"
#include "src/setup/friction_reader.hpp"
#include "src/setup/run_reader.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};

/// A plane: its elevation at the origin and where it falls to.
std::shared_ptr<const Terrain> read_plane(const Section& table, int dimension) {
    const double elevation = table.number("elevation", "m", 0.0);
    const double dip = table.number("dip", "rad", 0.0, not_negative);
    if (dip >= std::numbers::pi / 2) {
        table.error("dip", fmt::format("is {:.4g} degrees; allowed: below 90", dip * 180 / std::numbers::pi));
        return std::make_shared<Terrain>(0.0, std::array<double, 2>{});
    }
    const double azimuth = dimension == 2 ? table.number("dip_direction", "rad", 0.0) : 0;
    const double steepness = std::tan(dip);
    return std::make_shared<Terrain>(
        elevation, std::array<double, 2>{-steepness * std::cos(azimuth),
                                         azimuth == 0 ? 0 : -steepness * std::sin(azimuth)});
}

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
                                .passive = 2 * (1 + std::sqrt(root2)) / cos2 - 1};
}

depth::Settings read_settings(const Section& table, int dimension, const DepthSetup& setup) {
    depth::Settings settings;
    const bool fitted = table.choice("form", {"cartesian", "bed_fitted"}, "cartesian") == "bed_fitted";
    settings.form = fitted ? depth::Form::bed_fitted : depth::Form::cartesian;
    const bool balances = !fitted && !setup.terrain->is_plane();
    settings.gradient = table.choice("gradient", {"conservative", "balanced"},
                                     balances ? "balanced" : "conservative") == "balanced"
                            ? depth::Gradient::balanced
                            : depth::Gradient::conservative;
    settings.gravity = table.number("gravity", "m s-2", 9.81, positive);
    settings.density = table.number("density", "kg m-3", 1000.0, positive);
    settings.eta = table.number("eta", "1", dimension == 1 ? 1.6 : 1.3, {1, 4});
    settings.viscosity = table.number("viscosity", "1", 1.0, not_negative);
    settings.courant = table.number("courant", "1", 0.4, {0, 1, true});
    settings.entrainment = table.number("entrainment", "m-1", 0.0, not_negative);
    if (fitted) settings.curvature = table.flag("curvature", true);
    settings.earth_pressure = read_earth_pressure(table, friction_coefficient(setup.friction));
    if (settings.gradient == depth::Gradient::balanced) {
        if (fitted)
            table.error("gradient",
                        "a surface that is level needs form = \"cartesian\"; allowed: conservative");
        if (settings.earth_pressure)
            table.error("internal_friction_angle", "needs gradient = \"conservative\"");
    }
    return settings;
}

void read_depth(const Section& table, bool may_be_parabolic, Release& release) {
    if (table.has("depth") && table.has("level")) table.error("level", "give depth or level, not both");
    if (table.has("level")) {
        release.level = table.number("level", "m");
        return;
    }
    release.depth = table.number("depth", "m", {}, positive);
    release.parabolic = table.choice("profile", {"even", "parabolic"}, "even") == "parabolic";
    if (release.parabolic && !may_be_parabolic)
        table.error("profile", "needs a sphere or an ellipsoid; allowed: even");
}

Release read_release(const Section& table, const BodyContext& context, double first_spacing) {
    Release release;
    release.name = table.text("name", table.path());
    release.shape = read_shape(table, 1, context);
    const bool round = std::holds_alternative<SphereShape>(release.shape) ||
                       std::holds_alternative<EllipsoidShape>(release.shape);
    read_depth(table, round, release);
    release.velocity = origin_default(table, "velocity", "m s-1", context.dimension);
    if (table.has("particles") && table.has("spacing"))
        table.error("spacing", "give particles or spacing, not both");
    if (table.has("particles")) {
        const auto count = static_cast<double>(table.integer("particles", {}, 1, 2000000000));
        release.spacing = std::pow(volume(release.shape, context.dimension) / count, 1.0 / context.dimension);
    } else {
        release.spacing =
            table.number("spacing", "m",
                         first_spacing > 0 ? std::optional<double>(first_spacing) : std::nullopt, positive);
    }
    return release;
}

void read_releases(const Communicator& comm, const Scene& scene, DepthScene& setup) {
    const Section root = scene.root();
    const Box& box = setup.simulation.box;
    const std::vector<Section> tables = root.sections("release");
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
        setup.releases.push_back(
            read_release(table, context, setup.releases.empty() ? 0 : setup.releases.front().spacing));
    }
    if (scene.faulty()) return;
    for (std::size_t k = 0; k < tables.size(); ++k) {
        std::optional<Point> unknown;
        const std::size_t count = columns_of(setup.releases[k], *setup.simulation.terrain,
                                             setup.simulation.settings, box.dimension, unknown)
                                      .size();
        if (unknown)
            tables[k].error("shape",
                            fmt::format("reaches beyond the terrain, at ({:.6g}, {:.6g}) m {}", (*unknown)[0],
                                        (*unknown)[1],
                                        setup.simulation.terrain->cell_name((*unknown)[0], (*unknown)[1])));
        else if (count == 0)
            tables[k].error(tables[k].has("level") ? "level" : "spacing",
                            "has no particles: none of its lattice is wet; make it finer or higher");
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
    simulation.terrain = read_plane(root.section("terrain"), dimension);
    simulation.friction = read_basal_friction(root.section("friction"));
    simulation.settings = read_settings(root.section("depth"), dimension, simulation);
    read_releases(comm, scene, setup);
    double widest = 0;
    for (const Release& release : setup.releases) widest = std::max(widest, release.spacing);
    const double most_growth = dimension == 1 ? 50 : 5;  // of the smoothing length, where columns fly apart
    simulation.settings.largest_smoothing_length = root.section("depth").number(
        "largest_smoothing_length", "m", most_growth * simulation.settings.eta * widest, not_negative);
    setup.output = read_output(root);
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
    const auto ranks = static_cast<std::uint64_t>(comm.size()),
               rank = static_cast<std::uint64_t>(comm.rank());
    std::uint64_t first_id = 0;
    for (const Release& release : scene.releases) {
        std::optional<Point> unknown;
        const std::vector<ReleasedColumn> columns =
            columns_of(release, *scene.simulation.terrain, scene.simulation.settings,
                       scene.simulation.box.dimension, unknown);
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
                particles.data(field::velocity, a)[i] = release.velocity[static_cast<std::size_t>(a)];
            }
            particles.data(field::volume)[i] = column.volume;
            particles.data(field::depth)[i] = column.depth;
            particles.data(field::smoothing_length)[i] = column.smoothing_length;
            if (particles.has(field::depth_correction))
                particles.data(field::depth_correction)[i] = column.correction;
        }
        first_id += count;
    }
    return particles;
}

}  // namespace talus
