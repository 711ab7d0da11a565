#pragma once
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/random.hpp"
#include "physics/sph/kernels.hpp"
#include "src/setup/packing.hpp"
#include "src/simulation.hpp"
#include "tests/support/lattice_dispersion.hpp"

/// Lattices of equal particles in a periodic box, in units of the spacing, the sound speed and the mean
/// density.
namespace talus::test {

struct LatticeCase {
    sph::Formulation formulation = sph::Formulation::godunov;
    sph::KernelKind kernel = sph::KernelKind::gaussian;
    int dimension = 1;
    Point size{};  ///< of the box
    Lattice lattice = Lattice::cubic;
    double pressure = 0;  ///< P/(rho c^2), of either sign
    sph::Interpolation compressed = sph::Interpolation::linear, stretched = sph::Interpolation::linear;
    double smoothing_length = 1;
    double cutoff = 3.05;  ///< [h] no shell of a cubic lattice lies at it, nor at sqrt2 of it
    sph::DensityMethod density = sph::DensityMethod::continuity;
    bool riemann = false;      ///< false: no dissipation
    double shear_modulus = 0;  ///< mu/(rho c^2)
    double courant = 0.1;
    double least_pressure = -std::numeric_limits<double>::infinity();  ///< of the material
};

/// The lattice as the dispersion relations need it: its density, and its kernel.
struct LatticeState {
    double density;       ///< that particles see
    double kernel_scale;  ///< of the program's kernel, on that of the relations for this density
    double moment;  ///< sum V x_i x_i grad W, 1 but for the discretisation, which corrected gradients undo
};

template <int D>
LatticeState lattice_state_in(const LatticeCase& lattice) {
    const sph::Gaussian<D> kernel(lattice.cutoff);
    const double h = lattice.smoothing_length;
    const int n = static_cast<int>(lattice.cutoff * h) + 1, ny = D > 1 ? n : 0, nz = D > 2 ? n : 0;
    double density = 0, moment = 0;
    for (int a = -n; a <= n; ++a)
        for (int b = -ny; b <= ny; ++b)
            for (int c = -nz; c <= nz; ++c) {
                const double r2 = a * a + b * b + c * c;
                density += std::max(kernel.value(r2, 1 / h), 0.0);
                moment -= a * a * kernel.factor(r2, 1 / h);
            }
    if (lattice.density == sph::DensityMethod::continuity) density = 1;
    return {density, kernel.norm * std::pow(std::numbers::pi, 0.5 * D) / density, moment};
}
inline LatticeState lattice_state(const LatticeCase& lattice) {
    if (lattice.dimension == 1) return lattice_state_in<1>(lattice);
    if (lattice.dimension == 2) return lattice_state_in<2>(lattice);
    return lattice_state_in<3>(lattice);
}

/// omega^2 of a longitudinal wave along x, cubic lattice. By continuity the density follows the corrected
/// velocity gradient, which is 1/moment times the raw kernel sum of the relations: a factor on their D where
/// it stands for the density, in -c^2 D a and 2 (P/rho) D a.
inline double omega_squared(const LatticeCase& lattice, double wavenumber) {
    const LatticeState state = lattice_state(lattice);
    reference::LatticeWave wave{.dimension = lattice.dimension,
                                .smoothing_length = lattice.smoothing_length,
                                .density = state.density,
                                .pressure = lattice.pressure * state.density,
                                .cutoff = lattice.cutoff,
                                .gradient_scale = state.kernel_scale};
    const sph::Interpolation used = lattice.pressure > 0 ? lattice.compressed : lattice.stretched;
    const auto kind = static_cast<reference::Interpolation>(used);
    const double raw = reference::godunov_omega_squared(wave, kind, wavenumber);
    if (lattice.density == sph::DensityMethod::summation) return raw;
    wave.pressure = 0;
    const double unloaded = reference::godunov_omega_squared(wave, kind, wavenumber);
    return raw + (1 / state.moment - 1) * (1 - 2 * lattice.pressure) * unloaded;
}

/// A simulation of a lattice, each particle moved off its site and given a velocity.
class LatticeSimulation {
  public:
    using Field = std::function<Point(std::uint64_t id, const Point& site)>;

    LatticeSimulation(const Communicator& comm, const LatticeCase& lattice, const Field& displacement,
                      const Field& velocity)
        : comm_(comm), lattice_(lattice), run_(make(comm, displacement, velocity)) {
        run_.start();
    }

    Simulation& run() { return run_; }

    /// Amplitude of sin(k x) along x in the displacements.
    double displacement(double k) const {
        return project(k, [this](std::size_t i, const Point& site) {
            const double d = run_.particles().own(field::position)[i] - site[0];
            return d - lattice_.size[0] * std::round(d / lattice_.size[0]);
        });
    }
    /// Amplitude of sin(k x) along x in the accelerations.
    double acceleration(double k) const {
        return project(
            k, [this](std::size_t i, const Point&) { return run_.particles().own(field::acceleration)[i]; });
    }
    /// Least distance between two sites and between two particles, over the periodic box. By one rank alone.
    double closest_sites() const { return closest(sites_); }
    double closest_pair() const {
        std::vector<Point> positions(run_.particles().size());
        for (std::size_t i = 0; i < positions.size(); ++i)
            for (int axis = 0; axis < lattice_.dimension; ++axis)
                positions[i][static_cast<std::size_t>(axis)] = run_.particles().own(field::position, axis)[i];
        return closest(positions);
    }

