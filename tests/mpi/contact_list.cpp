#include "physics/dem/contact_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "domain/grain_fields.hpp"
#include "tests/support/grain_scene.hpp"

/// The pairs of every rank are those that all pairs of grains, tried in turn, give.
namespace talus::test {
namespace {

constexpr double margin = 0.02;

struct Case {
    double ratio;  ///< of the largest radius, 0.5 m, over the smallest
    int grains;
    std::array<Boundary, 3> boundary;
    int cells_across;  ///< cells of the grid within reach
};

const Box& box_of(const Case& c) {
    static Box box;
    box = {3, {-1, 0.5, 100}, {3.25, 5, 104}, c.boundary};
    return box;
}

std::vector<GrainState> cloud(const Case& c) {
    std::mt19937_64 random(static_cast<std::uint64_t>(c.ratio * 100 + c.grains));
    std::uniform_real_distribution<double> uniform(0, 1);
    const Box& box = box_of(c);
    std::vector<GrainState> grains;
    for (int k = 0; k < c.grains; ++k) {
        GrainState grain{{},   {},
                         {},   0.5 * std::pow(c.ratio, -uniform(random)),
                         1000, static_cast<std::uint8_t>(k % 3 == 0 ? 1 : 0)};
        // A few large ones, as a mixture by volume has them.
        if (k > 8 && k < c.grains - 8 && c.ratio > 2) grain.radius = std::min(grain.radius, 2.2 / c.ratio);
        for (const int axis : {0, 1, 2}) {
            double& x = axis == 0 ? grain.position.x : axis == 1 ? grain.position.y : grain.position.z;
            x = box.lower[static_cast<std::size_t>(axis)] + box.length(axis) * uniform(random);
        }
        grains.push_back(grain);
    }
    return grains;
}

using Ids = std::pair<std::uint64_t, std::uint64_t>;

double gap(const GrainState& a, const GrainState& b, const Box& box) {
    const dem::Vector3<> r = a.position - b.position;
    double square = 0;
    int axis = 0;
    for (double x : {r.x, r.y, r.z}) {
        if (box.boundary[static_cast<std::size_t>(axis)] == Boundary::periodic)
            x -= box.length(axis) * std::round(x / box.length(axis));
        square += x * x;
        ++axis;
    }
    return std::sqrt(square) - a.radius - b.radius;
}

void compare(const Communicator& comm, const Case& c) {
    const std::vector<GrainState> grains = cloud(c);
    const Box& box = box_of(c);
    ParticleSet set = grain_set(comm, grains);
    const CellGrid grid(box, 2 * 0.5 + margin, c.cells_across);
    Decomposition decomposition(comm, PartitionMethod::bisection);
    decomposition.expect(set);
    decomposition.divide(set, grid);
    decomposition.arrange(set, grid);
    const auto ids = std::as_const(set).own(field::id);
    std::copy(ids.begin(), ids.end(), set.data(field::copied_id));
    decomposition.halo().begin(set, {&field::position, &field::radius, &field::body, &field::copied_id});
    decomposition.halo().finish();

    dem::ContactList list(3);
    const std::vector<std::uint8_t> material{0, 0}, held{0, 1};
    dem::list_pairs(set, decomposition.table(), {margin, 0.5, material, held, 1}, list);
    // Of each own grain the partners, each once, whichever image of them is listed.
    std::vector<Ids> found;
    const std::uint64_t* id = set.data(field::copied_id);
    for (std::size_t p = 0; p < list.size(); ++p) {
        const std::uint32_t i = list.first[p], j = list.second[p];
        EXPECT_EQ(p < list.own_count(), i < set.size() && j < set.size());
        EXPECT_LT(id[i], id[j]);
        if (i < set.size()) found.emplace_back(id[i], id[j]);
        if (j < set.size()) found.emplace_back(id[j], id[i]);
    }
    std::sort(found.begin(), found.end());

    const std::set<std::uint64_t> mine(id, id + set.size());
    std::vector<Ids> wanted;
    for (const std::uint64_t i : mine)
        for (std::uint64_t j = 0; j < grains.size(); ++j)
            if (i != j && !(grains[i].body && grains[j].body) && gap(grains[i], grains[j], box) < margin)
                wanted.emplace_back(i, j);
    EXPECT_EQ(found, wanted) << "ratio " << c.ratio << ", " << c.grains << " grains";
    std::uint64_t pairs = wanted.size();
    comm.all_sum(std::span<std::uint64_t>(&pairs, 1));
    EXPECT_GT(pairs, grains.size() / 2) << "the cloud tests nothing";
}

constexpr std::array<Boundary, 3> closed{Boundary::periodic, Boundary::periodic, Boundary::periodic},
    open{Boundary::open, Boundary::open, Boundary::open},
    slab{Boundary::periodic, Boundary::open, Boundary::periodic};

TEST(ContactList, IsThatOfAllPairs) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const auto& boundary : {open, slab, closed})
        for (const int across : {1, 3})
            for (const double ratio : {1.0, 1.9, 2.0, 7.0, 20.0})
                compare(comm, {ratio, ratio < 3 ? 250 : 1500, boundary, across});
}

}  // namespace
}  // namespace talus::test
