#include "src/setup/grain_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/grain_fields.hpp"
#include "domain/random.hpp"
#include "src/setup/body_reader.hpp"
#include "src/setup/bond_reader.hpp"
#include "src/setup/clump_reader.hpp"
#include "src/setup/flow_reader.hpp"
#include "src/setup/grain_law_reader.hpp"
#include "src/setup/gravity_reader.hpp"
#include "src/setup/handed_grains.hpp"
#include "src/setup/material_reader.hpp"
#include "src/setup/names.hpp"
#include "src/setup/run_reader.hpp"
#include "src/setup/shape_reader.hpp"
#include "src/setup/wall_reader.hpp"

namespace talus {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range positive{0, infinity, true};

/// Rows "x,y,z,radius[,vx,vy,vz[,wx,wy,wz]]" in SI units; lines beginning with # are not read.
std::vector<std::array<double, 10>> read_list(const Communicator& comm, const Scene& scene,
                                              const Section& table) {
    const std::filesystem::path file = find_file(comm, scene, table.text("file"));
    const std::string text = read_shared_text(comm, file);
    std::vector<std::array<double, 10>> rows;
    std::size_t line = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        ++line;
        const char* at = text.data() + begin;
        if (begin < end && *at != '#') {
            std::array<double, 10> row{};
            std::size_t count = 0;
            for (bool more = true; more && count < row.size(); ++count) {
                char* after = nullptr;
                row[count] = std::strtod(at, &after);
                if (after == at || !std::isfinite(row[count])) break;
                more = *after == ',';
                at = after + 1;
            }
            if ((count != 4 && count != 7 && count != 10) || !(row[3] > 0)) {
                table.error("file", fmt::format("{}:{}: not a row x,y,z,radius with or without vx,vy,vz and "
                                                "wx,wy,wz, radius above 0",
                                                file.string(), line));
                return {};
            }
            rows.push_back(row);
        }
        begin = end + 1;
    }
    if (rows.empty()) table.error("file", fmt::format("{} holds no grains", file.string()));
    return rows;
}

void read_packing(const Section& table, const BodyContext& context, GrainBody& body) {
    double reached = 0;  // from a place [m]
    if (table.has("clump")) {
        read_clump(context.scene, table, body);
        if (!body.clump) return;
        reached = body.clump->bounding_radius;
    } else {
        body.sizes = read_grain_sizes(table);
        body.least_radius = body.sizes.least;
        body.greatest_radius = reached = body.sizes.greatest;
    }
    body.shape = read_shape(table, body.material.density, context);
    const bool cubic = table.choice("lattice", {"cubic", "close_packed"}, "cubic") == "cubic";
    body.cell = lattice_cell(cubic ? Lattice::cubic : Lattice::close_packed, 3);
    constexpr double room = 1.05;  // between neighbours, in diameters
    const double touching = 2 * room * reached * (cubic ? 1 : std::pow(2.0, -1.0 / 6));
    body.spacing = table.number("spacing", "m", touching, positive);
    body.jitter = table.number("jitter", "1", 0.0, {0, 1});
    body.velocity = origin_default(table, "velocity", "m/s", 3);
    body.angular_velocity = origin_default(table, "angular_velocity", "rad/s", 3);
}

/// Grains of particle sets, and what follows from them.
void take_file(const Communicator& comm, const std::filesystem::path& file, const Section& table,
               GrainBody& body) {
    body.handed = read_grains(comm, file, table);
    body.velocity = origin_default(table, "velocity", "m/s", 3);
    double least_density = infinity;
    body.least_radius = infinity;
    const double* mass = body.handed->data(field::mass);
    for (const double r : std::as_const(*body.handed).own(field::radius)) {
        body.least_radius = std::min(body.least_radius, r);
        body.greatest_radius = std::max(body.greatest_radius, r);
        least_density = std::min(least_density, *mass++ / (4.0 / 3.0 * std::numbers::pi * r * r * r));
    }
    body.least_radius = comm.all_min(body.least_radius);
    body.greatest_radius = comm.all_max(body.greatest_radius);
    body.least_density = comm.all_min(least_density);
}

