// pass_bench [SIDE [REPEATS [CELLS_PER_RADIUS]]]: times the pair loops of Godunov SPH with strength in 3D on
// a jittered cube of SIDE^3 particles, and the parts of them. The least time of the repeats is shown.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "comm/environment.hpp"
#include "domain/partners.hpp"
#include "physics/sph/pass_support.hpp"
#include "tests/support/sph_sample.hpp"
#include "tools/benchmarks/processor_time.hpp"

using namespace talus;

namespace {

double seconds(auto&& work) {
    const double start = processor_time();
    work();
    return processor_time() - start;
}

/// The search alone, within `range` smoothing lengths; returns the number of pairs.
std::uint64_t search(const test::SphSample& sample, double range) {
    const auto position = sph::components<3>(sample.particles, field::position);
    Partners<3> partners(position, sample.particles.data(field::smoothing_length), range);
    std::uint64_t pairs = 0;
    sample.decomposition.table().for_each_own(
        Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
            partners.enter(cell, runs);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
                partners.find(i, range);
                pairs += partners.count();
            }
        });
    return pairs;
}

}  // namespace

int main(int argc, char** argv) {
    const Environment environment(argc, argv);
    const auto argument = [&](int k, int otherwise) { return argc > k ? std::atoi(argv[k]) : otherwise; };
    test::SphSample sample({.side = argument(1, 37), .bodies = true}, argument(3, 1));
    const auto n = static_cast<double>(sample.particles.size());

    struct Part {
        std::string_view name;
        double least = 1e300;
        std::uint64_t pairs = 0;
    } find_near{"search 2 h"}, find_far{"search 2 sqrt2 h"}, gradients{"gradient pass"}, forces{"force pass"};
    const auto time = [](Part& part, auto&& work) {
        part.least = std::min(part.least, seconds([&] { part.pairs = work(); }));
    };
    for (int repeat = 0; repeat < argument(2, 20); ++repeat) {
        time(find_near, [&] { return search(sample, sample.settings.kernel_support()); });
        time(find_far, [&] { return search(sample, sample.settings.force_support()); });
        time(gradients, [&] {
            sample.gradients();
            return find_near.pairs;
        });
        time(forces, [&] { return sample.forces().pairs; });
    }
    fmt::print("{} particles\n{:18} {:>14} {:>12} {:>14}\n", sample.particles.size(), "part", "ns/particle",
               "ns/pair", "pairs/particle");
    for (const Part& part : {find_near, find_far, gradients, forces})
        fmt::print("{:18} {:14.1f} {:12.2f} {:14.1f}\n", part.name, part.least / n * 1e9,
                   part.least / static_cast<double>(part.pairs) * 1e9, static_cast<double>(part.pairs) / n);
    fmt::print("gradient and force pass: {:.4g} particle-steps/s per core\n",
               n / (gradients.least + forces.least));
}
