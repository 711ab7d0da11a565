#pragma once
#include <cstdint>

#include "domain/fields.hpp"

namespace talus::gravity {

/// Constant of gravitation, CODATA 2018 [m3 kg-1 s-2].
inline constexpr double newton_constant = 6.67430e-11;

/// When the particles of a node of the tree may act as one.
enum class Opening : std::uint8_t {
    geometric,  ///< radius of the node below theta times its distance
    relative    ///< estimated error below accuracy times the last acceleration
};

/// Arithmetic of the interactions: positions are taken relative to the group of targets before rounding.
enum class Precision : std::uint8_t { single_precision, double_precision };

/// Choices and parameters of self-gravity; what a scene's [gravity] table says.
struct Settings {
    double constant = newton_constant;  ///< of gravitation [m3 kg-1 s-2]
    Opening opening = Opening::geometric;
    double theta = 0.65;          ///< for Opening::geometric, and for the first step of Opening::relative
    double accuracy = 1e-2;       ///< for Opening::relative [1]
    int order = 3;                ///< highest multipole: 1 mass alone, 2 quadrupole, 3 octupole
    bool direct = false;          ///< every pair, for reference: work grows as the square of the particles
    double softening_length = 0;  ///< in place of every particle's own [m]; 0: their own
    /// A particle's own softening length is this field of it times this factor.
    const Field<double>* softening_field = &field::smoothing_length;
    double softening_factor = 1;
    const Field<double>* mass_field = &field::mass;  ///< by which particles attract and are attracted [kg]
    double step_factor = 0.25;                       ///< C in dt = C sqrt(h/|g|)
    Precision precision = Precision::single_precision;
    int leaf_size = 32;   ///< most particles in a leaf of the tree
    int group_size = 64;  ///< most particles that share a list of interactions
};

}  // namespace talus::gravity
