#include "physics/dem/pressed_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "physics/dem/laws/time_step.hpp"

namespace talus::dem {

namespace {
template <class Table>
constexpr bool is_hertzian = requires(decltype(Table::Law::elasticity) elasticity) {
    elasticity.effective_modulus;
};
}  // namespace

PressedContact pressed_contact(const AnyLawTable& laws, std::size_t first, std::size_t second, double overlap,
                               double effective_radius, double effective_mass) {
    ContactKinematics<double> k{};
    k.overlap = overlap;
    k.normal = {1, 0, 0};
    k.effective_radius = effective_radius;
    k.effective_mass = effective_mass;
    return std::visit(
        [&]<class Table>(const Table& table) -> PressedContact {
            // dF/dd over F/d of Hertz's force, d^(3/2).
            constexpr double tangent = is_hertzian<Table> ? 1.5 : 1.0;
            const auto& law = table.pairs(first, second);
            const ElasticResponse<double> response = law.elasticity(k, 0.0);
            const double sticks = law.friction.coefficient > 0 ? 1 : 0;
            return {tangent * response.normal_stiffness,
                    law.elasticity.normal_damping * std::sqrt(response.normal_stiffness * effective_mass),
                    sticks * response.tangential_stiffness, sticks * response.tangential_damping};
        },
        laws);
}

std::optional<double> effective_modulus(const AnyLawTable& laws, std::size_t first, std::size_t second) {
    return std::visit(
        [&]<class Table>(const Table& table) -> std::optional<double> {
            if constexpr (is_hertzian<Table>)
                return table.pairs(first, second).elasticity.effective_modulus;
            else
                return std::nullopt;
        },
        laws);
}

void PressedGrain::add(const PressedContact& contact, double arm_share) {
    const double share2 = arm_share * arm_share;
    sum_.stiffness += contact.stiffness;
    sum_.damping += contact.damping;
    sum_.tangential_stiffness += share2 * contact.tangential_stiffness;
    sum_.tangential_damping += share2 * contact.tangential_damping;
}

double PressedGrain::stable_step(double mass) const {
    return std::min(
        stable_step_of_mode(sum_.stiffness / mass, sum_.damping / mass),
        stable_step_of_mode(5 * sum_.tangential_stiffness / mass, 2.5 * sum_.tangential_damping / mass));
}

HardestPressed find_hardest_pressed(const GrainRows& rows, std::size_t own, const AnyLawTable& laws,
                                    const ContactList& pairs, std::span<const Wall> walls,
                                    std::span<const WallTouch> touches) {
    constexpr double pressed = 1e-3;
    struct Side {
        std::uint32_t grain;
        double overlap;
        PressedContact contact;
    };
    std::vector<Side> sides;
    pairs.for_each_contact([&](std::size_t p, std::size_t) {
        const std::uint32_t i = pairs.first[p], j = pairs.second[p];
        const PlacedGrain<double> a = placed_grain(rows[i]), b = placed_grain(rows[j]);
        const double ra = a.grain.radius, rb = b.grain.radius;
        const double overlap = ra + rb - norm(a.position - b.position);
        if (!(overlap > pressed * std::min(ra, rb))) return;
        const double ma = a.grain.mass, mb = b.grain.mass;
        const PressedContact contact = pressed_contact(laws, rows.material(i), rows.material(j), overlap,
                                                       ra * rb / (ra + rb), ma * mb / (ma + mb));
        for (const std::uint32_t grain : {i, j})
            if (grain < own) sides.push_back({grain, overlap, contact});
    });
    for (const WallTouch& touch : touches) {
        const Grain<double> grain = placed_grain(rows[touch.grain]).grain;
        if (touch.overlap > pressed * grain.radius)
            sides.push_back({touch.grain, touch.overlap,
                             pressed_contact(laws, rows.material(touch.grain), walls[touch.wall].material,
                                             touch.overlap, grain.radius, grain.mass)});
    }
    std::ranges::sort(sides, {}, &Side::grain);
    HardestPressed hardest;
    for (std::size_t begin = 0; begin < sides.size();) {
        const std::uint32_t i = sides[begin].grain;
        const Grain<double> grain = placed_grain(rows[i]).grain;
        PressedGrain all;
        double deepest = 0;
        for (; begin < sides.size() && sides[begin].grain == i; ++begin) {
            all.add(sides[begin].contact, contact_arm(grain.radius, sides[begin].overlap) / grain.radius);
            deepest = std::max(deepest, sides[begin].overlap);
        }
        if (const double step = all.stable_step(grain.mass); step < hardest.stable_step)
            hardest = {step, deepest / grain.radius};
    }
    return hardest;
}

}  // namespace talus::dem