  private:
    const Point& site_of(std::size_t i) const { return sites_[run_.particles().data(field::id)[i]]; }
    double closest(const std::vector<Point>& points) const {
        double least = 1e300;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                double r2 = 0;
                for (std::size_t a = 0; a < static_cast<std::size_t>(lattice_.dimension); ++a) {
                    const double d = points[i][a] - points[j][a];
                    const double nearest = d - lattice_.size[a] * std::round(d / lattice_.size[a]);
                    r2 += nearest * nearest;
                }
                least = std::min(least, r2);
            }
        return std::sqrt(least);
    }
    double total(double share) const {
        double sum = 0;
        for (const double part : comm_.all_gather(std::span<const double>(&share, 1))) sum += part;
        return sum;
    }
    template <class Value>
    double project(double k, Value&& value) const {
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < run_.particles().size(); ++i) {
            const double sine = std::sin(k * site_of(i)[0]);
            sum += sine * value(i, site_of(i));
            squares += sine * sine;
        }
        return total(sum) / total(squares);
    }

    Simulation make(const Communicator& comm, const Field& displacement, const Field& velocity) {
        const int dimension = lattice_.dimension;
        for_each_point(BoxShape{{}, lattice_.size}, lattice_cell(lattice_.lattice, dimension), 1, dimension,
                       [this](const Point& site) { sites_.push_back(site); });
        const double density = lattice_state(lattice_).density;
        Setup setup;
        setup.box = {.dimension = dimension, .upper = lattice_.size};
        for (int a = 0; a < dimension; ++a)
            setup.box.boundary[static_cast<std::size_t>(a)] = Boundary::periodic;
        setup.sph.formulation = lattice_.formulation;
        setup.sph.kernel = lattice_.kernel;
        setup.sph.viscosity_alpha = setup.sph.viscosity_beta = 0;
        setup.sph.cutoff = lattice_.cutoff;
        setup.sph.compressed = lattice_.compressed;
        setup.sph.stretched = lattice_.stretched;
        setup.sph.density = lattice_.density;
        setup.sph.riemann = lattice_.riemann;
        setup.sph.courant = lattice_.courant;
        setup.materials = {
            {.name = "linear",
             .eos = LinearEquationOfState{.reference_density = density * (1 - lattice_.pressure),
                                          .sound_speed = 1},
             .shear_modulus = lattice_.shear_modulus * density,
             .reference_density = density,
             .least_pressure = lattice_.least_pressure}};
        ParticleSet particles("lattice", dimension);
        add_fields(particles, setup);
        for (std::uint64_t id = 0; id < sites_.size(); ++id) {
            if (id % static_cast<std::uint64_t>(comm.size()) != static_cast<std::uint64_t>(comm.rank()))
                continue;
            const std::size_t i = particles.size();
            particles.resize(i + 1);
            const Point off = displacement(id, sites_[id]), v = velocity(id, sites_[id]);
            particles.data(field::id)[i] = id;
            for (int axis = 0; axis < dimension; ++axis) {
                const auto a = static_cast<std::size_t>(axis);
                particles.data(field::position, axis)[i] = sites_[id][a] + off[a];
                particles.data(field::velocity, axis)[i] = v[a];
            }
            particles.data(field::mass)[i] = 1;
            particles.data(field::smoothing_length)[i] = lattice_.smoothing_length;
            if (particles.has(field::density)) particles.data(field::density)[i] = density;
        }
        return Simulation(comm, setup, std::move(particles));
    }

    const Communicator& comm_;
    LatticeCase lattice_;
    std::vector<Point> sites_;
    Simulation run_;
};

/// Least distance between two particles after some sound crossings of a slightly disordered box, or as soon
/// as they have clumped; in units of that in the lattice.
inline double closest_after(const Communicator& comm, const LatticeCase& lattice, double crossings) {
    static constexpr RandomStream noise{.seed = 3};
    LatticeSimulation box(
        comm, lattice,
        [](std::uint64_t id, const Point&) {
            Point d{};
            for (std::uint32_t a = 0; a < 3; ++a) d[a] = 0.01 * (2 * noise.uniform(id, a) - 1);
            return d;
        },
        [](std::uint64_t, const Point&) { return Point{}; });
    const double lattice_distance = box.closest_sites();
    double closest = 1;
    while (box.run().time() < crossings * lattice.size[0] && closest > 0.5) {
        for (int step = 0; step < 10; ++step) box.run().step();
        closest = box.closest_pair() / lattice_distance;
    }
    return closest;
}

}  // namespace talus::test