std::vector<GrainBody> read_bodies(const BodyContext& context, GrainLawReader& laws,
                                   std::vector<std::uint8_t>& materials) {
    const Section root = context.scene.root();
    std::vector<GrainBody> bodies;
    const std::vector<Section> tables = root.sections("grains");
    if (tables.size() > 255) root.error("grains", "more than 255 bodies of grains");
    for (const Section& table : tables) {
        GrainBody body;
        body.name = table.text("name", table.path());
        refuse_same_name(table, bodies, body.name);
        materials.push_back(laws.material(table));
        body.material = laws.materials()[materials.back()];
        body.held = table.flag("held", false);
        body.spin = read_spin(table, 3);
        if (const auto file = file_of_grains(context.comm, context.scene, table)) {
            take_file(context.comm, *file, table, body);
        } else if (table.has("file")) {
            body.listed = read_list(context.comm, context.scene, table);
            body.least_radius = infinity;
            for (const auto& row : body.listed) {
                body.least_radius = std::min(body.least_radius, row[3]);
                body.greatest_radius = std::max(body.greatest_radius, row[3]);
            }
        } else {
            read_packing(table, context, body);
        }
        bodies.push_back(std::move(body));
    }
    return bodies;
}

/// For each body what its grains are spheres of; empty if all are spheres of their own.
std::vector<dem::ClumpBody> clumps_of(const std::vector<GrainBody>& bodies) {
    std::vector<dem::ClumpBody> clumps;
    if (std::ranges::none_of(bodies, [](const GrainBody& body) { return body.clump != nullptr; }))
        return clumps;
    std::uint64_t first_id = 0;
    for (const GrainBody& body : bodies) {
        clumps.push_back({body.clump, first_id, body.material.density});
        std::uint64_t places = body.listed.size();
        if (places == 0 && !body.inserted)
            for_each_point(body.shape, body.cell, body.spacing, 3, [&](const Point&) { ++places; });
        first_id += places * spheres_of(body);
    }
    return clumps;
}

/// What is not known of bonds, under self-gravity and in sheared boxes.
void refuse_together(const Section& root, bool bonds, bool self_gravity, bool sheared) {
    if (bonds && root.has("sink"))
        root.error("sink", "does not go with bonds: a deleted grain would leave its own");
    constexpr std::string_view without_bonds = "knows contacts only, and the scene has bonds";
    if (bonds && root.has("settle")) root.error("settle", without_bonds);
    if (bonds && root.section("output").flag("contacts", false))
        root.section("output").error("contacts", without_bonds);
    for (const Section& region : root.sections("region"))
        if (bonds && region.flag("stress", true))
            region.error("stress", fmt::format("{}; allowed: false", without_bonds));
    for (const char* table : {"sink", "source", "settle"}) {
        if (self_gravity && root.has(table)) root.error(table, "does not go with [gravity]");
        if (sheared && root.has(table)) root.error(table, "does not go with box.shear_rate");
    }
}

/// Grains that wrap around the box must not meet the same partner, or themselves, on both sides.
void check_box(const Section& table, const Box& box, double reach) {
    for (int axis = 0; axis < 3; ++axis) {
        const Boundary boundary = box.boundary[static_cast<std::size_t>(axis)];
        if (boundary == Boundary::reflecting)
            table.error("boundaries", "grains know open and periodic boundaries; a wall is a [[wall]]");
        if (boundary == Boundary::periodic && box.length(axis) < 2 * reach)
            table.error("upper",
                        fmt::format("the box is {} m long along {}, where it is periodic; allowed: at least "
                                    "{:.4g} m, two diameters of the largest grain with its skin",
                                    box.length(axis), "xyz"[axis], 2 * reach));
    }
}

