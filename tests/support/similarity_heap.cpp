#include "tests/support/similarity_heap.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace talus::reference {

SimilarityHeap::SimilarityHeap(const Plane& plane, const Heap& heap, double time) {
    constexpr int steps = 1000;
    const double push = 2 * plane.gravity * std::cos(plane.angle) * heap.depth / (heap.radius * heap.radius);
    const double friction = plane.gravity * std::cos(plane.angle) * std::tan(plane.friction_angle);
    const double acceleration = plane.gravity * std::sin(plane.angle) - friction;
    using State = std::array<double, 4>;  // g, g', f, f'
    const auto rate = [&](const State& s, double t) -> State {
        const double stretch = push / (s[0] * s[0] * s[2]);
        if (heap.dimension == 1) return {s[1], stretch, 0, 0};
        const double widen = push / (s[0] * s[2] * s[2]);
        // At first f' = f'' t, of which friction takes a share.
        const double held =
            t > 0 ? friction * s[3] / (acceleration * t) : widen * friction / (acceleration + friction);
        return {s[1], stretch, s[3], widen - held};
    };
    State state{1, 0, 1, 0};
    const double dt = time / steps;
    const auto ahead = [](const State& from, const State& slope, double by) {
        State to = from;
        for (std::size_t k = 0; k < 4; ++k) to[k] += by * slope[k];
        return to;
    };
    for (int k = 0; k < steps; ++k) {
        const double t = k * dt;
        const State a = rate(state, t), b = rate(ahead(state, a, dt / 2), t + dt / 2),
                    c = rate(ahead(state, b, dt / 2), t + dt / 2), d = rate(ahead(state, c, dt), t + dt);
        for (std::size_t n = 0; n < 4; ++n) state[n] += dt / 6 * (a[n] + 2 * b[n] + 2 * c[n] + d[n]);
    }
    middle_depth_ = heap.depth / (state[0] * state[2]);
    centre_ = 0.5 * acceleration * time * time;
    speed_ = acceleration * time;
    length_ = heap.radius * state[0];
    width_ = heap.radius * state[2];
    stretching_ = state[1] / state[0];
}

double SimilarityHeap::depth(double s, double y) const {
    const double along = (s - centre_) / length_, across = y / width_;
    return middle_depth_ * std::max(0.0, 1 - along * along - across * across);
}

}  // namespace talus::reference
