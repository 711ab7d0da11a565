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

}  // namespace talus::dem
