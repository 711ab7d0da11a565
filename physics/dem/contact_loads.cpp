#include "physics/dem/contact_loads.hpp"

#include <algorithm>

namespace talus::dem {

std::vector<LoadedContact> loaded_pairs(const GrainRows& rows, const AnyLawTable& laws,
                                        const ContactList& list) {
    std::vector<LoadedContact> contacts;
    contacts.reserve(list.touching_count);
    const auto loop = [&](const auto& table) {
        using Law = typename std::decay_t<decltype(table)>::Law;
        for (std::size_t t = 0; t < list.touching_count; ++t) {
            const std::uint32_t p = list.touching[t];
            const PlacedGrain<double> a = placed_grain(rows[list.first[p]]),
                                      b = placed_grain(rows[list.second[p]]);
            const Vector3<> separation = a.position - b.position;
            const ContactKinematics<double> k =
                grain_kinematics(separation, norm(separation), a.grain, b.grain, 0.0);
            typename Law::History history{};
            std::copy_n(list.history.begin() + static_cast<std::ptrdiff_t>(p * list.history_count),
                        history.size(), history.begin());
            const double arm = contact_arm(a.grain.radius, k.overlap);
            contacts.push_back({list.first[p], list.second[p], 0, false, k.overlap, arm,
                                contact_arm(b.grain.radius, k.overlap), k.normal, a.position - arm * k.normal,
                                table.pairs[list.law[p]](k, history)});
        }
    };
    std::visit(loop, laws);
    return contacts;
}

}  // namespace talus::dem
