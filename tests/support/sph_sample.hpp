#pragma once
#include <cmath>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/random.hpp"
#include "physics/sph/passes.hpp"

namespace talus::test {

struct SampleChoice {
    int dimension = 3;
    int side = 10;  ///< particles along each axis
    bool strength = true;
    bool variable_h = false;
    bool bodies = false;
    bool quintic = false;
    bool gaps = false;  ///< lumps left out at random: cells with nothing on one side or another
    Boundary boundary = Boundary::open;
};

/// A square or cubic lattice of rock, jittered, with waves of pressure, velocity and stress of both signs
/// through it, arranged for pair loops on the ranks of MPI_COMM_WORLD.
class SphSample {
  public:
    explicit SphSample(const SampleChoice& choice, int cells_per_radius = 1)
        : comm(MPI_COMM_WORLD),
          particles("rock", choice.dimension),
          decomposition(comm, PartitionMethod::slabs) {
        settings.variable_smoothing_length = choice.variable_h;
        settings.uniform_smoothing_length = !choice.variable_h;
        settings.several_bodies = choice.bodies;
        if (choice.quintic) settings.stretched = sph::Interpolation::quintic;
        for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
                 &field::mass, &field::smoothing_length, &field::body, &field::predicted_velocity,
                 &field::predicted_density, &field::pressure, &field::sound_speed, &field::acceleration,
                 &field::specific_power, &field::velocity_gradient, &field::pressure_gradient,
                 &field::volume_gradient})
            particles.add(*info);
        if (choice.strength) particles.add(field::predicted_stress);
        if (choice.quintic) particles.add(field::volume_curvature);
        if (choice.variable_h) particles.add(field::next_smoothing_length);
        place(choice);
        Box box;
        box.dimension = choice.dimension;
        for (int a = 0; a < choice.dimension; ++a) {
            box.upper[static_cast<std::size_t>(a)] = choice.side * spacing;
            box.boundary[static_cast<std::size_t>(a)] = choice.boundary;
        }
        double largest = 0;
        for (const double h : particles.own(field::smoothing_length)) largest = std::max(largest, h);
        const CellGrid grid(box, settings.force_support() * comm.all_max(largest), cells_per_radius);
        decomposition.expect(particles);
        decomposition.divide(particles, grid);
        decomposition.arrange(particles, grid);
        fill(choice);
    }

    /// Refreshes the copies of all fields.
    void refresh(std::initializer_list<const FieldInfo*> fields) {
        decomposition.halo().begin(particles, fields);
        decomposition.halo().finish();
    }
    void gradients(Cells which = Cells::all) {
        refresh({&field::position, &field::mass, &field::smoothing_length, &field::body,
                 &field::predicted_velocity, &field::predicted_density, &field::pressure, &field::sound_speed,
                 &field::predicted_stress});
        sph::gradient_pass(particles, decomposition.table(), which, settings);
        if (particles.has(field::volume_curvature)) {
            refresh({&field::volume_gradient});
            sph::curvature_pass(particles, decomposition.table(), which, settings);
        }
    }
    sph::PassCount forces(Cells which = Cells::all) {
        sph::PassCount count;
        count.work_of_cell.assign(decomposition.own_cells().size(), 0.0);
        refresh({&field::velocity_gradient, &field::pressure_gradient, &field::volume_gradient,
                 &field::volume_curvature});
        sph::godunov_pass(particles, decomposition.table(), which, settings, count);
        return count;
    }

    static constexpr double spacing = 1e-3, density = 2700, sound_speed = 3100;
    Communicator comm;
    ParticleSet particles;
    Decomposition decomposition;
    sph::Settings settings;

  private:
    static constexpr RandomStream random{7};

    void place(const SampleChoice& choice) {
        const int D = choice.dimension;
        std::size_t count = 1;
        for (int a = 0; a < D; ++a) count *= static_cast<std::size_t>(choice.side);
        std::vector<std::size_t> kept;
        const std::size_t lump = 6, lumps = static_cast<std::size_t>(choice.side) / lump + 1;
        for (std::size_t k = 0; comm.is_root() && k < count; ++k) {
            std::size_t rest = k, where = 0;
            for (int a = 0; a < D; ++a, rest /= static_cast<std::size_t>(choice.side))
                where = where * lumps + rest % static_cast<std::size_t>(choice.side) / lump;
            if (!choice.gaps || random.uniform(where, 6) < 0.4) kept.push_back(k);
        }
        particles.resize(kept.size());
        const double mass = density * std::pow(spacing, D);
        for (std::size_t i = 0; i < kept.size(); ++i) place_one(choice, i, kept[i], mass);
    }
    /// Particle i of the set, at place `id` of the lattice.
    void place_one(const SampleChoice& choice, std::size_t i, std::size_t id, double mass) {
        const int D = choice.dimension;
        particles.data(field::id)[i] = id;
        std::size_t rest = id;
        for (int a = 0; a < D; ++a) {
            const double cell = static_cast<double>(rest % static_cast<std::size_t>(choice.side));
            rest /= static_cast<std::size_t>(choice.side);
            const double jitter = 0.4 * (random.uniform(id, static_cast<std::uint32_t>(a)) - 0.5);
            particles.data(field::position, a)[i] = (cell + 0.5 + jitter) * spacing;
        }
        particles.data(field::mass)[i] = mass * (1 + 0.1 * (random.uniform(id, 3) - 0.5));
        particles.data(field::smoothing_length)[i] =
            spacing * (choice.variable_h ? 1 + 0.3 * (random.uniform(id, 4) - 0.5) : 1);
        particles.data(field::body)[i] = random.uniform(id, 5) < 0.3 && choice.bodies ? 1 : 0;
    }

    void fill(const SampleChoice& choice) {
        const int D = choice.dimension;
        for (std::size_t i = 0; i < particles.size(); ++i) {
            const std::uint64_t id = particles.data(field::id)[i];
            double phase = 0;
            for (int a = 0; a < D; ++a) phase += (1 + 0.3 * a) * particles.data(field::position, a)[i];
            phase *= 6.283185307179586 / (12 * spacing);
            const auto noise = [&](std::uint32_t counter) { return random.uniform(id, counter) - 0.5; };
            particles.data(field::predicted_density)[i] =
                density * (1 + 0.05 * std::sin(phase) + 0.02 * noise(10));
            particles.data(field::pressure)[i] = 2e9 * std::sin(phase) + 2e8 * noise(11);
            particles.data(field::sound_speed)[i] = sound_speed * (1 + 0.1 * std::sin(phase));
            for (int a = 0; a < D; ++a)
                particles.data(field::predicted_velocity, a)[i] =
                    100 * std::cos(phase + a) + 20 * noise(12 + static_cast<std::uint32_t>(a));
            if (choice.strength)
                for (int c = 0; c < component_count(Shape::symmetric_tensor, D); ++c)
                    particles.data(field::predicted_stress, c)[i] =
                        5e8 * std::sin(phase + c) + 5e7 * noise(20 + static_cast<std::uint32_t>(c));
        }
    }
};

}  // namespace talus::test
