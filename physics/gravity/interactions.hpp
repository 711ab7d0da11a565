#pragma once
#include <cmath>
#include <cstdint>
#include <experimental/simd>
#include <vector>

#include "physics/gravity/multipole.hpp"
#include "physics/gravity/softening.hpp"

namespace talus::gravity {

/// The particles of a group as targets, relative to the group's middle, in units that keep all numbers near
/// one. Their count is padded to whole packs by repeating the last one.
template <class Scalar>
struct Targets {
    using Pack =
        std::experimental::simd<Scalar, std::experimental::simd_abi::deduce_t<Scalar, 32 / sizeof(Scalar)>>;

    std::size_t count = 0;  ///< padded
    std::array<std::vector<Scalar>, 3> position, acceleration;
    std::vector<Scalar> softening, potential;

    void resize(std::size_t size) {
        count = (size + Pack::size() - 1) / Pack::size() * Pack::size();
        for (std::size_t a = 0; a < 3; ++a) {
            position[a].resize(count);
            acceleration[a].assign(count, 0);
        }
        softening.resize(count);
        potential.assign(count, 0);
    }
    void pad(std::size_t size) {
        for (std::size_t k = size; k < count; ++k) {
            for (auto& component : position) component[k] = component[size - 1];
            softening[k] = softening[size - 1];
        }
    }
};

template <class Scalar>
struct PointSource {
    std::array<Scalar, 3> position;
    Scalar mass;
};
template <class Scalar>
struct SoftSource {
    std::array<Scalar, 3> position;
    Scalar mass, softening;
};
/// A node's multipoles about its centre of mass, trace-free (quadrupole_of, octupole_of).
template <class Scalar>
struct NodeSource {
    std::array<Scalar, 3> position;
    Scalar mass;
    std::array<Scalar, 6> quadrupole;
    std::array<Scalar, 10> octupole;
};

/// Calls add(position of a pack of targets, sums) for every pack; sums are acceleration and potential. Each
/// target's sum runs over the sources in their order, whatever the size of a pack.
template <class Scalar, class Add>
void for_each_pack(Targets<Scalar>& targets, Add&& add) {
    using Pack = typename Targets<Scalar>::Pack;
    constexpr auto unaligned = std::experimental::element_aligned;
    for (std::size_t t = 0; t < targets.count; t += Pack::size()) {
        std::array<Pack, 3> x;
        std::array<Pack, 4> sums;
        for (std::size_t a = 0; a < 3; ++a) {
            x[a].copy_from(targets.position[a].data() + t, unaligned);
            sums[a].copy_from(targets.acceleration[a].data() + t, unaligned);
        }
        sums[3].copy_from(targets.potential.data() + t, unaligned);
        add(x, sums, t);
        for (std::size_t a = 0; a < 3; ++a) sums[a].copy_to(targets.acceleration[a].data() + t, unaligned);
        sums[3].copy_to(targets.potential.data() + t, unaligned);
    }
}

/// From a source to a pack of targets.
template <class Pack>
struct Offset {
    Pack x, y, z, squared;
};
template <class Pack, class Scalar>
Offset<Pack> offset(const std::array<Pack, 3>& targets, const std::array<Scalar, 3>& source) {
    const Pack x = targets[0] - source[0], y = targets[1] - source[1], z = targets[2] - source[2];
    return {x, y, z, x * x + y * y + z * z};
}

/// Points beyond the softening of every target.
template <class Scalar>
void add_points(Targets<Scalar>& targets, const std::vector<PointSource<Scalar>>& sources) {
    using Pack = typename Targets<Scalar>::Pack;
    for_each_pack(targets, [&](const std::array<Pack, 3>& x, std::array<Pack, 4>& sums, std::size_t) {
        for (const PointSource<Scalar>& source : sources) {
            const auto [dx, dy, dz, r2] = offset(x, source.position);
            const Pack u = Scalar(1) / sqrt(r2);
            const Pack potential = source.mass * u, force = potential * (u * u);
            sums[0] -= force * dx;
            sums[1] -= force * dy;
            sums[2] -= force * dz;
            sums[3] -= potential;
        }
    });
}

/// Softened pairs, h being the mean of both; a source at a target's own place is left out.
template <class Scalar>
void add_softened(Targets<Scalar>& targets, const std::vector<SoftSource<Scalar>>& sources,
                  const Softening<Scalar>& softening) {
    using Pack = typename Targets<Scalar>::Pack;
    for_each_pack(targets, [&](const std::array<Pack, 3>& x, std::array<Pack, 4>& sums, std::size_t t) {
        const Pack h_target(targets.softening.data() + t, std::experimental::element_aligned);
        const Pack support = softening.support;
        for (const SoftSource<Scalar>& source : sources) {
            const auto [dx, dy, dz, r2] = offset(x, source.position);
            const Pack r = sqrt(r2), u = Scalar(1) / max(r, Pack(std::numeric_limits<Scalar>::min()));
            const Pack h = Scalar(0.5) * (h_target + source.softening);
            Pack force = u * u * u, potential = u;
            const auto inside = r < support * h;
            if (any_of(inside)) {
                const Pack inverse_h = Scalar(1) / h, q = min(r * inverse_h, support);
                where(inside, force) = softening.force(q) * (inverse_h * inverse_h * inverse_h);
                where(inside, potential) = softening.potential(q) * inverse_h;
                where(r2 == Scalar(0), potential) = Pack(Scalar(0));
            }
            force *= source.mass;
            sums[0] -= force * dx;
            sums[1] -= force * dy;
            sums[2] -= force * dz;
            sums[3] -= source.mass * potential;
        }
    });
}

/// Nodes, up to the multipole of `order` (1: mass, 2: quadrupole, 3: octupole).
template <int order, class Scalar>
void add_nodes(Targets<Scalar>& targets, const std::vector<NodeSource<Scalar>>& sources) {
    using Pack = typename Targets<Scalar>::Pack;
    for_each_pack(targets, [&](const std::array<Pack, 3>& x, std::array<Pack, 4>& sums, std::size_t) {
        for (const NodeSource<Scalar>& source : sources) {
            const auto [dx, dy, dz, r2] = offset(x, source.position);
            const Pack u = Scalar(1) / sqrt(r2), u2 = u * u;
            const Pack nx = dx * u, ny = dy * u, nz = dz * u;
            // potential = -u (mass + u^2 Qnn + u^3 Onnn)
            // acceleration = u^2 (u^2 2 Qn + u^3 3 Onn - n (mass + 5 u^2 Qnn + 7 u^3 Onnn))
            Pack inward = source.mass, depth = source.mass;
            Pack ax = Scalar(0), ay = Scalar(0), az = Scalar(0);
            if constexpr (order >= 2) {
                const auto& q = source.quadrupole;
                const Pack qx = q[0] * nx + q[3] * ny + q[4] * nz, qy = q[3] * nx + q[1] * ny + q[5] * nz,
                           qz = q[4] * nx + q[5] * ny + q[2] * nz;
                const Pack along = u2 * (qx * nx + qy * ny + qz * nz), twice = u2 + u2;
                depth += along;
                inward += Scalar(5) * along;
                ax = twice * qx;
                ay = twice * qy;
                az = twice * qz;
            }
            if constexpr (order >= 3) {
                const auto& o = source.octupole;
                const Pack xx = nx * nx, yy = ny * ny, zz = nz * nz, xy = Scalar(2) * nx * ny,
                           xz = Scalar(2) * nx * nz, yz = Scalar(2) * ny * nz;
                const Pack ox = o[0] * xx + o[5] * yy + o[7] * zz + o[3] * xy + o[4] * xz + o[9] * yz,
                           oy = o[3] * xx + o[1] * yy + o[8] * zz + o[5] * xy + o[9] * xz + o[6] * yz,
                           oz = o[4] * xx + o[6] * yy + o[2] * zz + o[9] * xy + o[7] * xz + o[8] * yz;
                const Pack u3 = u2 * u, along = u3 * (ox * nx + oy * ny + oz * nz), thrice = Scalar(3) * u3;
                depth += along;
                inward += Scalar(7) * along;
                ax += thrice * ox;
                ay += thrice * oy;
                az += thrice * oz;
            }
            sums[0] += u2 * (ax - inward * nx);
            sums[1] += u2 * (ay - inward * ny);
            sums[2] += u2 * (az - inward * nz);
            sums[3] -= u * depth;
        }
    });
}

}  // namespace talus::gravity
