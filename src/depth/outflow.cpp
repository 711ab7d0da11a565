#include "src/depth/outflow.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "comm/exact_sum.hpp"
#include "domain/depth_fields.hpp"

namespace talus {

Decomposition::Ledger Outflow::take(ParticleSet& particles, const Terrain& terrain, double time) {
    if (terrain.is_plane()) return {};
    const double* x = particles.data(field::position, 0);
    const double* y = particles.dimension() == 2 ? particles.data(field::position, 1) : nullptr;
    std::vector<std::uint32_t> kept;
    std::array<std::uint64_t, 2> gone{};  // number, sum of ids
    ExactSum volume;
    std::array<double, 4> place;  // greatest x and y, least with the sign changed
    place.fill(-std::numeric_limits<double>::infinity());
    std::string fault;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double y_i = y ? y[i] : 0;
        const Terrain::Place where = terrain.place(x[i], y_i);
        const bool is_somewhere =
            std::isfinite(x[i]) && std::isfinite(y_i);  // else it is found as not finite
        if (where != Terrain::Place::outside || !is_somewhere) {
            kept.push_back(static_cast<std::uint32_t>(i));
            if (where == Terrain::Place::hole && fault.empty())
                fault = fmt::format(
                    "time {} s: particle {} flows over a hole of the terrain at ({:.6g}, {:.6g}) m, {}", time,
                    particles.data(field::id)[i], x[i], y_i, terrain.cell_name(x[i], y_i));
            continue;
        }
        ++gone[0];
        gone[1] += particles.data(field::id)[i];
        volume.add(particles.data(field::volume)[i]);
        place = {std::max(place[0], x[i]), std::max(place[1], y_i), std::max(place[2], -x[i]),
                 std::max(place[3], -y_i)};
    }
    std::array<std::uint64_t, 3> sums{gone[0], gone[1], fault.empty() ? 0U : 1U};
    comm_.all_sum(std::span<std::uint64_t>(sums));
    if (sums[2] > 0) comm_.all_agree(1, fault);
    if (sums[0] == 0) return {};
    ExactSum::all_reduce(comm_, std::span<ExactSum>(&volume, 1));
    comm_.all_max(std::span<double>(place));
    if (gone[0] > 0) particles.reorder(kept);
    if (count_ == 0)
        note_ = fmt::format(
            "{} particles with {:.4g} m3 have left the terrain at time {:.4g} s, between ({:.6g}, {:.6g}) "
            "and "
            "({:.6g}, {:.6g}) m; they are counted in the columns outflow_ of diagnostics.csv",
            sums[0], volume.value(), time, -place[2], -place[3], place[0], place[1]);
    count_ += sums[0];
    volume_ += volume.value();
    return {{sums[0], sums[1]}};
}

std::string Outflow::take_note() { return std::exchange(note_, {}); }

void Outflow::save(std::map<std::string, double>& numbers) const {
    if (count_ == 0) return;
    numbers["outflow.count"] = static_cast<double>(count_);
    numbers["outflow.volume"] = volume_;
}

void Outflow::restore(const std::map<std::string, double>& numbers) {
    const auto stored = [&](const char* name) {
        const auto found = numbers.find(name);
        return found == numbers.end() ? 0.0 : found->second;
    };
    count_ = static_cast<std::uint64_t>(stored("outflow.count"));
    volume_ = stored("outflow.volume");
}

}  // namespace talus