/// What knows single spheres only.
void refuse_with_clumps(const Section& root, const std::vector<GrainBody>& bodies, bool self_gravity,
                        bool shrinks) {
    const auto any = [&](auto&& is) { return std::ranges::any_of(bodies, is); };
    if (!any([](const GrainBody& body) { return body.clump != nullptr; })) return;
    constexpr std::string_view why = "is for single spheres, and the scene has clumps";
    if (shrinks) root.section("dem").error("overlaps", why);
    const std::vector<Section> tables = root.sections("grains");
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (bodies[b].handed) tables[b].error("file", why);
        if (norm(bodies[b].spin) > 0) tables[b].error("spin", why);
        if (self_gravity && bodies[b].clump && std::ranges::min(bodies[b].clump->mass_shares) <= 0)
            tables[b].error("clump",
                            "has a sphere whose share of the mass would not be above 0 if all lay at the "
                            "centres of the spheres, as [gravity] takes it; allowed: spheres that are not "
                            "buried in others");
    }
}

/// The key shear_rate of [box].
void read_shear(const Section& table, const std::vector<GrainBody>& bodies, bool has_walls, Box& box) {
    if (!table.has("shear_rate")) return;
    box.shear_rate = table.number("shear_rate", "s-1");
    if (std::any_of(box.boundary.begin(), box.boundary.end(),
                    [](Boundary b) { return b != Boundary::periodic; }))
        table.error("shear_rate", "only a box that is periodic along all axes can be sheared");
    if (has_walls) table.error("shear_rate", "a sheared box holds no walls");
    for (const GrainBody& body : bodies)
        if (body.held)
            table.error("shear_rate",
                        fmt::format("a sheared box holds no grains that are held, as '{}'", body.name));
}

}  // namespace

bool is_grain_scene(const Scene& scene) { return scene.root().has("grains") || scene.root().has("source"); }

GrainScene read_grain_scene(const Communicator& comm, const Scene& scene) {
    GrainScene grains = read_grains_of(comm, scene);
    scene.finish();
    return grains;
}

