#include <cmath>

#include "physics/dem/contact_pass.hpp"

namespace talus::dem {

namespace {

/// Adds a vector in whole units; false if it is not within range.
bool add(const Vector3<>& vector, double units_per_force, std::int64_t* sum) {
    bool bearable = true;
    for (const double component : {vector.x, vector.y, vector.z}) {
        const double scaled = component * units_per_force;
        bearable = bearable && std::abs(scaled) < most_units;
        *sum++ += bearable ? static_cast<std::int64_t>(scaled) : 0;
    }
    return bearable;
}

}  // namespace

Overload evaluate_walls(const Evaluation& evaluation, const AnyLawTable& laws,
                        std::span<const PlaneWall> walls, ContactList& list) {
    Overload overload;
    list.touching_count = 0;
    const auto loop = [&](const auto& table) {
        using Law = typename std::decay_t<decltype(table)>::Law;
        for (std::uint32_t p = 0; p < list.size(); ++p) {
            const PlaneWall& wall = walls[list.second[p]];
            const PlacedGrain<double> g = placed_grain(evaluation.rows[list.first[p]]);
            const double overlap = g.grain.radius - wall.distance(g.position);
            const Law& law = table.pairs[list.law[p]];
            if (!(overlap > -law.reach(g.grain.radius))) continue;
            list.touching[list.touching_count++] = p;
            typename Law::History history{};
            double* const stored = list.history.data() + p * list.history_count;
            if (list.last_touch[p] + 1 == evaluation.now) std::copy_n(stored, history.size(), history.data());
            const ContactKinematics<double> k =
                wall_kinematics(wall.normal, overlap, g.grain, {}, {}, evaluation.time_step);
            const ContactLoad<double> load = law(k, history);
            std::copy_n(history.data(), history.size(), stored);
            list.last_touch[p] = evaluation.now;
            ForceSum& sum = evaluation.sums[list.first[p]];
            const Vector3<> torque =
                torque_about_centre(k.normal, contact_arm(g.grain.radius, overlap), load);
            const bool bearable = add(load.force, g.units_per_force, sum.force) &&
                                  add(torque, g.units_per_force / g.grain.radius, sum.torque);
            if (!bearable && !overload.found) overload = {true, list.first[p], list.second[p]};
        }
    };
    std::visit(loop, laws);
    return overload;
}

}  // namespace talus::dem
