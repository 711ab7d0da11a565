#include "src/setup/soil_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "domain/random.hpp"
#include "domain/soil_fields.hpp"
#include "src/setup/names.hpp"
#include "src/setup/run_reader.hpp"
#include "src/setup/shape_reader.hpp"
#include "src/setup/soil_reader.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};
constexpr double most_cells = 2e9;

/// Axis of gravity, or none if it is not along one.
std::optional<std::size_t> vertical_axis(const SoilSetup& setup) {
    std::optional<std::size_t> axis;
    for (std::size_t a = 0; a < 3; ++a) {
        if (setup.gravity[a] == 0) continue;
        if (axis) return {};
        axis = a;
    }
    return axis;
}

void read_initial_stress(const Section& root, SoilScene& scene) {
    const Section table = root.section("initial_stress");
    if (!table.exists()) return;
    scene.initial_stress.pressure = table.number("pressure", "Pa", 0.0);
    if (!table.has("surface")) return;
    scene.initial_stress.surface = table.number("surface", "m");
    scene.initial_stress.lateral_ratio = table.number("lateral_ratio", "1", {}, not_negative);
    if (!vertical_axis(scene.simulation))
        table.error("surface", "needs soil.gravity along one axis, whose weight it is of");
    if (has_layers(scene.simulation))
        table.error("surface",
                    "allowed for bodies of one density only; start layers without, and let gravity grow");
}

/// Boxes must fit the lattice: what is cut away would be missing from loads and areas.
void refuse_misfit(const Section& table, const BoxShape& box, const SoilLattice& lattice) {
    constexpr double tolerance = 1e-6;
    for (std::size_t a = 0; a < static_cast<std::size_t>(lattice.dimension); ++a)
        for (const auto& [key, corner] : {std::pair{"lower", box.lower}, {"upper", box.upper}}) {
            const double cells = (corner[a] - lattice.origin[a]) / lattice.spacing;
            if (std::abs(cells - std::round(cells)) > tolerance * std::max(1.0, std::abs(cells)))
                table.error(key, fmt::format("{} m along {} is not a whole number of spacings of {} m from "
                                             "the soil's lower end at {} m",
                                             corner[a], "xyz"[a], lattice.spacing, lattice.origin[a]));
        }
}

void read_lattice(const Scene& scene, const std::vector<Section>& tables, SoilScene& soil) {
    SoilLattice& lattice = soil.lattice;
    lattice.dimension = soil.simulation.dimension;
    lattice.spacing = soil.simulation.spacing;
    const auto axes = static_cast<std::size_t>(lattice.dimension);
    Point upper{};
    for (std::size_t b = 0; b < soil.bodies.size(); ++b) {
        const BoxShape around = bounds(soil.bodies[b].shape, lattice.dimension);
        for (std::size_t a = 0; a < axes; ++a) {
            lattice.origin[a] = b == 0 ? around.lower[a] : std::min(lattice.origin[a], around.lower[a]);
            upper[a] = b == 0 ? around.upper[a] : std::max(upper[a], around.upper[a]);
        }
    }
    for (std::size_t b = 0; b < soil.bodies.size(); ++b)
        if (const auto* box = std::get_if<BoxShape>(&soil.bodies[b].shape))
            refuse_misfit(tables[b], *box, lattice);
    double total = 1;
    for (std::size_t a = 0; a < axes; ++a) {
        const double count =
            std::max(1.0, std::ceil((upper[a] - lattice.origin[a]) / lattice.spacing - 1e-6));
        total *= count;
        lattice.cells[a] = static_cast<long>(std::min(count, most_cells));
    }
    if (total > most_cells)
        scene.root().section("soil").error("spacing", fmt::format("makes {:.3g} elements", total));
    if (scene.faulty()) return;
    std::vector<std::uint64_t> elements(soil.bodies.size());
    for (long z = 0; z < lattice.cells[2]; ++z)
        for (long y = 0; y < lattice.cells[1]; ++y)
            for (long x = 0; x < lattice.cells[0]; ++x) {
                Point centre = lattice.corner({x, y, z});
                for (std::size_t a = 0; a < axes; ++a) centre[a] += 0.5 * lattice.spacing;
                const auto found = std::find_if(
                    soil.bodies.begin(), soil.bodies.end(),
                    [&](const SoilBody& body) { return contains(body.shape, centre, lattice.dimension); });
                const bool is_soil = found != soil.bodies.end();
                if (is_soil) ++elements[static_cast<std::size_t>(found - soil.bodies.begin())];
                lattice.body_of_cell.push_back(
                    is_soil ? static_cast<std::uint8_t>(found - soil.bodies.begin()) : no_body);
            }
    for (std::size_t b = 0; b < soil.bodies.size(); ++b)
        if (elements[b] == 0)
            tables[b].error("shape", fmt::format("body '{}' has no elements {} m wide; a smaller "
                                                 "soil.spacing, or another body covers it",
                                                 soil.bodies[b].name, lattice.spacing));
}

