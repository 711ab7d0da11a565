#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "physics/dem/contact_list.hpp"
#include "physics/dem/grain_rows.hpp"
#include "physics/dem/law_table.hpp"
#include "physics/dem/wall_contacts.hpp"

namespace talus::dem {

/// What a contact that is pressed in by so much answers to small motions: Hertz's grows stiffer with it.
struct PressedContact {
    double stiffness, damping;                        ///< along the normal [N/m], [N s/m]
    double tangential_stiffness, tangential_damping;  ///< while it sticks; 0 without friction [N/m], [N s/m]
};

/// Of two materials; `effective_radius` and `effective_mass` as in ContactKinematics [m], [kg].
PressedContact pressed_contact(const AnyLawTable& laws, std::size_t first, std::size_t second, double overlap,
                               double effective_radius, double effective_mass);

/// E* of a law of Hertz or of Johnson, Kendall and Roberts [Pa]; nothing of a linear one.
std::optional<double> effective_modulus(const AnyLawTable& laws, std::size_t first, std::size_t second);

/// What presses one grain. Its stable step is that of the mode in which motion changes its sign at each step:
/// velocities predicted to the end of the step, v + dt a, make dashpots act twice, and tangential springs,
/// which advance by them, act twice as stiff, so that
///   4 = dt^2 sum k_n/m + 4 dt sum gamma_n/m                          along the line of its contacts,
///   4 = 5 dt^2 sum k_t s^2/m + 10 dt sum gamma_t s^2/m                as it turns, I = 2/5 m r^2,
/// s the arm of a contact over the radius. Exact for a grain between two opposite contacts with what does not
/// move; of more, and with grains that move too, the true one lies below: beyond this step grains that stick
/// shake for certain (tests/stability/grain_contacts.cpp).
class PressedGrain {
  public:
    void add(const PressedContact& contact, double arm_share);
    double stable_step(double mass) const;  ///< [s]; infinite if nothing presses

  private:
    PressedContact sum_{};
};

/// The grain that is pressed hardest, by its stable step.
struct HardestPressed {
    double stable_step = std::numeric_limits<double>::infinity();  ///< [s]
    double overlap_share = 0;                                      ///< its deepest, over its radius [1]
};

/// Among the first `own` grains, in the contacts of the last evaluation of which an overlap is above a
/// thousandth of the radius. Spheres of clumps count as spheres with the clump's mass.
HardestPressed find_hardest_pressed(const GrainRows& rows, std::size_t own, const AnyLawTable& laws,
                                    const ContactList& pairs, std::span<const Wall> walls,
                                    std::span<const WallTouch> touches);

}  // namespace talus::dem
