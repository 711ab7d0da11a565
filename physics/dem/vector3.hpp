#pragma once
#include <cmath>

#include "domain/lanes.hpp"

namespace talus::dem {

/// Vector of space, of doubles or of lanes.
template <class Real = double>
struct Vector3 {
    Real x{}, y{}, z{};

    friend Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
    friend Vector3 operator*(const Real& s, const Vector3& a) { return {s * a.x, s * a.y, s * a.z}; }
    Vector3& operator+=(const Vector3& b) { return *this = *this + b; }
    friend bool operator==(const Vector3&, const Vector3&) = default;
};

template <class Real>
Real dot(const Vector3<Real>& a, const Vector3<Real>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
Vector3<Real> cross(const Vector3<Real>& a, const Vector3<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
Real norm(const Vector3<Real>& a) {
    using std::sqrt;
    return sqrt(dot(a, a));
}

/// The part of `a` at right angles to the unit vector `n`.
template <class Real>
Vector3<Real> tangential_part(const Vector3<Real>& a, const Vector3<Real>& n) {
    return a - dot(a, n) * n;
}

/// `a` turned by the small `angle` [rad] about the unit vector `n`, then laid into the plane across it
/// without a change of its length: what a vector of an earlier plane has become when `n` has moved a little.
template <class Real>
Vector3<Real> turned_into_plane(const Vector3<Real>& a, const Vector3<Real>& n, const Real& angle) {
    using std::max, std::min;
    const Vector3<Real> turned = tangential_part(a + angle * cross(n, a), n);
    const Real before = dot(a, a), after = dot(turned, turned);
    // sqrt(before/after) = sqrt(1 + loss), of second order in the angles: to 1e-13 for 0.01 rad.
    const Real loss = min(before / max(after, Real(1e-300)) - 1, Real(1.0));
    return (1 + 0.5 * loss * (1 - 0.25 * loss)) * turned;
}

}  // namespace talus::dem