void read_soil_bodies(const Communicator& comm, const Scene& scene, SoilScene& soil) {
    const Section root = scene.root();
    const std::vector<Section> tables = root.sections("body");
    if (tables.empty()) root.error("body", "a scene needs at least one [[body]]");
    if (tables.size() >= no_body) root.error("body", "more than 254 bodies");
    const BodyContext context{.comm = comm,
                              .scene = scene,
                              .dimension = soil.simulation.dimension,
                              .domain = {},
                              .boundaries = {},
                              .first_body = nullptr,
                              .in_impact = false,
                              .gravitational_constant = 0,
                              .seed = soil.seed};
    for (const Section& table : tables) {
        SoilBody body;
        body.name = table.text("name", table.path());
        refuse_same_name(table, soil.bodies, body.name);
        soil.simulation.materials.push_back(read_soil_material(root, table, soil.simulation));
        body.shape = read_shape(table, soil.simulation.materials.back().density, context);
        body.velocity = origin_default(table, "velocity", "m/s", context.dimension);
        soil.bodies.push_back(body);
    }
    if (!scene.faulty()) read_lattice(scene, tables, soil);
}

bool holds_somewhere(const SoilScene& scene, std::size_t condition);
std::string find_free_tight_face(const SoilScene& scene);

/// Where water cannot leave through a face that moves as it will, the step of the pore pressure is stable for
/// shorter steps and nearest partners only (tools/soil_tight_faces).
void read_courant(const Section& table, SoilScene& soil, bool is_faulty) {
    constexpr double most = 0.7, widest = 0.55;
    SoilSetup& setup = soil.simulation;
    const bool asks = setup.saturated && setup.dimension > 1 && !is_faulty;
    const std::string tight = asks ? find_free_tight_face(soil) : "";
    const bool shorter = setup.moves || !tight.empty();
    setup.courant = table.number("courant", "1", shorter ? 0.6 : 0.9, {0, 1, true});
    setup.free_tight_faces = !tight.empty();
    if (tight.empty()) return;
    const auto refuse = [&](const char* key, double value, double allowed) {
        if (value > allowed) table.error(key, fmt::format("{}; allowed there: up to {}", tight, allowed));
    };
    refuse("courant", setup.courant, most);
    refuse("smoothing", soil.smoothing, widest);
}

}  // namespace

bool is_soil_scene(const Scene& scene) { return scene.root().section("soil").exists(); }

SoilScene read_soil_scene(const Communicator& comm, const Scene& scene) {
    const Section root = scene.root(), table = root.section("soil");
    SoilScene soil;
    soil.title = root.text("title", scene.file().stem().string());
    soil.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0));
    SoilSetup& setup = soil.simulation;
    setup.dimension = static_cast<int>(root.integer("dimension", 3, 1, 3));
    setup.spacing = table.number("spacing", "m", {}, positive);
    setup.moves = table.choice("deformation", {"small", "large"}, "small") == "large";
    setup.damping = table.number("damping", "s-1", 0.0, not_negative);
    setup.hourglass = table.number("hourglass", "1",
                                   setup.dimension == 1 ? 0
                                   : setup.moves        ? 0.2
                                                        : 0.05,
                                   {0, 0.5});
    setup.gravity = origin_default(table, "gravity", "m/s2", setup.dimension);
    setup.gravity_factor = read_time_factor(table, "gravity_change");
    setup.strength_factor = read_strength_factor(table, "strength_change");
    soil.smoothing = setup.moves ? table.number("smoothing", "1", soil::default_moving_smoothing, {0.8, 1.5})
                                 : table.number("smoothing", "1", soil::default_smoothing, {0.4, 1});
    soil.jitter = table.number("jitter", "1", 0.0, {0, 0.25});
    setup.saturated = table.flag("saturated", false);
    if (setup.saturated) {
        setup.pressure_smoothing = table.number("pressure_smoothing", "1", 0.0, not_negative);
        setup.pressure_tolerance = table.number("pressure_tolerance", "1", 1e-10, {1e-15, 1e-2});
        if (soil.jitter > 0) table.error("jitter", "a saturated soil needs an even lattice");
        if (setup.moves) table.error("deformation", "saturated soil is of small strain only");
    }
    read_soil_bodies(comm, scene, soil);
    bool flows = false;
    for (const soil::Material& material : setup.materials) flows |= material.flows();
    const double smoothing = setup.dimension == 1                        ? 0
                             : soil.jitter > 0 || (setup.moves && flows) ? 0.1
                             : flows                                     ? 0.02
                                                                         : 0;
    setup.stress_smoothing = table.number("stress_smoothing", "1", smoothing, {0, 0.5});
    if (setup.dimension == 1) {
        const bool bar = table.choice("across", {"confined", "free"}, "confined") == "free";
        for (soil::Material& material : setup.materials) material.elasticity.uniaxial_stress = bar;
    }
    read_soil_boundaries(root, soil);
    read_initial_stress(root, soil);
    soil.output = read_output(root);
    const Section run = root.section("run");
    setup.partition = read_partition(run);
    read_rebalance_interval(run);
    const std::vector<Section> boundaries = root.sections("boundary");
    for (std::size_t c = 0; c < boundaries.size() && !scene.faulty(); ++c)
        if (!holds_somewhere(soil, c)) boundaries[c].error("", "holds at no node of the soil");
    read_courant(table, soil, scene.faulty());
    scene.finish();
    return soil;
}

