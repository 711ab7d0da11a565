#include "src/setup/grain_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};

/// Share of a normal distribution below x.
double normal_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

bool are_in_order(const std::vector<double>& radii) {
    return !radii.empty() && radii.front() > 0 && std::is_sorted(radii.begin(), radii.end());
}

void read_table(const Section& table, GrainSizes& sizes) {
    const std::vector<double> radii = table.numbers("radii", "m", 0),
                              shares = table.numbers("volume_shares", "1", 0);
    const bool in_order = are_in_order(radii);
    if (!in_order) table.error("radii", "must be radii above 0 in order");
    if (shares.size() != radii.size() ||
        std::any_of(shares.begin(), shares.end(), [](double share) { return !(share > 0); }))
        return table.error("volume_shares", "must be numbers above 0, as many as radii");
    if (!in_order) return;
    double sum = 0;
    for (std::size_t k = 0; k < radii.size(); ++k) {
        sum += shares[k] / (radii[k] * radii[k] * radii[k]);
        sizes.up_to.push_back(sum);
    }
    for (double& share : sizes.up_to) share /= sum;
    sizes.radii = radii;
    sizes.least = radii.front();
    sizes.greatest = radii.back();
}

void read_bounds(const Section& table, GrainSizes& sizes) {
    const std::vector<double> radii = table.numbers("radii", "m", 2);
    if (radii.size() != 2 || !are_in_order(radii))
        return table.error("radii", "must be two radii above 0 in order");
    sizes.least = radii[0];
    sizes.greatest = radii[1];
}

}  // namespace

double GrainSizes::radius(const RandomStream& random, std::uint64_t id, std::uint32_t counter) const {
    const double share = random.uniform(id, counter);
    switch (kind) {
        case Kind::uniform:
            return least + (greatest - least) * share;
        case Kind::volume_uniform: {
            // Of grains as many as 1/r^3: the share below r is (1/a^2 - 1/r^2) / (1/a^2 - 1/b^2).
            const double ratio = least / greatest;
            return std::min(least / std::sqrt(1 - share * (1 - ratio * ratio)), greatest);
        }
        case Kind::lognormal:
            for (std::uint32_t attempt = 0;; attempt += 2) {
                const double length = std::sqrt(-2 * std::log(random.uniform(id, counter + attempt)));
                const double angle = 2 * std::numbers::pi * random.uniform(id, counter + attempt + 1);
                const double drawn = median * std::exp(deviation * length * std::cos(angle));
                if (least <= drawn && drawn <= greatest) return drawn;
            }
        case Kind::table:
            break;
    }
    const auto at = std::lower_bound(up_to.begin(), up_to.end() - 1, share);
    return radii[static_cast<std::size_t>(at - up_to.begin())];
}

GrainSizes read_grain_sizes(const Section& table) {
    GrainSizes sizes;
    if (!table.has("radii")) {
        sizes.least = sizes.greatest = table.number("radius", "m", {}, positive);
        return sizes;
    }
    const std::string kind =
        table.choice("distribution", {"uniform", "volume_uniform", "lognormal", "table"}, "uniform");
    if (kind == "table") {
        sizes.kind = GrainSizes::Kind::table;
        read_table(table, sizes);
        return sizes;
    }
    read_bounds(table, sizes);
    if (kind == "volume_uniform") sizes.kind = GrainSizes::Kind::volume_uniform;
    if (kind == "lognormal") {
        sizes.kind = GrainSizes::Kind::lognormal;
        sizes.median = table.number("median", "m", {}, positive);
        sizes.deviation = table.number("deviation", "1", {}, positive);
        constexpr double least_share = 0.01;  // what is beyond the bounds is drawn in vain
        const auto below = [&](double r) {
            return normal_below(std::log(r / sizes.median) / sizes.deviation);
        };
        if (sizes.least > 0 && sizes.median > 0 && below(sizes.greatest) - below(sizes.least) < least_share)
            table.error("radii", "less than a hundredth of this lognormal distribution lies between them");
    }
    return sizes;
}

}  // namespace talus
