#pragma once
#include <cmath>

#include "physics/dem/laws/kinematics.hpp"

namespace talus::dem {

/// No force beside that of the contact.
template <class Real = double>
struct NoAttraction {
    Real operator()(const ContactKinematics<Real>&) const { return Real(0.0); }
    Real adds_to_friction(const Real&) const { return Real(0.0); }
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

    /// Pull [N], positive.
    Real operator()(const ContactKinematics<Real>& k) const {
        using std::max;
        const Real ratio = separation / (separation + max(-k.overlap, Real(0.0)));
        return select(k.overlap > -greatest_gap, force_per_radius * k.effective_radius * ratio * ratio,
                      Real(0.0));
    }
    Real adds_to_friction(const Real& pull) const { return pull; }
    Real reach() const { return greatest_gap; }
};

}  // namespace talus::dem
