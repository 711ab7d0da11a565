#include "tests/support/grain_scene.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "domain/grain_fields.hpp"

namespace talus::test {

double mass_of(const GrainState& grain) {
    return 4.0 / 3.0 * std::numbers::pi * grain.radius * grain.radius * grain.radius * grain.density;
}

dem::AnyLawTable hertz_table(const std::vector<dem::GrainMaterial>& materials) {
    const dem::MaterialPairs pairs(materials);
    return dem::LawTable<dem::HertzMindlin>{dem::PairTable<dem::LawTable<dem::HertzMindlin>::Law>(
        materials.size(), [&](std::size_t a, std::size_t b) {
            const dem::PairProperties pair = pairs(a, b);
            return dem::LawTable<dem::HertzMindlin>::Law{
                dem::hertz_mindlin(pair, dem::EndOfContact::may_attract), {pair.friction}, {}, {}, {}};
        })};
}

dem::AnyLawTable linear_table(const dem::GrainMaterial& material, double stiffness) {
    const dem::MaterialPairs pairs({material});
    using Table = dem::LawTable<dem::LinearSpring>;
    return Table{dem::PairTable<Table::Law>(1, [&](std::size_t a, std::size_t b) {
        return Table::Law{dem::linear_spring(pairs(a, b), stiffness, 2.0 / 7, dem::EndOfContact::may_attract),
                          {material.friction},
                          {},
                          {},
                          {}};
    })};
}

GrainSetup grain_setup(const std::vector<dem::GrainMaterial>& materials, double radius, double time_step) {
    GrainSetup setup{.box = {},
                     .laws = hertz_table(materials),
                     .material = {},
                     .held = std::vector<std::uint8_t>(materials.size(), 0),
                     .walls = {},
                     .gravity = {},
                     .time_step = time_step,
                     .skin = 0.1 * radius};
    for (std::size_t m = 0; m < materials.size(); ++m) setup.material.push_back(static_cast<std::uint8_t>(m));
    return setup;
}

ParticleSet grain_set(const Communicator& comm, const std::vector<GrainState>& grains) {
    ParticleSet set("grains", 3);
    GrainSimulation::add_fields(set);
    std::vector<std::size_t> mine;
    for (std::size_t k = 0; k < grains.size(); ++k)
        if (k % static_cast<std::size_t>(comm.size()) == static_cast<std::size_t>(comm.rank()))
            mine.push_back(k);
    set.resize(mine.size());
    for (std::size_t i = 0; i < mine.size(); ++i) {
        const GrainState& grain = grains[mine[i]];
        set.data(field::id)[i] = mine[i];
        const auto put = [&](const Field<double>& field, const dem::Vector3<>& v) {
            set.data(field, 0)[i] = v.x;
            set.data(field, 1)[i] = v.y;
            set.data(field, 2)[i] = v.z;
        };
        put(field::position, grain.position);
        put(field::velocity, grain.velocity);
        put(field::angular_velocity, grain.angular_velocity);
        set.data(field::radius)[i] = grain.radius;
        set.data(field::mass)[i] = mass_of(grain);
        set.data(field::body)[i] = grain.body;
    }
    return set;
}

ParticleSet clump_set(const Communicator& comm, const GrainSetup& setup,
                      const std::vector<dem::ClumpState>& clumps) {
    ParticleSet set("grains", 3);
    GrainSimulation::add_fields(set, setup);
    const dem::ClumpBody& body = setup.clumps[0];
    const std::size_t spheres = body.shape->radii.size();
    for (std::size_t id = 0; id < clumps.size() * spheres; ++id) {
        if (id % static_cast<std::size_t>(comm.size()) != static_cast<std::size_t>(comm.rank())) continue;
        const std::size_t i = set.size();
        set.resize(i + 1);
        set.data(field::id)[i] = id;
        set.data(field::body)[i] = 0;
        dem::place_new_sphere(set, i, body, id % spheres, clumps[id / spheres]);
    }
    return set;
}

namespace {

std::size_t place_of(const ParticleSet& set, std::uint64_t id) {
    const auto ids = set.own(field::id);
    const auto found = std::find(ids.begin(), ids.end(), id);
    if (found == ids.end()) throw std::logic_error("no such grain on this rank");
    return static_cast<std::size_t>(found - ids.begin());
}

}  // namespace

GrainState state_of(const GrainSimulation& simulation, std::uint64_t id) {
    const ParticleSet& set = simulation.grains();
    const std::size_t i = place_of(set, id);
    const auto take = [&](const Field<double>& field) {
        return dem::Vector3<>{set.data(field, 0)[i], set.data(field, 1)[i], set.data(field, 2)[i]};
    };
    return {take(field::position),
            take(field::velocity),
            take(field::angular_velocity),
            set.data(field::radius)[i],
            0,
            set.data(field::body)[i]};
}

dem::ClumpState clump_of(const GrainSimulation& simulation, std::uint64_t id) {
    return dem::clump_state(simulation.grains(), place_of(simulation.grains(), id));
}

}  // namespace talus::test
