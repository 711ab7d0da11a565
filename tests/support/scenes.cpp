#include "tests/support/scenes.hpp"

#include <cmath>

#include "domain/random.hpp"
#include "tests/support/solid_materials.hpp"

namespace talus::test {

namespace {

constexpr RandomStream noise{.seed = 11};

double jitter(std::uint64_t id, std::uint32_t counter) { return noise.uniform(id, counter) - 0.5; }

/// Appends a lattice of nx x ny x nz points from `corner` on, with ids in an order unlike that of the cells.
struct Lattice {
    std::array<int, 3> count;
    std::array<double, 3> corner;
    double spacing;
};
std::size_t append(ParticleSet& particles, const Lattice& lattice) {
    const std::size_t first = particles.size();
    const auto [nx, ny, nz] = lattice.count;
    particles.resize(first + static_cast<std::size_t>(nx * ny * nz));
    std::size_t i = first;
    for (int x = 0; x < nx; ++x)
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y, ++i) {
                particles.data(field::id)[i] = 3 * i + 5;
                const std::array<int, 3> at{x, y, z};
                for (int axis = 0; axis < particles.dimension(); ++axis) {
                    const auto a = static_cast<std::size_t>(axis);
                    particles.data(field::position, axis)[i] =
                        lattice.corner[a] + (at[a] + 0.5) * lattice.spacing;
                }
            }
    return first;
}

void fill_gas(ParticleSet& particles, double spacing, double noise_of_velocity, double h) {
    const double mass = std::pow(spacing, particles.dimension());
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const std::uint64_t id = particles.data(field::id)[i];
        for (int axis = 0; axis < particles.dimension(); ++axis) {
            const auto a = static_cast<std::uint32_t>(axis);
            particles.data(field::position, axis)[i] += 0.3 * spacing * jitter(id, a);
            particles.data(field::velocity, axis)[i] = noise_of_velocity * jitter(id, 3 + a);
        }
        particles.data(field::mass)[i] = mass;
        particles.data(field::internal_energy)[i] = 2.5 * (1 + 0.2 * jitter(id, 6));
        particles.data(field::smoothing_length)[i] = h;
        if (particles.has(field::density)) particles.data(field::density)[i] = 1;
    }
}

sph::Settings standard_sph() {
    sph::Settings settings;
    settings.formulation = sph::Formulation::standard;
    settings.kernel = sph::KernelKind::wendland_c2;
    settings.density = sph::DensityMethod::summation;
    settings.variable_smoothing_length = true;
    settings.eta = 1.3;
    settings.courant = 0.3;
    return settings;
}

Material ideal_gas() { return {.name = "gas", .eos = IdealGas{}, .reference_density = 1}; }

}  // namespace

SmallScene rock_impact_2d() {
    const double spacing = 0.01, density = 2700;
    Material rock{.name = "basalt",
                  .eos = basalt(),
                  .shear_modulus = 22.7e9,
                  .bulk_modulus = 26.7e9,
                  .reference_density = density};
    rock.strength = Lundborg{.cohesion = 1e7,
                             .limit = 3.5e9,
                             .friction_intact = 1.5,
                             .friction_damaged = 0.8,
                             .melt_energy = 3.4e6};
    rock.fracture = Fracture{.weibull_k = 4e35, .weibull_m = 9};
    Setup setup;
    setup.box.dimension = 2;
    setup.sph.several_bodies = true;
    setup.sph.smoothing_widening = 1;
    setup.materials = {rock, rock};
    ParticleSet particles("solid", 2);
    add_fields(particles, setup);
    append(particles, {{30, 20, 1}, {0, 0, 0}, spacing});
    const std::size_t second = append(particles, {{8, 8, 1}, {-8.6 * spacing, 9.3 * spacing, 0}, spacing});
    const double volume = spacing * spacing * 1.0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool is_projectile = i >= second;
        const std::size_t count = is_projectile ? particles.size() - second : second;
        const FlawSampler sampler(*rock.fracture, volume * static_cast<double>(count), count, 7,
                                  is_projectile ? 1 : 0);
        const Flaws flaws = sampler.sample(particles.data(field::id)[i]);
        particles.data(field::flaw_threshold)[i] = flaws.threshold;
        particles.data(field::flaw_exponent)[i] = flaws.exponent;
        particles.data(field::flaw_count)[i] = flaws.count;
        particles.data(field::mass)[i] = density * volume;
        particles.data(field::density)[i] = density;
        particles.data(field::smoothing_length)[i] = 1.2 * spacing;
        particles.data(field::body)[i] = is_projectile;
        particles.data(field::velocity, 0)[i] = is_projectile ? 900 : 0;
        particles.data(field::velocity, 1)[i] = is_projectile ? -150 : 0;
    }
    return {"rock impact 2D", setup, std::move(particles)};
}

SmallScene periodic_gas_3d() {
    Setup setup;
    setup.box.dimension = 3;
    setup.box.upper = {1, 1, 1.2};
    setup.box.boundary.fill(Boundary::periodic);
    setup.sph = standard_sph();
    setup.materials = {ideal_gas()};
    ParticleSet particles("gas", 3);
    add_fields(particles, setup);
    append(particles, {{10, 10, 12}, {}, 0.1});
    fill_gas(particles, 0.1, 3.0, 0.13);
    return {"periodic gas 3D", setup, std::move(particles)};
}