ParticleSet empty_soil(const SoilSetup& setup) {
    ParticleSet particles("soil", setup.dimension);
    add_fields(particles, setup);
    return particles;
}

namespace {

/// Calls visit(node) for every node of the lattice, in its order.
template <class Visit>
void for_each_node(const SoilLattice& lattice, Visit&& visit) {
    const auto last = [&](int axis) {
        return axis < lattice.dimension ? lattice.cells[static_cast<std::size_t>(axis)] : 0;
    };
    for (long z = 0; z <= last(2); ++z)
        for (long y = 0; y <= last(1); ++y)
            for (long x = 0; x <= last(0); ++x)
                if (const SoilLattice::Node node = lattice.node_at({x, y, z}); node.body != no_body)
                    visit(node);
}

bool holds(const SoilScene& scene, std::size_t condition, const SoilLattice::Node& node) {
    const soil::BoundaryCondition& given = scene.simulation.conditions[condition];
    const double beyond = soil::reach_beyond(given.kind) * scene.lattice.spacing;
    const Point at = scene.lattice.corner(node.index);
    for (std::size_t a = 0; a < static_cast<std::size_t>(scene.lattice.dimension); ++a)
        if (at[a] < given.lower[a] - beyond || at[a] > given.upper[a] + beyond) return false;
    const soil::Face face = given.face;
    return face < 0 || (node.faces >> face & 1) != 0;
}

bool holds_somewhere(const SoilScene& scene, std::size_t condition) {
    bool found = false;
    for_each_node(scene.lattice,
                  [&](const SoilLattice::Node& node) { found = found || holds(scene, condition, node); });
    return found;
}

/// Says where the soil's surface is neither drained nor held, if anywhere.
std::string find_free_tight_face(const SoilScene& scene) {
    const std::vector<soil::BoundaryCondition>& conditions = scene.simulation.conditions;
    std::string found;
    for_each_node(scene.lattice, [&](const SoilLattice::Node& node) {
        for (soil::Face face = 0; face < 2 * scene.lattice.dimension && found.empty(); ++face) {
            if (!(node.faces >> face & 1)) continue;
            bool good = false;
            for (std::size_t c = 0; c < conditions.size() && !good; ++c)
                good = (conditions[c].kind == soil::BoundaryCondition::Kind::pore_pressure ||
                        conditions[c].held[static_cast<std::size_t>(soil::axis_of(face))]) &&
                       holds(scene, c, node);
            if (good) continue;
            const Point at = scene.lattice.corner(node.index);
            found = fmt::format("the face {} at ({}) m has neither a velocity along {} nor a pore pressure",
                                face_names[static_cast<std::size_t>(face)],
                                fmt::join(at.begin(), at.begin() + scene.lattice.dimension, ", "),
                                "xyz"[soil::axis_of(face)]);
        }
    });
    return found;
}

/// Place of a node, moved at random within the soil.
Point place_of(const SoilScene& scene, const SoilLattice::Node& node) {
    Point at = scene.lattice.corner(node.index);
    if (scene.jitter == 0 || !node.is_inside(scene.lattice.dimension)) return at;
    const RandomStream random{scene.seed, RandomPurpose::positions, 0};
    const auto& cells = scene.lattice.cells;
    const auto key = static_cast<std::uint64_t>(
        (node.index[2] * (cells[1] + 1) + node.index[1]) * (cells[0] + 1) + node.index[0]);
    for (std::uint32_t a = 0; a < static_cast<std::uint32_t>(scene.lattice.dimension); ++a)
        at[a] += scene.jitter * scene.lattice.spacing * (2 * random.uniform(key, a) - 1);
    return at;
}

/// Middle of the corners of a cell.
Point middle_of(const SoilScene& scene, const SoilLattice::Index& cell) {
    Point sum{};
    const unsigned corners = 1u << scene.lattice.dimension;
    for (unsigned k = 0; k < corners; ++k) {
        SoilLattice::Index index = cell;
        for (unsigned a = 0; a < static_cast<unsigned>(scene.lattice.dimension); ++a) index[a] += k >> a & 1;
        sum = plus(sum, place_of(scene, scene.lattice.node_at(index)));
    }
    return times(1.0 / corners, sum);
}

soil::Tensor stress_at_start(const SoilScene& scene, const Point& at, double density) {
    const InitialStress& given = scene.initial_stress;
    soil::Tensor stress{-given.pressure, -given.pressure, -given.pressure, 0, 0, 0};
    if (!given.surface) return stress;
    const std::size_t vertical = *vertical_axis(scene.simulation);
    const double g = scene.simulation.gravity[vertical];
    const double weight = density * g * (*given.surface - at[vertical]);  // negative: compression
    for (std::size_t a = 0; a < 3; ++a) stress[a] += weight * (a == vertical ? 1 : given.lateral_ratio);
    return stress;
}

/// What nodes and elements have in common.
void put(const SoilScene& scene, ParticleSet& particles, std::uint64_t id, const Point& at,
         std::uint8_t body) {
    const std::size_t i = particles.size();
    particles.resize(i + 1);
    particles.data(field::id)[i] = id;
    particles.data(field::body)[i] = body;
    particles.data(field::smoothing_length)[i] = scene.smoothing * scene.lattice.spacing;
    const bool knows_volume = particles.has(soil_field::volume);
    if (knows_volume)
        particles.data(soil_field::volume)[i] = std::pow(scene.lattice.spacing, particles.dimension());
    for (int a = 0; a < particles.dimension(); ++a) {
        particles.data(field::position, a)[i] = at[static_cast<std::size_t>(a)];
        particles.data(soil_field::velocity, a)[i] = scene.bodies[body].velocity[static_cast<std::size_t>(a)];
    }
    soil::put_stress(particles, i, stress_at_start(scene, at, scene.simulation.materials[body].density));
}

void put_node(const SoilScene& scene, ParticleSet& particles, std::uint64_t id,
              const SoilLattice::Node& node) {
    put(scene, particles, id, place_of(scene, node), node.body);
    const std::size_t i = particles.size() - 1;
    const double share = std::pow(scene.lattice.spacing / 2, scene.lattice.dimension);
    for (const std::uint8_t body : node.around)
        if (body != no_body)
            particles.data(field::mass)[i] += share * scene.simulation.materials[body].density;
    if (particles.has(soil_field::volume)) particles.data(soil_field::volume)[i] = share * node.cell_count();
    particles.data(soil_field::faces)[i] = node.faces;
    for (int a = 0; a < particles.dimension() && particles.has(soil_field::surface); ++a)
        for (unsigned k = 0; k < 1u << scene.lattice.dimension; ++k)
            if (node.around[k] != no_body)
                particles.data(soil_field::surface, a)[i] +=
                    (k >> a & 1 ? -1 : 1) * std::pow(scene.lattice.spacing / 2, scene.lattice.dimension - 1);
    for (std::size_t c = 0; c < scene.simulation.conditions.size(); ++c)
        if (holds(scene, c, node)) particles.data(soil_field::conditions)[i] |= std::uint32_t{1} << c;
    if (!particles.has(soil_field::preconsolidation)) return;
    if (const auto* clay = std::get_if<soil::CamClay>(&scene.simulation.materials[node.body].surface))
        particles.data(soil_field::preconsolidation)[i] = clay->preconsolidation;
}

}  // namespace

ParticleSet make_soil(const Communicator& comm, const SoilScene& scene) {
    ParticleSet particles = empty_soil(scene.simulation);
    const auto ranks = static_cast<std::uint64_t>(comm.size()),
               rank = static_cast<std::uint64_t>(comm.rank());
    std::uint64_t id = 0;
    for_each_node(scene.lattice, [&](const SoilLattice::Node& node) {
        if (id % ranks == rank) put_node(scene, particles, id, node);
        ++id;
    });
    const SoilLattice& lattice = scene.lattice;
    for (long z = 0; z < lattice.cells[2]; ++z)
        for (long y = 0; y < lattice.cells[1]; ++y)
            for (long x = 0; x < lattice.cells[0]; ++x) {
                const std::uint8_t body = lattice.body_at({x, y, z});
                if (body == no_body) continue;
                if (id % ranks == rank) {
                    put(scene, particles, id, middle_of(scene, {x, y, z}), body);
                    const std::size_t i = particles.size() - 1;
                    particles.data(soil_field::grid)[i] = soil::element_grid;
                    particles.data(field::mass)[i] = scene.simulation.materials[body].density *
                                                     std::pow(lattice.spacing, lattice.dimension);
                }
                ++id;
            }
    return particles;
}

}  // namespace talus
