#include "comm/halo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "comm/decomposition.hpp"
#include "domain/partners.hpp"
#include "tests/support/clouds.hpp"

namespace talus::test {
namespace {

constexpr PartitionMethod methods[] = {PartitionMethod::cheapest, PartitionMethod::metis,
                                       PartitionMethod::bisection, PartitionMethod::slabs,
                                       PartitionMethod::scrambled};

/// The particles of a cloud spread over ranks, copies refreshed.
struct Spread {
    Spread(const Communicator& comm, const Cloud& cloud, PartitionMethod method)
        : grid(cloud.box, cloud.radius, cells_per_radius),
          particles(make_particles(cloud, share(comm, cloud))),
          decomposition(comm, method) {
        decomposition.expect(particles);
        decomposition.divide(particles, grid);
        decomposition.arrange(particles, grid);
        fill_values(particles, Role::work);
        Halo& halo = decomposition.halo();
        halo.begin(particles, {&field::body, &field::position, &field::mass});
        halo.finish();
        halo.begin(particles, {&field::pressure, &field::velocity_gradient, &field::predicted_velocity,
                               &field::predicted_stress});
        halo.finish();
    }
    static std::vector<std::size_t> share(const Communicator& comm, const Cloud& cloud) {
        std::vector<std::size_t> mine;
        for (std::size_t k = 0; k < cloud.points.size(); ++k)
            if (k * 31 % 17 % static_cast<std::size_t>(comm.size()) == static_cast<std::size_t>(comm.rank()))
                mine.push_back(k);
        return mine;
    }

    CellGrid grid;
    ParticleSet particles;
    Decomposition decomposition;
};

Point point_of(const ParticleSet& particles, std::size_t k) {
    Point point{static_cast<std::uint64_t>(particles.data(field::mass)[k]), {}};
    for (int axis = 0; axis < particles.dimension(); ++axis)
        point.position[static_cast<std::size_t>(axis)] = particles.data(field::position, axis)[k];
    return point;
}

/// Calls visit(i, partners) for every own particle.
template <int D, class Visit>
void for_each_particle(const Spread& spread, double radius, Visit&& visit) {
    std::array<const double*, D> position;
    for (int d = 0; d < D; ++d)
        position[static_cast<std::size_t>(d)] = spread.particles.data(field::position, d);
    const std::vector<double> radii(spread.particles.size_with_halo(), radius);
    Partners<D> partners(position, radii.data(), 1);
    for (const Cells which : {Cells::interior, Cells::boundary})
        spread.decomposition.table().for_each_own(
            which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
                partners.enter(cell, runs);
                for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                    partners.find(i, 1);
                    visit(i, partners.index());
                }
            });
}
template <class Visit>
void for_each_particle(const Spread& spread, double radius, Visit&& visit) {
    switch (spread.particles.dimension()) {
        case 1:
            return for_each_particle<1>(spread, radius, visit);
        case 2:
            return for_each_particle<2>(spread, radius, visit);
        default:
            return for_each_particle<3>(spread, radius, visit);
    }
}

/// Sign of a component under mirroring, written down anew.
double expected_sign(const FieldInfo& field, int c, int dimension, const std::array<bool, 3>& flip) {
    const auto s = [&](int axis) { return flip[static_cast<std::size_t>(axis)] ? -1.0 : 1.0; };
    if (field.shape == Shape::vector) return s(c);
    if (field.shape == Shape::tensor) return s(c / dimension) * s(c % dimension);
    if (field.shape == Shape::symmetric_tensor && c >= dimension)
        return dimension == 2 ? s(0) * s(1) : c == 3 ? s(0) * s(1) : c == 4 ? s(0) * s(2) : s(1) * s(2);
    return 1;
}

template <class T>
void expect_values(const ParticleSet& particles, const Field<T>& field, std::uint32_t k,
                   const Sighting& sighting) {
    for (int c = 0; c < component_count(field.shape, particles.dimension()); ++c)
        ASSERT_EQ(
            static_cast<double>(particles.data(field, c)[k]),
            expected_sign(field, c, particles.dimension(), sighting.flip) * value_of(field, c, sighting.id))
            << field.name << " component " << c << " of a copy of particle " << sighting.id;
}

std::vector<Point> all_gather_points(const Communicator& comm, const ParticleSet& particles) {
    std::vector<Point> mine;
    for (std::size_t i = 0; i < particles.size(); ++i) mine.push_back(point_of(particles, i));
    return comm.all_gather(std::span<const Point>(mine));
}

