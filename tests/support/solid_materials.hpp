#pragma once
#include "physics/solid/equation_of_state.hpp"

/// Equations of state of the files in runs/materials, for tests that read no files.
namespace talus::test {

inline Tillotson basalt() {
    return {.reference_density = 2700,
            .a = 0.5,
            .b = 1.5,
            .A = 26.7e9,
            .B = 26.7e9,
            .E0 = 487e6,
            .E_iv = 4.72e6,
            .E_cv = 18.2e6,
            .alpha = 5,
            .beta = 5};
}
inline Tillotson aluminium() {
    return {.reference_density = 2700,
            .a = 0.5,
            .b = 1.63,
            .A = 75.2e9,
            .B = 65e9,
            .E0 = 5e6,
            .E_iv = 3e6,
            .E_cv = 13.9e6,
            .alpha = 5,
            .beta = 5};
}
inline Tillotson granite() {
    return {.reference_density = 2680,
            .a = 0.5,
            .b = 1.3,
            .A = 18e9,
            .B = 18e9,
            .E0 = 16e6,
            .E_iv = 3.5e6,
            .E_cv = 18e6,
            .alpha = 5,
            .beta = 5};
}
inline Tillotson iron() {
    return {.reference_density = 7800,
            .a = 0.5,
            .b = 1.5,
            .A = 128e9,
            .B = 105e9,
            .E0 = 9.5e6,
            .E_iv = 2.4e6,
            .E_cv = 8.67e6,
            .alpha = 5,
            .beta = 5};
}
inline Tillotson ice() {
    return {.reference_density = 917,
            .a = 0.3,
            .b = 0.1,
            .A = 9.47e9,
            .B = 9.47e9,
            .E0 = 10e6,
            .E_iv = 0.773e6,
            .E_cv = 3.04e6,
            .alpha = 10,
            .beta = 5};
}
inline Tillotson water() {
    return {.reference_density = 998,
            .a = 0.7,
            .b = 0.15,
            .A = 2.18e9,
            .B = 13.25e9,
            .E0 = 7e6,
            .E_iv = 0.419e6,
            .E_cv = 2.69e6,
            .alpha = 10,
            .beta = 5};
}

inline Tillotson nylon() {
    return {.reference_density = 1185,
            .a = 0.6,
            .b = 2,
            .A = 10.1e9,
            .B = 33.8e9,
            .E0 = 7e6,
            .E_iv = 2e6,
            .E_cv = 2.4e6,
            .alpha = 10,
            .beta = 5};
}

}  // namespace talus::test
