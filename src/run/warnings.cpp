#include "src/run/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace talus {

namespace {

/// Expanded matter may be unphysical there, where the floor of the sound speed acts; matter near or above its
/// density at rest must not.
void warn_of_imaginary_sound(const Material& material, std::vector<std::string>& found) {
    constexpr double expanded = 0.95;  // of the density at rest
    const auto* tillotson = std::get_if<Tillotson>(&material.eos);
    if (!tillotson) return;
    const ScanResult result = scan(*tillotson);
    if (result.densest_imaginary < expanded * tillotson->reference_density) return;
    found.push_back(fmt::format(
        "{}: c^2 < 0 in {} of {} states scanned, up to {:.4g} kg/m3 ({:.2f} of rest), worst "
        "at {:.4g} kg/m3 and {:.4g} J/kg; check its constants",
        material.name, result.imaginary, result.points, result.densest_imaginary,
        result.densest_imaginary / tillotson->reference_density, result.at_density, result.at_energy));
}

/// Without tensile strength only gravity holds a body together.
void warn_of_spin(const Body& body, const Material& material, double gravitational_constant,
                  std::vector<std::string>& found) {
    const bool holds_tension = material.shear_modulus > 0 && !(material.fracture && body.damage == 1);
    const double spin = norm(body.spin), limit = break_up_spin(body.density, gravitational_constant);
    if (holds_tension || spin <= limit) return;
    found.push_back(
        fmt::format("body '{}' turns in {:.4g} h and has no tensile strength: at {:.4g} kg/m3 gravity holds "
                    "even a sphere only "
                    "from {:.4g} h on",
                    body.name, rotation_period(spin) / 3600, body.density, rotation_period(limit) / 3600));
}

/// Partners within the kernel's support, on average.
double partners(const sph::Settings& sph, int dimension) {
    const double reach = sph.kernel_support() * sph.eta;  // [spacings]
    if (dimension == 1) return 2 * reach;
    if (dimension == 2) return std::numbers::pi * reach * reach;
    return 4.0 / 3 * std::numbers::pi * reach * reach * reach;
}

/// W. Dehnen, H. Aly, MNRAS 425 (2012) 1068; tests/stability/lattices.cpp.
void warn_of_pairing(const sph::Settings& sph, int dimension, std::vector<std::string>& found) {
    constexpr double most = 55;
    const double number = partners(sph, dimension);
    if (sph.kernel != sph::KernelKind::cubic_spline || dimension < 3 || number <= most) return;
    found.push_back(fmt::format(
        "sph.kernel = \"cubic_spline\" with {:.0f} partners (sph.eta = {}): beyond {:.0f} compressed "
        "matter forms pairs; kernel = \"wendland_c2\" does not, or eta = {:.2f}",
        number, sph.eta, most, sph.eta * std::cbrt(most / number)));
}

/// K. Sugiura, S. Inutsuka, J. Comput. Phys. 308 (2016) 171; tests/stability/tensile_instability.cpp.
void warn_of_interpolation(const Setup& setup, std::vector<std::string>& found) {
    constexpr std::array names{"linear", "cubic", "quintic"};
    const sph::Settings& sph = setup.sph;
    const int dimension = setup.box.dimension;
    if (sph.formulation != sph::Formulation::godunov) return;
    const auto warn = [&](std::string_view state, sph::Interpolation used) {
        found.push_back(
            fmt::format("sph.interpolation = \"{}\": {} matter clumps in {}D; \"automatic\" does not",
                        names[static_cast<std::size_t>(used)], state, dimension));
    };
    const bool may_stretch =
        std::any_of(setup.materials.begin(), setup.materials.end(), [](const Material& material) {
            return !std::holds_alternative<IdealGas>(material.eos) && material.least_pressure < 0;
        });
    if (dimension == 1 ? sph.compressed == sph::Interpolation::quintic
                       : sph.compressed != sph::Interpolation::linear)
        warn("compressed", sph.compressed);
    if (may_stretch && (dimension == 1 ? sph.stretched != sph::Interpolation::quintic
                                       : sph.stretched == sph::Interpolation::linear))
        warn("stretched", sph.stretched);
    constexpr double narrow = 0.85;
    if (may_stretch && dimension == 2 && sph.stretched == sph::Interpolation::cubic && sph.eta < narrow)
        found.push_back(fmt::format(
            "sph.eta = {}: below {} stretched matter clumps with the cubic interpolation in 2D; a wider "
            "kernel does not",
            sph.eta, narrow));
}

/// Where the wall lies for waves on lattices: tools/chart time_step, tests/stability/time_step.cpp.
void warn_of_time_step(const sph::Settings& sph, std::vector<std::string>& found) {
    const double most = sph.formulation == sph::Formulation::godunov ? 1 / sph.eta : 0.5;
    if (sph.courant <= most) return;
    found.push_back(fmt::format("sph.courant = {}: sound waves have been seen to blow up above {:.2g}",
                                sph.courant, most));
}

}  // namespace

void warn_of_thin_wall(const Body& wall, double range, int dimension, std::vector<std::string>& found) {
    const double least = thickness(wall.shape, dimension);
    if (least > 0.9 * range) return;
    found.push_back(
        fmt::format("body '{}' is a wall {:.3g} m thick, and forces reach {:.3g} m: what lies on it "
                    "will sink in",
                    wall.name, least, range));
}

std::vector<std::string> warnings(const SceneSetup& setup) {
    std::vector<std::string> found;
    const Setup& simulation = setup.simulation;
    for (const Material& material : simulation.materials) warn_of_imaginary_sound(material, found);
    for (std::size_t b = 0; b < setup.bodies.size(); ++b)
        warn_of_spin(setup.bodies[b], simulation.materials[b], setup.gravitational_constant, found);
    const sph::Settings& sph = simulation.sph;
    for (std::size_t b = 0; b < simulation.walls.size(); ++b)
        if (simulation.walls[b])
            warn_of_thin_wall(setup.bodies[b], sph.force_support() * sph.eta * setup.bodies[b].spacing,
                              simulation.box.dimension, found);
    warn_of_pairing(sph, simulation.box.dimension, found);
    warn_of_interpolation(simulation, found);
    warn_of_time_step(sph, found);
    if (simulation.box.dimension == 3 && sph.formulation == sph::Formulation::godunov && sph.cutoff < 2.5) {
        const auto [eta, cutoff] = sph::gaussian_defaults(3, false);
        found.push_back(fmt::format(
            "sph.cutoff = {}: compressed matter in 3D forms pairs where a pressure of a tenth of "
            "the bulk modulus or more lasts for some 60 spacings/c; sph.eta = {} with sph.cutoff = "
            "{} has as few partners and does not",
            sph.cutoff, eta, cutoff));
    }
    return found;
}

}  // namespace talus
