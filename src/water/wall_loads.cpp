#include "src/water/wall_loads.hpp"

#include "comm/exact_sum.hpp"
#include "domain/water_fields.hpp"
#include "physics/water/wall_forces.hpp"

namespace talus {

std::vector<WallLoad> wall_loads(WaterSimulation& simulation) {
    const WaterSetup& setup = simulation.setup();
    ParticleSet& particles = simulation.access().particles;
    water::find_wall_forces(particles, simulation.decomposition().table(), setup.settings,
                            setup.records_force);
    std::vector<std::size_t> place(setup.records_force.size());  // of a body among those that are recorded
    std::vector<dem::Vector3<>> centres;
    for (std::size_t b = 0; b < place.size(); ++b) {
        place[b] = centres.size();
        if (!setup.records_force[b]) continue;
        const dem::WallPose pose = setup.walls[b]->motion.pose(simulation.time());
        centres.push_back(pose.centre + pose.shift);
    }
    constexpr std::size_t kinds = 6;
    std::vector<ExactSum> sums(kinds * centres.size());
    const std::uint8_t* body = particles.data(field::body);
    const auto vector_at = [&](const Field<double>& what, std::size_t i) {
        return dem::Vector3<>{particles.data(what, 0)[i], particles.data(what, 1)[i],
                              particles.dimension() > 2 ? particles.data(what, 2)[i] : 0.0};
    };
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!setup.records_force[body[i]]) continue;
        const std::size_t k = place[body[i]];
        const dem::Vector3<> force = vector_at(water_field::wall_force, i),
                             torque = cross(vector_at(field::position, i) - centres[k], force);
        std::size_t kind = kinds * k;
        for (const double value : {force.x, force.y, force.z, torque.x, torque.y, torque.z})
            sums[kind++].add(value);
    }
    ExactSum::all_reduce(simulation.comm(), sums);
    std::vector<WallLoad> loads;
    for (std::size_t k = 0; k < centres.size(); ++k) {
        const auto value = [&](std::size_t kind) { return sums[kinds * k + kind].value(); };
        loads.push_back({{value(0), value(1), value(2)}, {value(3), value(4), value(5)}});
    }
    return loads;
}

}  // namespace talus