GrainScene read_grains_of(const Communicator& comm, const Scene& scene) {
    const Section root = scene.root();
    const std::string title = root.text("title", scene.file().stem().string());
    const auto seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0));
    root.integer("dimension", 3, 3, 3);
    Box box = read_box(root.section("box"), 3);
    GrainLawReader laws(root);
    std::vector<std::uint8_t> material, held;
    const BodyContext context{.comm = comm,
                              .scene = scene,
                              .dimension = 3,
                              .domain = {box.lower, box.upper},
                              .boundaries = box.boundary,
                              .first_body = nullptr,
                              .in_impact = false,
                              .gravitational_constant = 0,
                              .seed = seed};
    std::vector<GrainBody> bodies = read_bodies(context, laws, material);
    GrainFlowPlan flow = read_flow(root, context, laws, bodies, material);
    double greatest = 0, widest = 0, usual = infinity;
    for (const GrainBody& body : bodies) {
        held.push_back(body.held ? 1 : 0);
        usual = std::min(usual, std::max(body.least_radius, body.sizes.median));
        greatest = std::max(greatest, body.greatest_radius);
        if (body.clump) widest = std::max(widest, body.clump->bounding_radius);
    }
    std::vector<std::string> warnings;
    std::vector<dem::Wall> walls = read_walls({comm, scene, box, greatest}, laws, warnings);
    read_shear(root.section("box"), bodies, !walls.empty(), box);
    const Section table = root.section("dem"), run = root.section("run");
    const double skin =
        table.number("skin", "m", 0 < usual && usual < infinity ? 0.3 * usual : 1.0, positive);
    const bool shrinks = table.choice("overlaps", {"refused", "shrink"}, "refused") == "shrink";
    const OutputPlan output = read_output(root);
    const PartitionMethod partition = read_partition(run);
    const int rebalance_interval = read_rebalance_interval(run);
    const std::vector<double> gravity = table.numbers("gravity", "m s-2", 3, std::vector<double>(3, 0.0));
    const std::optional<SelfGravity> self_gravity = read_grain_gravity(root, box);
    refuse_with_clumps(root, bodies, self_gravity.has_value(), shrinks);
    laws.read_pairs();
    const std::vector<dem::BondRule> bonds = read_bonds(root, bodies);
    if (box.shear_rate != 0 && !bonds.empty())
        root.section("box").error("shear_rate", "a sheared box holds no grains with bonds");
    const double reach = scene.faulty() ? 0
                                        : std::max(dem::greatest_reach(laws.table(), greatest),
                                                   dem::greatest_bond_reach(bonds, greatest));
    check_box(root.section("box"), box, 2 * std::max(greatest, widest) + reach + skin);
    const GrainTimeStep limit = laws.time_step(bodies);
    const double usual_step = std::min(limit.usual, usual_step_of_bonds(bonds, bodies));
    const double time_step = table.number("time_step", "s", usual_step, positive);
    if (!scene.faulty() && time_step > limit.greatest)
        table.error("time_step", fmt::format("is above the stable one; allowed: at most {:.4g} s, {}",
                                             limit.greatest, limit.reason));
    if (time_step > limit.packed)
        warnings.push_back(fmt::format(
            "dem.time_step = {:.4g} s: the densest packing of grains that turn bears {:.4g} s with the "
            "damping of "
            "their restitution, and shakes beyond; with half as many contacts it bears twice that",
            time_step, limit.packed));
    std::optional<GrainSettling> settling = read_settling(root, time_step, flow, walls);
    std::vector<WatchedRegion> regions = read_regions(root, context);
    const bool write_contacts = root.section("output").flag("contacts", false);
    refuse_together(root, !bonds.empty(), self_gravity.has_value(), box.shear_rate != 0);
    return {.title = title,
            .simulation = {.box = box,
                           .laws = laws.table(),
                           .material = material,
                           .held = held,
                           .clumps = clumps_of(bodies),
                           .walls = std::move(walls),
                           .bonds = bonds,
                           .gravity = {gravity[0], gravity[1], gravity[2]},
                           .self_gravity = self_gravity,
                           .time_step = time_step,
                           .skin = skin,
                           .partition = partition,
                           .rebalance_interval = rebalance_interval,
                           .flow = std::move(flow),
                           .settling = settling},
            .bodies = std::move(bodies),
            .greatest_time_step = limit.greatest,
            .time_step_limit = limit.reason,
            .output = output,
            .shrinks_overlapping = shrinks,
            .regions = std::move(regions),
            .write_contacts = write_contacts,
            .warnings = std::move(warnings),
            .seed = seed};
}

ParticleSet empty_grains(const GrainSetup& setup) {
    ParticleSet grains("grains", 3);
    GrainSimulation::add_fields(grains, setup);
    return grains;
}

