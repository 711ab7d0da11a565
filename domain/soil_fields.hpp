#pragma once
#include "domain/fields.hpp"

/// Fields of soil on two grids of particles (physics/soil). On nodes they hold the state at the time of the
/// step, on elements that half a step before.
namespace talus::soil_field {
using enum Shape;
using enum Role;
using enum Reach;

inline constexpr Field<std::uint8_t> grid{
    "grid", "1", scalar, state, halo, "0: node, carries mass; 1: element, half a step behind"};
inline constexpr Field<double> velocity{"velocity", "m s-1", vector, state, halo, "velocity of the skeleton"};
inline constexpr Field<double> stress{"stress", "Pa", symmetric_tensor,
                                      state,    halo, "effective stress within the scene's dimensions"};
inline constexpr Field<double> lateral_stress{
    "lateral_stress",
    "Pa",
    scalar,
    state,
    halo,
    "normal effective stress along each axis beyond the scene's dimension"};
inline constexpr Field<double> displacement{"displacement", "m",   vector,
                                            state,          owner, "of nodes since the start"};
inline constexpr Field<double> viscoplastic_strain{
    "viscoplastic_strain", "1", scalar, state, owner, "accumulated deviatoric viscoplastic strain"};
inline constexpr Field<double> viscoplastic_work{
    "viscoplastic_work", "J m-3", scalar, state, owner, "work done on viscoplastic strain"};
inline constexpr Field<double> preconsolidation{
    "preconsolidation", "Pa", scalar, state, owner, "size p_c of the yield surface of modified Cam-Clay"};
inline constexpr Field<std::uint8_t> faces{"faces",
                                           "1",
                                           scalar,
                                           state,
                                           owner,
                                           "faces of the body that the node lies on: bits 2 axis (lower) and "
                                           "2 axis + 1 (upper); 64: an edge or corner "
                                           "that turns inwards"};
inline constexpr std::uint8_t turns_inwards = 64;
inline constexpr Field<std::uint32_t> conditions{
    "conditions", "1",   scalar,
    state,        owner, "boundary conditions of the scene that hold at the node, a bit each"};
inline constexpr Field<double> pore_pressure{"pore_pressure", "Pa", scalar,
                                             state,           halo, "pressure of the pore water, of nodes"};
inline constexpr Field<double> earlier_pore_pressure{
    "earlier_pore_pressure", "Pa", scalar, state, owner, "of nodes: pore pressure a step before"};
inline constexpr Field<double> volume{
    "volume", "m3", scalar,
    state,    halo, "of nodes: share of the body's volume at the start; of elements: now"};
inline constexpr Field<double> surface{"surface",
                                       "m2",
                                       vector,
                                       state,
                                       owner,
                                       "of nodes on faces: area of the body's surface times its "
                                       "outward normal"};
inline constexpr Field<double> middle_velocity{
    "middle_velocity", "m s-1", vector, work, halo, "of nodes: in the middle of the step"};
inline constexpr Field<double> velocity_slope{
    "velocity_slope", "s-1", tensor, work, halo, "of elements: gradient of the velocity that they fit"};
inline constexpr Field<double> nominal_stress{
    "nominal_stress",
    "Pa",
    tensor,
    work,
    halo,
    "of elements: stress half a step ahead on surfaces as they are now, row by row"};
inline constexpr Field<double> stress_fit{
    "stress_fit", "1",
    profile,      work,
    halo,         "of elements: the stress that they fit [Pa], then its gradient along each axis [Pa/m]"};
inline constexpr Field<double> fit_weight{"fit_weight",
                                          "m-3",
                                          scalar,
                                          work,
                                          halo,
                                          "of elements: sum of the kernel over nodes; "
                                          "0 if these define no gradient"};
inline constexpr Field<double> fit_centre{
    "fit_centre", "m", vector, work, halo, "of elements: weighted mean of nodes, from the element"};
inline constexpr Field<double> fit_inverse{
    "fit_inverse", "m-2", symmetric_tensor, work, halo, "of elements: inverse second moments of nodes"};
inline constexpr Field<double> pressure_guess{
    "pressure_guess", "Pa", scalar, work, halo, "of nodes: what the pressure's equation is applied to"};
inline constexpr Field<double> pressure_flux{
    "pressure_flux",
    "m s-1",
    vector,
    work,
    halo,
    "of elements: flux by the gradient of pressure_guess; of nodes: velocity on faces"};
}  // namespace talus::soil_field