SmallScene collapsing_gas_3d() {
    Setup setup;
    setup.box.dimension = 3;
    setup.sph = standard_sph();
    setup.sph.largest_smoothing_length = 0.4;
    setup.gravity.emplace();
    setup.gravity->constant = 40;  // collapses in a few sound crossings
    setup.gravity->opening = gravity::Opening::relative;
    setup.gravity->accuracy = 1e-3;
    setup.materials = {ideal_gas()};
    ParticleSet particles("gas", 3);
    add_fields(particles, setup);
    append(particles, {{10, 10, 10}, {}, 0.1});
    fill_gas(particles, 0.1, 1.0, 0.13);
    for (std::size_t i = 0; i < particles.size(); i += 37)  // some that escaped
        particles.data(field::position, static_cast<int>(i % 3))[i] +=
            std::pow(2.0, static_cast<double>(i % 12));
    return {"collapsing gas 3D", setup, std::move(particles)};
}

SmallScene gas_between_walls_2d() {
    Setup setup;
    setup.box.dimension = 2;
    setup.box.upper = {1, 0.6, 0};
    setup.box.boundary = {Boundary::reflecting, Boundary::periodic, Boundary::open};
    setup.sph.density = sph::DensityMethod::summation;
    setup.sph.variable_smoothing_length = true;
    setup.sph.smoothing_widening = 1.2;
    setup.sph.riemann_velocity = true;
    setup.sph.shock_slope = 1.2;
    setup.sph.compressed = setup.sph.stretched = sph::Interpolation::cubic;
    setup.materials = {ideal_gas()};
    ParticleSet particles("gas", 2);
    add_fields(particles, setup);
    append(particles, {{30, 18, 1}, {}, 1.0 / 30});
    fill_gas(particles, 1.0 / 30, 1.5, 1.0 / 30);
    return {"gas between walls 2D", setup, std::move(particles)};
}

SmallScene standing_wave_1d() {
    Setup setup;
    setup.box.dimension = 1;
    setup.box.upper = {1, 0, 0};
    setup.box.boundary[0] = Boundary::periodic;
    setup.sph.cutoff = 3;
    setup.sph.compressed = sph::stable_compressed(1);
    setup.sph.stretched = sph::stable_stretched(1);
    setup.materials = {{.name = "elastic",
                        .eos = LinearEquationOfState{.reference_density = 1, .sound_speed = 1},
                        .reference_density = 1}};
    ParticleSet particles("bar", 1);
    add_fields(particles, setup);
    append(particles, {{300, 1, 1}, {}, 1.0 / 300});
    fill_gas(particles, 1.0 / 300, 0.05, 1.0 / 300);
    return {"standing wave 1D", setup, std::move(particles)};
}

SmallScene soil_on_walls_2d() {
    const double spacing = 0.01, density = 2000, height = 0.2;
    Material sand{.name = "sand",
                  .eos = LinearEquationOfState{.reference_density = density, .sound_speed = 50},
                  .shear_modulus = 2e6,
                  .bulk_modulus = density * 50 * 50,
                  .reference_density = density};
    DruckerPrager model{.peak = cone(ConeMatch::plane_strain, 50, 0.5, 0.1),
                        .residual = cone(ConeMatch::plane_strain, 10, 0.4, 0)};
    model.softening_strain = 1e-3;
    sand.plasticity = model;
    Setup setup;
    setup.box.dimension = 2;
    setup.sph = standard_sph();
    setup.sph.density = sph::DensityMethod::continuity;
    setup.sph.variable_smoothing_length = false;
    setup.even_gravity = std::array<double, 3>{0, -9.81, 0};
    setup.materials = {sand, sand, sand};
    setup.walls.resize(3);
    setup.walls[1] = sph::Wall{.slip = sph::WallSlip::no_slip, .normal = {}, .motion = {}};
    setup.walls[1]->motion.amplitude = {1e-3, 0, 0};
    setup.walls[1]->motion.translation_oscillation.frequency = 20;
    setup.walls[2] = sph::Wall{.slip = sph::WallSlip::free_slip, .normal = {1, 0, 0}, .motion = {}};
    ParticleSet particles("sph", 2);
    add_fields(particles, setup);
    append(particles, {{20, 20, 1}, {0, 0, 0}, spacing});
    const std::size_t floor = append(particles, {{36, 4, 1}, {-4 * spacing, -4 * spacing, 0}, spacing});
    const std::size_t back = append(particles, {{4, 24, 1}, {-4 * spacing, 0, 0}, spacing});
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double depth = height - particles.data(field::position, 1)[i];
        particles.data(field::mass)[i] = density * spacing * spacing;
        particles.data(field::density)[i] = density * (1 + 9.81 * depth / (50 * 50));
        particles.data(field::smoothing_length)[i] = 1.3 * spacing;
        particles.data(field::body)[i] = i >= back ? 2 : i >= floor ? 1 : 0;
        particles.data(field::velocity, 0)[i] = i < floor ? 0.3 * (1 - depth / height) : 0;
    }
    return {"soil on walls 2D", setup, std::move(particles)};
}

}  // namespace talus::test
