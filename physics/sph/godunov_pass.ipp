#pragma once
#include "physics/sph/godunov_pass.hpp"

namespace talus::sph {

template <int D, class Options>
void run_with(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
              PassCount& count) {
    visit_cells(GodunovPass<D, Options>(particles, table, which, settings), table, which, count);
}

template <int D>
void run_godunov(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                 PassCount& count) {
    const bool strength = particles.has(field::predicted_stress);
    const auto run = [&]<class Options>(Options) {
        run_with<D, Options>(particles, table, which, settings, count);
    };
    const auto with_h = [&]<bool variable>(std::bool_constant<variable>) {
        // Where bodies change little in the cost, one instantiation serves one or several.
        if (settings.uses(Interpolation::quintic)) {
            if (strength) return run(GodunovOptions<true, variable, true, true>{});
            return run(GodunovOptions<false, variable, true, true>{});
        }
        if (!strength) return run(GodunovOptions<false, variable, false, true>{});
        if (settings.several_bodies) return run(GodunovOptions<true, variable, false, true>{});
        return run(GodunovOptions<true, variable, false, false>{});
    };
    if (!settings.uniform_smoothing_length)
        with_h(std::true_type{});
    else
        with_h(std::false_type{});
}

}  // namespace talus::sph
