#include "src/setup/clump_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace talus {

namespace {

std::shared_ptr<const dem::ClumpShape> read_shape_of_clump(const Scene& scene, const Section& body) {
    constexpr std::size_t most_spheres = 1000;
    const std::string name = body.text("clump");
    const Section table = scene.root().section("clumps").section(name);
    if (!table.exists()) {
        body.error("clump", fmt::format("there is no table [clumps.{}]", name));
        return nullptr;
    }
    const std::vector<double> radii = table.numbers("radii", "m", 0);
    const std::size_t count = radii.size();
    if (count == 0 || count > most_spheres || !std::ranges::all_of(radii, [](double r) { return r > 0; })) {
        table.error("radii", fmt::format("must be 1 to {} lengths above 0", most_spheres));
        return nullptr;
    }
    const std::vector<double> x = table.numbers("x", "m", count), y = table.numbers("y", "m", count),
                              z = table.numbers("z", "m", count);
    if (x.size() != count || y.size() != count || z.size() != count) return nullptr;  // said already
    std::vector<dem::Vector3<>> centres;
    for (std::size_t k = 0; k < count; ++k) centres.push_back({x[k], y[k], z[k]});
    return std::make_shared<const dem::ClumpShape>(dem::clump_shape(centres, radii));
}

}  // namespace

void read_clump(const Scene& scene, const Section& table, GrainBody& body) {
    body.clump = read_shape_of_clump(scene, table);
    body.turned = table.choice("orientation", {"random", "aligned"}, "random") == "random";
    if (!body.clump) return;
    const auto [least, greatest] = std::ranges::minmax(body.clump->radii);
    body.least_radius = least;
    body.greatest_radius = greatest;
}

}  // namespace talus
