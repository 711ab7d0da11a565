#pragma once
#include <cmath>
#include <numbers>

#include "physics/dem/laws/kinematics.hpp"

namespace talus::dem {

// Forces along the normal beside that of the deformed contact, that may act across a gap. They do not take
// from what friction is measured with: a pull presses the surfaces together as much as it holds the grains.

/// None.
template <class Real = double>
struct NoSurfaceForce {
    Real operator()(const ContactKinematics<Real>&) const { return Real(0.0); }
    Real reach() const { return Real(0.0); }
};

/// A pull c R* while the pair touches, that falls off across a gap h as (s/(s + h))^2 up to a reach. In
/// contact: c = 2 pi w after Derjaguin, Muller and Toporov (J. Colloid Interface Sci. 53 (1975) 314), c = 3/2
/// pi w the pull-off of Johnson, Kendall and Roberts (Proc. R. Soc. A 324 (1971) 301), w the work of
/// adhesion; van der Waals: c = A / (6 s^2), A Hamaker's constant and s the least distance of the surfaces
/// (H. C. Hamaker, Physica 4 (1937) 1058). Regolith: D. J. Scheeres, C. M. Hartzell, P. Sanchez, M. Swift,
/// Icarus 210 (2010) 968.
template <class Real = double>
struct PullOff {
    Real force_per_radius;  ///< c [N/m]
    Real separation;        ///< s [m]
    Real greatest_gap;      ///< reach [m]

    /// Pull [N].
    Real operator()(const ContactKinematics<Real>& k) const {
        using std::max;
        const Real gap = max(-k.overlap, Real(0.0)), ratio = separation / (separation + gap);
        return select(gap > greatest_gap, Real(0.0), force_per_radius * k.effective_radius * ratio * ratio);
    }
    Real reach() const { return greatest_gap; }
};

/// A viscous film squeezed between the surfaces, F = -6 pi eta R*^2 v_n (1/h - 1/h_max), with the gap h not
/// taken as less than the surfaces' roughness. S. Kim, S. J. Karrila, Microhydrodynamics (1991), sec. 11.2;
/// the shift makes it vanish at its reach: N.-Q. Nguyen, A. J. C. Ladd, Phys. Rev. E 66 (2002) 046708.
template <class Real = double>
struct Lubrication {
    Real viscosity;     ///< eta [Pa s]
    Real roughness;     ///< least gap [m]
    Real greatest_gap;  ///< h_max, reach [m]

    /// Pull [N], positive as the pair parts.
    Real operator()(const ContactKinematics<Real>& k) const {
        using std::max;
        const Real closeness = max(1 / max(-k.overlap, roughness) - 1 / greatest_gap, Real(0.0));
        const Real drag = (6 * std::numbers::pi) * viscosity * k.effective_radius * k.effective_radius;
        return drag * closeness * dot(k.velocity, k.normal);
    }
    Real reach() const { return greatest_gap; }
};

}  // namespace talus::dem
