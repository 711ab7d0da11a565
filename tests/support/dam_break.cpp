#include "tests/support/dam_break.hpp"

#include <cmath>

namespace talus::reference {

/// The middle depth where the velocity behind the rarefaction, 2 (c_0 - c), is that behind the bore,
/// (h - h_r) sqrt(g (h + h_r)/(2 h h_r)): Newton's steps from above, where the difference is convex.
DamBreak::DamBreak(double upstream, double downstream, double gravity)
    : upstream_(upstream), downstream_(downstream), gravity_(gravity) {
    if (downstream == 0) return;
    const double c0 = std::sqrt(gravity * upstream);
    const auto over = [&](double h) {
        return (h - downstream) * std::sqrt(gravity * (h + downstream) / (2 * h * downstream)) -
               2 * (c0 - std::sqrt(gravity * h));
    };
    double h = upstream;
    for (int round = 0; round < 100; ++round) {
        const double width = 1e-7 * h;
        const double next = h - over(h) / ((over(h + width) - over(h - width)) / (2 * width));
        if (std::abs(next - h) < 1e-14 * h) break;
        h = next;
    }
    middle_ = {h, 2 * (c0 - std::sqrt(gravity * h))};
    bore_speed_ = h * middle_.velocity / (h - downstream);
}

ShallowState DamBreak::at(double x, double time) const {
    const double c0 = std::sqrt(gravity_ * upstream_), xi = x / time;
    if (xi < -c0) return {upstream_, 0};
    if (downstream_ > 0 && xi > middle_.velocity - std::sqrt(gravity_ * middle_.depth))
        return xi < bore_speed_ ? middle_ : ShallowState{downstream_, 0};
    if (xi > 2 * c0) return {0, 0};
    return {(2 * c0 - xi) * (2 * c0 - xi) / (9 * gravity_), 2.0 / 3 * (xi + c0)};
}

ShallowState InclinedDamBreak::at(double s, double time) const {
    const double c0 = std::sqrt(gravity * depth), fallen = 0.5 * acceleration * time * time;
    if (s <= -c0 * time + fallen) return {depth, acceleration * time};
    if (s > 2 * c0 * time + fallen) return {0, 0};
    const double root = 2 * c0 - s / time + 0.5 * acceleration * time;
    return {root * root / (9 * gravity), 2.0 / 3 * (s / time + c0 + acceleration * time)};
}

}  // namespace talus::reference
