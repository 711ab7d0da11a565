#pragma once
#include <cstdint>
#include <vector>

#include "physics/dem/contact_list.hpp"
#include "physics/dem/grain_rows.hpp"
#include "physics/dem/law_table.hpp"

namespace talus::dem {

/// A contact and what acts in it, for a state as it is: histories are read, not advanced.
struct LoadedContact {
    std::uint32_t first;   ///< grain as stored
    std::uint32_t second;  ///< grain as stored, or wall
    std::uint32_t place;   ///< on the wall
    bool at_wall;
    double overlap;              ///< [m]
    double first_arm;            ///< from the first grain's centre to where they touch [m]
    double second_arm;           ///< the same of the second; 0 at a wall
    Vector3<> normal;            ///< unit vector to the first grain
    Vector3<> point;             ///< where they touch [m]
    ContactLoad<double> load{};  ///< on the first grain
};

/// All pairs of the list that touched at the last evaluation, those with copies included; `rows` hold
/// positions and velocities of grains and copies.
std::vector<LoadedContact> loaded_pairs(const GrainRows& rows, const AnyLawTable& laws,
                                        const ContactList& list);

}  // namespace talus::dem
