#include "tests/support/gravity_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "domain/random.hpp"

namespace talus::test {

namespace {

constexpr RandomStream random_numbers{.seed = 5};

/// A place in the unit ball, evenly.
std::array<double, 3> in_ball(std::uint64_t id) {
    for (std::uint32_t attempt = 0;; ++attempt) {
        std::array<double, 3> x;
        double r2 = 0;
        for (std::uint32_t a = 0; a < 3; ++a) {
            x[a] = 2 * random_numbers.uniform(id, 8 * attempt + a) - 1;
            r2 += x[a] * x[a];
        }
        if (r2 < 1) return x;
    }
}

std::array<double, 3> place(const std::string& kind, std::uint64_t id) {
    std::array<double, 3> x = in_ball(id);
    if (kind == "pair") x[0] += id % 2 == 0 ? -2 : 2;
    if (kind == "clumps" && id % 2 == 0) {
        const std::array<double, 3> centre = in_ball(1000000 + id / 2 % 5);
        for (std::size_t a = 0; a < 3; ++a) x[a] = 0.8 * centre[a] + 0.1 * x[a];
    }
    if (kind == "ejecta" && id % 50 == 0) {
        const double distance = std::pow(1000.0, random_numbers.uniform(id, 1000));
        for (double& component : x) component *= distance;
    }
    return x;
}

}  // namespace

GravityCloud::GravityCloud(const Communicator& comm_, const std::string& kind, std::size_t count,
                           PartitionMethod method)
    : comm(comm_), particles("cloud", 3), decomposition(comm, method) {
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::mass, &field::smoothing_length, &field::gravity_acceleration, &field::gravity_potential})
        particles.add(*info);
    particles.resize(comm.is_root() ? count : 0);
    const double spacing = std::cbrt(4.0 / 3 * M_PI / static_cast<double>(count));
    for (std::size_t i = 0; i < particles.size(); ++i) {
        particles.data(field::id)[i] = i;
        const auto x = place(kind, i);
        for (int a = 0; a < 3; ++a) particles.data(field::position, a)[i] = x[static_cast<std::size_t>(a)];
        particles.data(field::mass)[i] =
            (1 + 0.5 * random_numbers.uniform(i, 2000)) / static_cast<double>(count);
        particles.data(field::smoothing_length)[i] = spacing * (1 + 0.1 * random_numbers.uniform(i, 2001));
    }
    Box box;
    grid = std::make_unique<CellGrid>(box, 1.1 * spacing * sph.force_support(), 1);
    decomposition.expect(particles);
    decomposition.divide(particles, *grid);
    decomposition.arrange(particles, *grid);
}

gravity::Counts GravityCloud::evaluate(const gravity::Settings& settings) {
    gravity::Settings chosen = settings;
    chosen.constant = 1;
    gravity::Gravity gravity(comm, chosen, sph);
    std::vector<double> work(decomposition.own_cells().size());
    gravity.evaluate(particles, *grid, decomposition, work);
    return gravity.counts();
}

GravityCloud::Forces GravityCloud::forces() const {
    struct Row {
        std::uint64_t id;
        double mass, potential;
        std::array<double, 3> acceleration;
    };
    std::vector<Row> mine;
    for (std::size_t i = 0; i < particles.size(); ++i)
        mine.push_back({particles.data(field::id)[i],
                        particles.data(field::mass)[i],
                        particles.data(field::gravity_potential)[i],
                        {particles.data(field::gravity_acceleration, 0)[i],
                         particles.data(field::gravity_acceleration, 1)[i],
                         particles.data(field::gravity_acceleration, 2)[i]}});
    std::vector<Row> all = comm.all_gather(std::span<const Row>(mine));
    std::sort(all.begin(), all.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
    Forces found;
    for (const Row& row : all) {
        found.mass.push_back(row.mass);
        found.potential.push_back(row.potential);
        found.acceleration.push_back(row.acceleration);
    }
    return found;
}

GravityError error_of(const GravityCloud::Forces& found, const GravityCloud::Forces& exact) {
    double sum = 0, greatest = 0, size = 0, of_potential = 0, potential = 0, weight = 0;
    std::array<double, 3> total{};
    for (std::size_t i = 0; i < exact.mass.size(); ++i) {
        double error2 = 0, size2 = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const double g = found.acceleration[i][a], g_exact = exact.acceleration[i][a];
            error2 += (g - g_exact) * (g - g_exact);
            size2 += g_exact * g_exact;
            total[a] += exact.mass[i] * g;
        }
        sum += error2;
        greatest = std::max(greatest, std::sqrt(error2));
        size += std::sqrt(size2);
        weight += exact.mass[i] * std::sqrt(size2);
        of_potential += std::pow(found.potential[i] - exact.potential[i], 2);
        potential += std::pow(exact.potential[i], 2);
    }
    const auto n = static_cast<double>(exact.mass.size());
    return {std::sqrt(sum / n) / (size / n), greatest / (size / n),
            std::hypot(total[0], total[1], total[2]) / weight, std::sqrt(of_potential / potential)};
}

}  // namespace talus::test
