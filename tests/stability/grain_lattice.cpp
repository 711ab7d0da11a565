#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "domain/random.hpp"
#include "physics/dem/laws/damping.hpp"
#include "physics/dem/laws/time_step.hpp"
#include "tests/support/grain_scene.hpp"
#include "tests/support/shared_cases.hpp"
#include "tests/support/stability_row.hpp"

/// The wall of the time step of packed grains, whose rotation takes part in the fastest modes.
namespace talus::test {
namespace {

constexpr double radius = 1, mass = 1, stiffness = 1, tangential_share = 2.0 / 7;
constexpr int cells = 3;  ///< of the face-centred lattice along each edge of the box

/// Half of the twelve directions in which a grain of a face-centred lattice has neighbours.
std::vector<Eigen::Vector3d> bonds() {
    std::vector<Eigen::Vector3d> directions;
    for (int a = 0; a < 3; ++a)
        for (const double sign : {1.0, -1.0}) {
            Eigen::Vector3d n = Eigen::Vector3d::Zero();
            n[a] = 1;
            n[(a + 1) % 3] = sign;
            directions.push_back(n.normalized());
        }
    return directions;
}

Eigen::Matrix3d cross(const Eigen::Vector3d& n) {
    Eigen::Matrix3d m;
    m << 0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0;
    return m;
}

/// Greatest omega^2 m/k of the waves that the periodic box bears: springs along each contact and across it,
/// arms of a radius, moment of inertia 2/5 m R^2. Across, a spring counts `across` times k_t.
double greatest_omega_squared(double across) {
    double greatest = 0;
    const double edge = std::sqrt(8.0) * radius;
    for (int p = 0; p < cells; ++p)
        for (int q = 0; q < cells; ++q)
            for (int r = 0; r < cells; ++r) {
                const Eigen::Vector3d k = 2 * std::numbers::pi / (cells * edge) * Eigen::Vector3d(p, q, r);
                Eigen::Matrix<std::complex<double>, 6, 6> matrix =
                    Eigen::Matrix<std::complex<double>, 6, 6>::Zero();
                for (const Eigen::Vector3d& n : bonds()) {
                    const std::complex<double> phase =
                        std::exp(std::complex<double>(0, 2 * radius * k.dot(n)));
                    Eigen::Matrix<std::complex<double>, 3, 6> strain;
                    // motion of the one contact point against the other; rotations by R theta / sqrt(2/5),
                    // for unit mass
                    strain << Eigen::Matrix3d::Identity() * (1.0 - phase),
                        -cross(n) / std::sqrt(0.4) * (1.0 + phase);
                    const Eigen::Matrix3d along = n * n.transpose();
                    const Eigen::Matrix3d springs =
                        stiffness *
                        (along + across * tangential_share * (Eigen::Matrix3d::Identity() - along));
                    matrix += strain.adjoint() * springs * strain;
                }
                const Eigen::SelfAdjointEigenSolver<decltype(matrix)> solver(matrix, Eigen::EigenvaluesOnly);
                greatest = std::max(greatest, solver.eigenvalues()[5] / mass);
            }
    return greatest;
}

/// How much faster grains of a pressed lattice move after 400 steps, random at first.
double growth(const Communicator& comm, double time_step, double restitution = 1) {
    constexpr double overlap = 1e-3 * radius, speed = 1e-9;
    static constexpr RandomStream noise{.seed = 5};
    const double edge = std::sqrt(2.0) * (2 * radius - overlap);
    std::vector<GrainState> grains;
    for (int a = 0; a < cells; ++a)
        for (int b = 0; b < cells; ++b)
            for (int c = 0; c < cells; ++c)
                for (int site = 0; site < 4; ++site) {
                    const double x = a + (site == 1 || site == 2 ? 0.5 : 0),
                                 y = b + (site == 1 || site == 3 ? 0.5 : 0),
                                 z = c + (site == 2 || site == 3 ? 0.5 : 0);
                    const std::uint64_t id = grains.size();
                    const auto random = [&](std::uint32_t k) {
                        return speed * (2 * noise.uniform(id, k) - 1);
                    };
                    grains.push_back({{edge * x, edge * y, edge * z},
                                      {random(0), random(1), random(2)},
                                      {random(3), random(4), random(5)},
                                      radius,
                                      mass / (4.0 / 3 * std::numbers::pi)});
                }
    const dem::GrainMaterial material{
        .name = "ball", .density = 1, .restitution = restitution, .friction = 1};
    GrainSetup setup = grain_setup({material}, radius, time_step);
    setup.laws = linear_table(material, stiffness);
    setup.box = {.dimension = 3, .upper = {cells * edge, cells * edge, cells * edge}};
    setup.box.boundary.fill(Boundary::periodic);
    GrainSimulation run(comm, setup, grain_set(comm, grains));
    run.start();
    const auto energy = [&] {
        const auto totals = run.totals();
        return totals.kinetic_energy + totals.rotational_energy;
    };
    const double before = energy();
    for (int step = 0; step < 400 && energy() < 1e8 * before; ++step) run.step();
    return std::sqrt(energy() / before);
}

/// Positions take the leapfrog, tangential springs advance by velocities predicted to the end of the step:
/// with z the factor of a step, (z - 1)^2 m + z k_n dt^2 + (3z - 1)/2 k_t dt^2 = 0. At the wall z = -1 this
/// is 4 m = (k_n + 2 k_t) dt^2: 2/omega of the lattice whose tangential springs are twice as stiff, and what
/// packed_lattice_limit() gives. With springs that advance exactly it would lie at 0.592 sqrt(m/k). Beyond it
/// grains gather speed however slow they were.
TEST(PackedGrains, TheWallOfTheTimeStepIsThatOfTheLatticeWithRotation) {
    EXPECT_NEAR(2 / std::sqrt(greatest_omega_squared(1)), 0.592, 0.002);
    const double wall = 2 / std::sqrt(greatest_omega_squared(2));
    EXPECT_NEAR(wall, dem::packed_lattice_limit(mass, stiffness, tangential_share * stiffness, 0), 1e-9);
    const std::vector<double> shares{0.5, 0.8, 0.95, 1.05, 1.2};
    const auto found = on_shared_ranks(shares.size(), [&](const Communicator& comm, std::size_t c) {
        return growth(comm, shares[c] * wall);
    });
    for (std::size_t c = 0; c < shares.size(); ++c) {
        if (shares[c] < 1)
            EXPECT_LT(found[c], 4) << shares[c];
        else
            EXPECT_GT(found[c], 1e3) << shares[c];
        if (is_root())
            print({"time step of grains", "face-centred lattice", "dt sqrt(k/m)", shares[c] * wall, wall,
                   "growth", found[c], found[c] < 4});
    }
}

/// Damped contacts, of restitution 0.5: velocities predicted to the end of the step are twice those of its
/// middle at the wall, and twelve contacts turn a grain, each against another that turns alike: dashpots take
/// more than half of the step, not a fifth as they would of one contact seen at the middle.
TEST(PackedGrains, DampingTakesMostOfTheStep) {
    constexpr double restitution = 0.5;
    const double ratio = 0.5 * dem::linear_damping(restitution, dem::EndOfContact::may_attract);
    const double wall = dem::packed_lattice_limit(mass, stiffness, tangential_share * stiffness, ratio);
    EXPECT_LT(wall, 0.45 * dem::packed_lattice_limit(mass, stiffness, tangential_share * stiffness, 0));
    const std::vector<double> shares{0.8, 0.95, 1.05, 1.2};
    const auto found = on_shared_ranks(shares.size(), [&](const Communicator& comm, std::size_t c) {
        return growth(comm, shares[c] * wall, restitution);
    });
    for (std::size_t c = 0; c < shares.size(); ++c) {
        if (shares[c] < 1)
            EXPECT_LT(found[c], 4) << shares[c];
        else
            EXPECT_GT(found[c], 1e3) << shares[c];
        if (is_root())
            print({"time step of grains", "the same, restitution 0.5", "dt sqrt(k/m)", shares[c] * wall, wall,
                   "growth", found[c], found[c] < 4});
    }
}

}  // namespace
}  // namespace talus::test
