#pragma once
#include "physics/sph/godunov_pass.hpp"

namespace talus::sph {

template <int D, class Options>
void run_with(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
              double time_step, PassCount& count) {
    GodunovPass<D, Options> pass(particles, settings, time_step);
    table.for_each_own(which, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t k) {
        const std::uint64_t pairs = pass.visit(cell, runs);
        count.pairs += pairs;
        count.work_of_cell[k] = static_cast<double>(pairs);
    });
}

template <int D>
void run_godunov(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                 double time_step, PassCount& count) {
    const bool strength = particles.has(field::predicted_stress), bodies = settings.several_bodies;
    const auto run = [&]<class Options>(Options) {
        run_with<D, Options>(particles, table, which, settings, time_step, count);
    };
    const auto with_h = [&]<bool variable>(std::bool_constant<variable>) {
        if (settings.uses(
                Interpolation::quintic)) {  // bodies and stress are rare here: one instantiation serves all
            if (strength) return run(GodunovOptions<true, variable, true, false>{});
            return run(GodunovOptions<false, variable, true, false>{});
        }
        if (strength && bodies) return run(GodunovOptions<true, variable, false, true>{});
        if (strength) return run(GodunovOptions<true, variable, false, false>{});
        return run(GodunovOptions<false, variable, false, false>{});
    };
    if (!settings.uniform_smoothing_length)
        with_h(std::true_type{});
    else
        with_h(std::false_type{});
}

}  // namespace talus::sph