namespace {

using Row = std::array<double, 10>;

/// The grains of a packing; `first_id` of the body's first.
std::vector<Row> packed(const GrainBody& body, const RandomStream& random, std::uint64_t first_id) {
    std::vector<Row> rows;
    for_each_point(body.shape, body.cell, body.spacing, 3, [&](const Point& point) {
        const std::uint64_t id = first_id + rows.size();
        Row row{};
        for (std::uint32_t a = 0; a < 3; ++a) {
            row[a] = point[a] + body.jitter * body.spacing * (2 * random.uniform(id, a) - 1);
            row[4 + a] = body.velocity[a];
            row[7 + a] = body.angular_velocity[a];
        }
        row[3] = body.sizes.radius(random, id, 3);
        rows.push_back(row);
    });
    return rows;
}

/// Makes grain i, whose id is `id`, a sphere of the clump at a row's place.
void make_sphere(ParticleSet& grains, std::size_t i, const dem::ClumpBody& clump, const GrainBody& body,
                 const Box& box, const Row& row, std::uint64_t id, const RandomStream& random) {
    const std::uint64_t sphere = clump.sphere(id);
    const double moves = body.held ? 0 : 1;
    dem::Quaternion orientation;
    if (body.turned)
        orientation = dem::evenly_spread_rotation(
            {random.uniform(id - sphere, 4), random.uniform(id - sphere, 5), random.uniform(id - sphere, 6)});
    const dem::Vector3<> velocity{row[4] + dem::shear_flow(box, row[1]), row[5], row[6]};
    dem::place_new_sphere(grains, i, clump, sphere,
                          dem::moving_clump(clump, {row[0], row[1], row[2]}, orientation, moves * velocity,
                                            moves * dem::Vector3<>{row[7], row[8], row[9]}));
}

/// First id behind those of the grains of a file.
std::uint64_t next_id(const Communicator& comm, std::uint64_t first_id, const ParticleSet& handed) {
    std::uint64_t behind = 0;
    for (const std::uint64_t id : handed.own(field::id)) behind = std::max(behind, id + 1);
    return first_id + comm.all_max(behind);
}

/// The motion that the scene gives a body besides that of its rows or its file.
void set_moving(const Communicator& comm, const GrainBody& body, std::size_t begin, ParticleSet& grains) {
    for (int axis = 0; axis < 3; ++axis)
        for (std::size_t i = begin; i < grains.size(); ++i) {
            double& velocity = grains.data(field::velocity, axis)[i];
            if (body.handed) velocity += body.velocity[static_cast<std::size_t>(axis)];
            if (body.held) velocity = grains.data(field::angular_velocity, axis)[i] = 0;
        }
    if (norm(body.spin) > 0 && !body.held) turn_grains(comm, body.spin, begin, grains);
}

}  // namespace

ParticleSet make_grains(const Communicator& comm, const GrainScene& scene) {
    ParticleSet grains = empty_grains(scene.simulation);
    const auto ranks = static_cast<std::uint64_t>(comm.size()),
               rank = static_cast<std::uint64_t>(comm.rank());
    std::uint64_t first_id = 0;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const GrainBody& body = scene.bodies[b];
        if (body.inserted) continue;
        const std::size_t first_place = grains.size();
        if (body.handed) {
            append_grains(*body.handed, first_id, static_cast<std::uint8_t>(b), grains);
            set_moving(comm, body, first_place, grains);
            first_id = next_id(comm, first_id, *body.handed);
            continue;
        }
        const RandomStream random{scene.seed, RandomPurpose::positions, static_cast<std::uint16_t>(b)};
        const std::vector<Row> rows = body.listed.empty() ? packed(body, random, first_id) : body.listed;
        const std::size_t spheres = spheres_of(body);
        for (std::size_t k = 0; k < rows.size() * spheres; ++k) {
            const std::uint64_t id = first_id + k;
            if (id % ranks != rank) continue;
            const std::size_t i = grains.size();
            grains.resize(i + 1);
            const Row& row = rows[k / spheres];
            grains.data(field::id)[i] = id;
            grains.data(field::body)[i] = static_cast<std::uint8_t>(b);
            if (body.clump) {
                make_sphere(grains, i, scene.simulation.clumps[b], body, scene.simulation.box, row, id,
                            random);
                continue;
            }
            for (int axis = 0; axis < 3; ++axis) {
                const auto a = static_cast<std::size_t>(axis);
                grains.data(field::position, axis)[i] = row[a];
                grains.data(field::velocity, axis)[i] = row[4 + a];
                grains.data(field::angular_velocity, axis)[i] = row[7 + a];
            }
            grains.data(field::velocity, 0)[i] += dem::shear_flow(scene.simulation.box, row[1]);
            grains.data(field::radius)[i] = row[3];
            grains.data(field::mass)[i] =
                4.0 / 3.0 * std::numbers::pi * row[3] * row[3] * row[3] * body.material.density;
        }
        first_id += rows.size() * spheres;
        if (!body.clump) set_moving(comm, body, first_place, grains);
    }
    return grains;
}

}  // namespace talus
