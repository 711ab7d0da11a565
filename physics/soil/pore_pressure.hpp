#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.hpp"
#include "comm/halo.hpp"
#include "physics/soil/constitutive.hpp"
#include "physics/soil/free_faces.hpp"
#include "physics/soil/stencils.hpp"

namespace talus::soil {

/// The implicit step of the pore pressure in the fractional step of the v-p_w model (T. Blanc, M. Pastor,
/// Comput. Methods Appl. Mech. Eng. 221 (2012) 41), projected exactly on the two grids: pressures are of
/// nodes, velocities of elements half a step ahead,
///   V p/(Q dt) - V div((k_w + dt/(2 rho)) grad p) = V p_n/(Q dt) - V div v*,
/// whose divergence is the adjoint of the gradient, so that the matrix is symmetric. No pressure gradient
/// drives water through a face unless a pressure is imposed there. Free faces (FreeFaces) add rows to the
/// matrix that are not symmetric; it is then solved by stabilised biconjugate gradients (H. A. van der Vorst,
/// SIAM J. Sci. Stat. Comput. 13 (1992) 631).
class PorePressure {
  public:
    struct Settings {
        double time_step = 0;  ///< [s]
        double spacing = 0;    ///< [m]
        double stabilisation =
            0;  ///< of what elements cannot see of the pressure, in the unit of the rest [1]
        double tolerance = 1e-10;  ///< of the residual, over that of p = 0 [1]
        std::span<const Material> materials;
        FreeFaces faces;
    };

    PorePressure(const Communicator& comm, Halo& halo) : comm_(comm), halo_(halo) {}

    /// Takes the nodes' pressures to the end of the step by conjugate gradients; dot products are exact sums,
    /// so that bits do not depend on ranks. `imposed`: nodes whose pressure is given. Elements and their
    /// copies hold v*, and with free faces the effective stress, as do nodes on faces the velocity there.
    /// Throws AgreedError if it does not converge. Collective.
    void advance(ParticleSet& particles, const Stencils& stencils, std::span<const std::uint32_t> imposed,
                 const Settings& settings);
    /// Corrects the elements' velocity by the new pressure and makes their stress the total one. Call once
    /// the copies' pressures are refreshed.
    static void correct_elements(ParticleSet& particles, const StencilRows& rows, const Settings& settings);

    int iterations() const { return iterations_; }  ///< of the last step

  private:
    void apply(ParticleSet& particles, const Stencils& stencils, const Settings& settings);
    void conjugate_gradients(ParticleSet& particles, const Stencils& stencils, const Settings& settings,
                             double enough);
    void stabilised_biconjugate_gradients(ParticleSet& particles, const Stencils& stencils,
                                          const Settings& settings, double enough);
    void extrapolate(ParticleSet& particles, const Stencils& stencils) const;
    void refuse_unless_converging(double rest, double enough, const Settings& settings) const;
    void prepare(ParticleSet& particles, const Stencils& stencils, const Settings& settings);
    double dot(const Stencils& stencils, std::span<const double> a, std::span<const double> b) const;

    const Communicator& comm_;
    Halo& halo_;
    std::vector<double> residual_, conditioned_, product_, diagonal_, right_, by_faces_;
    std::vector<std::uint8_t> is_free_;
    int iterations_ = 0;
};

/// Fields that the coupled model needs besides; in 2D and 3D free tight faces need one more.
void add_pore_fields(ParticleSet& particles, bool with_free_faces);

/// As if they had been the same a step before.
void remember_pore_pressures(ParticleSet& particles);

}  // namespace talus::soil
