#pragma once
#include <array>
#include <stdexcept>
#include <utility>

#include "domain/particles.hpp"
#include "domain/partners.hpp"
#include "physics/sph/kernels.hpp"
#include "physics/sph/passes.hpp"
#include "physics/sph/settings.hpp"

namespace talus::sph {

/// Pointers to all components of a field.
template <int N, class T>
std::array<const T*, N> components(const ParticleSet& particles, const Field<T>& field) {
    std::array<const T*, N> pointers;
    for (int c = 0; c < N; ++c) pointers[static_cast<std::size_t>(c)] = particles.data(field, c);
    return pointers;
}
template <int N, class T>
std::array<T*, N> components_to_write(ParticleSet& particles, const Field<T>& field) {
    std::array<T*, N> pointers;
    for (int c = 0; c < N; ++c) pointers[static_cast<std::size_t>(c)] = particles.data(field, c);
    return pointers;
}

/// Calls f(kernel) with the kernel object that the settings name.
template <int D, class F>
void with_kernel(const Settings& settings, F&& f) {
    switch (settings.kernel) {
        case KernelKind::gaussian:
            return f(Gaussian<D>(settings.cutoff));
        case KernelKind::cubic_spline:
            return f(CubicSpline<D>{});
        case KernelKind::wendland_c2:
            return f(WendlandC2<D>{});
        case KernelKind::wendland_c4:
            return f(WendlandC4<D>{});
        case KernelKind::wendland_c6:
            return f(WendlandC6<D>{});
    }
}

/// Calls f(std::integral_constant<int, D>) for the set's dimension.
template <class F>
void with_dimension(const ParticleSet& particles, F&& f) {
    switch (particles.dimension()) {
        case 1:
            return f(std::integral_constant<int, 1>{});
        case 2:
            return f(std::integral_constant<int, 2>{});
        default:
            return f(std::integral_constant<int, 3>{});
    }
}

/// Lets a pass visit the selected own cells.
template <class Pass>
void visit_cells(Pass&& pass, const CellTable& table, Cells which) {
    table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        pass.visit(cell, runs);
    });
}

/// The same, and counts its pairs.
template <class Pass>
void visit_cells(Pass&& pass, const CellTable& table, Cells which, PassCount& count) {
    table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t k) {
        const std::uint64_t pairs = pass.visit(cell, runs);
        count.pairs += pairs;
        count.work_of_cell[k] = static_cast<double>(pairs);
    });
}

}  // namespace talus::sph