void expect_partners_are_those_of_brute_force(const Communicator& comm, const Cloud& cloud,
                                              const Spread& spread) {
    const std::vector<Point> points = all_gather_points(comm, spread.particles);
    ASSERT_EQ(points.size(), cloud.points.size());
    std::size_t visited = 0;
    for_each_particle(spread, cloud.radius, [&](std::uint32_t i, std::span<const std::uint32_t> partners) {
        ++visited;
        const auto expected = brute_force(cloud, points, point_of(spread.particles, i));
        std::vector<std::uint32_t> sorted(partners.begin(), partners.end());
        std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
            const Point p = point_of(spread.particles, a), q = point_of(spread.particles, b);
            return p.id != q.id ? p.id < q.id : p.position < q.position;
        });
        ASSERT_EQ(sorted.size(), expected.size())
            << "partners of particle " << point_of(spread.particles, i).id;
        for (std::size_t k = 0; k < sorted.size(); ++k) {
            const Point found = point_of(spread.particles, sorted[k]);
            ASSERT_EQ(found.id, expected[k].id);
            ASSERT_EQ(found.position, expected[k].position);
            expect_values(spread.particles, field::body, sorted[k], expected[k]);
            expect_values(spread.particles, field::pressure, sorted[k], expected[k]);
            expect_values(spread.particles, field::predicted_velocity, sorted[k], expected[k]);
            expect_values(spread.particles, field::predicted_stress, sorted[k], expected[k]);
            expect_values(spread.particles, field::velocity_gradient, sorted[k], expected[k]);
        }
    });
    EXPECT_EQ(visited, spread.particles.size()) << "interior and boundary cells are not all";
}

using Order = std::vector<std::pair<std::uint64_t, std::array<double, 3>>>;

std::map<std::uint64_t, Order> partner_orders(const Spread& spread, double radius) {
    std::map<std::uint64_t, Order> orders;
    for_each_particle(spread, radius, [&](std::uint32_t i, std::span<const std::uint32_t> partners) {
        Order& order = orders[spread.particles.data(field::id)[i]];
        for (const std::uint32_t k : partners) {
            const Point point = point_of(spread.particles, k);
            order.emplace_back(point.id, point.position);
        }
    });
    return orders;
}

TEST(Halo, PartnersAndTheirFieldsAreThoseOfBruteForce) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const Cloud& cloud : all_clouds())
        for (const PartitionMethod method : methods) {
            if (comm.size() == 1 && method != PartitionMethod::metis) continue;
            SCOPED_TRACE(cloud.name + ", method " + std::to_string(static_cast<int>(method)));
            const Spread spread(comm, cloud, method);
            expect_partners_are_those_of_brute_force(comm, cloud, spread);
        }
}

TEST(Halo, OrderOfPartnersIsThatOfOneRank) {
    const Communicator comm(MPI_COMM_WORLD), alone(MPI_COMM_SELF);
    for (const Cloud& cloud : all_clouds()) {
        const auto serial = partner_orders(Spread(alone, cloud, PartitionMethod::metis), cloud.radius);
        for (const PartitionMethod method : methods) {
            SCOPED_TRACE(cloud.name + ", method " + std::to_string(static_cast<int>(method)));
            for (const auto& [id, order] : partner_orders(Spread(comm, cloud, method), cloud.radius))
                ASSERT_EQ(order, serial.at(id)) << "particle " << id;
        }
    }
}

/// A cube of n^3 particles, as compact as a cloud can be.
Cloud cube(int n) {
    Cloud cloud{"cube", {}, 2.0, {}};
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) cloud.points.push_back({x + 0.5, y + 0.5, z + 0.5});
    return cloud;
}

TEST(HaloTraffic, OneMessageForEachNeighbourAndNoMore) {
    const Communicator comm(MPI_COMM_WORLD);
    for (const PartitionMethod method :
         {PartitionMethod::cheapest, PartitionMethod::metis, PartitionMethod::bisection}) {
        Spread spread(comm, cube(24), method);
        Halo& halo = spread.decomposition.halo();
        const std::uint64_t messages = halo.messages_sent(), bytes = halo.bytes_sent();
        halo.begin(spread.particles, {&field::pressure, &field::predicted_velocity, &field::mass});
        halo.finish();
        const std::uint64_t sent = halo.messages_sent() - messages;
        EXPECT_LE(sent, 26u);
        EXPECT_LE(sent, static_cast<std::uint64_t>(comm.size() - 1));
        // A rank's own share can be wanted by several neighbours, but not by all of many.
        EXPECT_LE(halo.bytes_sent() - bytes, 8 * 5 * 8 * std::max<std::size_t>(spread.particles.size(), 64));
        const std::uint64_t total = comm.all_sum(sent);
        EXPECT_LE(total, 18u * static_cast<unsigned>(comm.size()));
    }
}

}  // namespace
}  // namespace talus::test
