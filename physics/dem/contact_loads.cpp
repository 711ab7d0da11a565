#include "physics/dem/contact_loads.hpp"

#include <variant>

namespace talus::dem {

std::vector<LoadedContact> loaded_pairs(const GrainRows& rows, const AnyLawTable& laws,
                                        const ContactList& list) {
    std::vector<LoadedContact> contacts;
    contacts.reserve(list.contact_count());
    const auto loop = [&](const auto& table) {
        using Law = typename std::decay_t<decltype(table)>::Law;
        list.for_each_contact([&](std::size_t p, std::size_t place) {
            const std::uint32_t i = list.first[p], j = list.second[p];
            const PlacedGrain<double> a = placed_grain(rows[i]), b = placed_grain(rows[j]);
            const Vector3<> separation = a.position - b.position;
            const ContactKinematics<double> k =
                grain_kinematics(separation, norm(separation), a.grain, b.grain, 0.0);
            typename Law::History history{};
            for (std::size_t c = 0; c < history.size(); ++c) history[c] = list.history[c][place];
            const double arm = contact_arm(a.grain.radius, k.overlap);
            const auto& law = table.pairs(rows.material(i), rows.material(j));
            contacts.push_back({i, j, 0, false, k.overlap, arm, contact_arm(b.grain.radius, k.overlap),
                                k.normal, a.position - arm * k.normal, law(k, history)});
        });
    };
    std::visit(loop, laws);
    return contacts;
}

}  // namespace talus::dem
