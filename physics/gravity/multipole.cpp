#include "physics/gravity/multipole.hpp"

namespace talus::gravity {

void Moments::add_part(const Moments& part) {
    std::array<double, 3> d;
    for (std::size_t a = 0; a < 3; ++a) d[a] = part.centre[a] - centre[a];
    for (std::size_t k = 0; k < pair_axes.size(); ++k) {
        const auto [a, b] = pair_axes[k];
        second[k] += part.second[k] + part.mass * d[a] * d[b];
    }
    const auto& s = part.second;
    for (std::size_t k = 0; k < triple_axes.size(); ++k) {
        const auto [a, b, c] = triple_axes[k];
        third[k] += part.third[k] + d[a] * s[pair_index(b, c)] + d[b] * s[pair_index(a, c)] +
                    d[c] * s[pair_index(a, b)] + part.mass * d[a] * d[b] * d[c];
    }
}

std::array<double, 6> quadrupole_of(const Moments& moments) {
    const auto& s = moments.second;
    const double third_of_trace = (s[0] + s[1] + s[2]) / 3;
    std::array<double, 6> q;
    for (std::size_t k = 0; k < 6; ++k) q[k] = 1.5 * (s[k] - (k < 3 ? third_of_trace : 0));
    return q;
}

std::array<double, 10> octupole_of(const Moments& moments) {
    const auto& t = moments.third;
    const std::array<double, 3> trace{t[0] + t[5] + t[7], t[3] + t[1] + t[8], t[4] + t[6] + t[2]};
    std::array<double, 10> o;
    for (std::size_t k = 0; k < triple_axes.size(); ++k) {
        const auto [a, b, c] = triple_axes[k];
        const double traces = (a == b ? trace[c] : 0) + (a == c ? trace[b] : 0) + (b == c ? trace[a] : 0);
        o[k] = 2.5 * (t[k] - traces / 5);
    }
    return o;
}

}  // namespace talus::gravity
