#include <fmt/format.h>

#include <cmath>
#include <string>

#include "domain/grain_fields.hpp"
#include "src/grain_simulation.hpp"

namespace talus {

void GrainSimulation::refuse_not_finite() {
    if (!fault_.empty()) return;
    fault_ = fmt::format("step {}, time {} s: ", step_, time_);
    show_accelerations();
    if (const NotFinite found = find_not_finite(grains_); found.field) {
        fault_ += fmt::format("{} of grain {} is not finite", found.field->name, found.id);
        return;
    }
    std::size_t fastest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto v = std::as_const(grains_).own(field::velocity, axis);
        for (std::size_t i = 0; i < v.size(); ++i)
            if (!std::isfinite(v[i] * v[i])) fastest = i;
    }
    fault_ += fmt::format("grain {} moves too fast to follow", grains_.data(field::id)[fastest]);
}

void GrainSimulation::refuse_bond(const dem::BondFault& found) {
    if (found.kind == dem::BondFault::none || !fault_.empty()) return;
    fault_ = fmt::format("step {}, time {} s: the bond between grains {} and {} ", step_, time_, found.first,
                         found.second);
    fault_ +=
        found.kind == dem::BondFault::overload
            ? "bears a force that is not finite, or that strains it by more than 1; a smaller time step?"
            : fmt::format(
                  "is longer than {} of its length at rest, which ranks cannot follow; a lower "
                  "strength, so that it breaks before?",
                  dem::most_stretched);
}

void GrainSimulation::refuse_overload(const dem::Overload& overload, bool at_wall) {
    if (!overload.found || !fault_.empty()) return;
    const std::uint64_t* id = grains_.data(field::copied_id);
    const double* row = rows_[overload.first];
    const std::string place = fmt::format("({:.6g}, {:.6g}, {:.6g}) m", row[0], row[1], row[2]);
    const std::string when = fmt::format("step {}, time {} s: ", step_, time_);
    if (overload.behind) {
        fault_ = when + fmt::format("grain {} at {} has left through wall '{}'", id[overload.first], place,
                                    setup_.walls[overload.second].name);
        return;
    }
    fault_ = when + fmt::format(
                        "the force between grain {} at {} and {} is not finite, or beyond that of a grain "
                        "pressed flat; a smaller time step, or grains that do not overlap at the start?",
                        id[overload.first], place,
                        at_wall ? fmt::format("wall '{}'", setup_.walls[overload.second].name)
                                : fmt::format("grain {}", id[overload.second]));
}

}  // namespace talus
