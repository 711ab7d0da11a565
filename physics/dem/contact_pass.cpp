#include "physics/dem/contact_pass.hpp"

#include <algorithm>

#include "domain/grain_fields.hpp"

namespace talus::dem {

double greatest_reach(const AnyLawTable& laws, double largest_radius) {
    const auto reach_of = [&](const auto& table) {
        double reach = 0;
        for (std::size_t a = 0; a < table.pairs.materials(); ++a)
            for (std::size_t b = a; b < table.pairs.materials(); ++b)
                reach = std::max(reach, table.pairs(a, b).reach(largest_radius));
        return reach;
    };
    return std::visit(reach_of, laws);
}

std::vector<const FieldInfo*> history_fields(const AnyLawTable& laws) {
    const auto fields_of = []<class Table>(const Table&) {
        std::vector<const FieldInfo*> fields;
        if (Table::Law::slides) fields.push_back(&field::sliding);
        if (Table::Law::rolls) fields.push_back(&field::rolling);
        if (Table::Law::twists) fields.push_back(&field::twisting);
        if (Table::Law::sticks) fields.push_back(&field::adhering);
        return fields;
    };
    return std::visit(fields_of, laws);
}

Overload evaluate_pairs(const Evaluation& evaluation, const AnyLawTable& laws, Pairs which,
                        ContactList& list) {
    const auto loop = [&]<class Table>(const Table&) {
        return evaluate_family<decltype(Table::Law::elasticity), decltype(Table::Law::surface_force)>(
            evaluation, laws, which, list);
    };
    return std::visit(loop, laws);
}

}  // namespace talus::dem
