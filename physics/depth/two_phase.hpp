#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "physics/depth/basal_friction.hpp"

namespace talus::depth {

enum class DragLaw : std::uint8_t {
    none,
    darcy,            ///< n^2 rho_w g/k: water through soil that is packed
    anderson_jackson  ///< n phi (rho_s - rho_w) g/(V_T n^m): grains in water; packed, it is Darcy's
};

/// Solid and water that flow through each other: a column is of one or of the other, with a velocity of its
/// own. Of solid with the height h_s and water with h_w in one place, h = h_s + h_w, phi = h_s/h, n = 1 -
/// phi:
///
///     dv_s/dt = - (1/h_s) grad(g (1 - w) h_s h/2) - w g grad h - g grad Z + C h (v_w - v_s)/(rho_s h_s) -
///     friction dv_w/dt = - g grad h - g grad Z - C h (v_w - v_s)/(rho_w h_w) - friction,    w = rho_w/rho_s.
///
/// Water presses on both with its level, the solid bears its weight less buoyancy by its grains. E. B.
/// Pitman, L. Le, Phil. Trans. R. Soc. A 363 (2005) 1573, in the form of M. Pelanti, F. Bouchut, A. Mangeney,
/// ESAIM: M2AN 42 (2008) 851, eq. 1. Drag: T. B. Anderson, R. Jackson, Ind. Eng. Chem. Fundam. 6 (1967) 527;
/// its exponent m after J. F. Richardson, W. N. Zaki, Trans. Inst. Chem. Eng. 32 (1954) 35: theirs, 4.65 for
/// small grains, less 1.
struct TwoPhase {
    double solid_density = 2700, water_density = 1000;  ///< [kg/m3]
    DragLaw drag = DragLaw::anderson_jackson;
    double speed = 1;        ///< hydraulic conductivity k, or settling velocity V_T of a single grain [m/s]
    double exponent = 3.65;  ///< m [1]
    double porosity = 0.4;   ///< of the solid where its grains touch [1]
    BasalFriction water_friction{};  ///< of the bed on the water
    double bed_porosity = 0.4;       ///< of the ground that solid takes up [1]
    double bed_saturation = 1;       ///< share of its pores that water fills; the rest is air [1]

    double density(bool is_water) const { return is_water ? water_density : solid_density; }
    /// The share of the solid that water bears by buoyancy: all if it fills the pores, in proportion to what
    /// it fills else.
    double saturation(double water_over_solid) const {
        return std::min(1.0, water_over_solid * (1 - porosity) / porosity);
    }
    /// The share of the solid's weight that water bears [1].
    double buoyancy() const { return water_density / solid_density; }

    /// C h/(h_s h_w), what an area of both bears for each metre of height of both and each m/s of velocity
    /// between them [kg/(m4 s)]; heights [m] positive.
    double drag_factor(double solid_height, double water_height, double gravity) const {
        const double height = solid_height + water_height, water_share = water_height / height;
        switch (drag) {
            case DragLaw::none:
                return 0;
            case DragLaw::darcy:
                return water_share * water_density * gravity / (speed * solid_height);
            case DragLaw::anderson_jackson:
                return (solid_density - water_density) * gravity /
                       (speed * std::pow(water_share, exponent) * height);
        }
        return 0;
    }
};

}  // namespace talus::depth
