// gravity_bench [PARTICLES [CLOUD [LEAF_SIZE [GROUP_SIZE]]]]: error against the direct sum, interactions and
// time of the tree, for orders, opening angles and precisions. CLOUD: sphere, pair or clumps.
#include <fmt/format.h>

#include <cstdlib>

#include "comm/environment.hpp"
#include "tests/support/gravity_cloud.hpp"
#include "tools/benchmarks/processor_time.hpp"

using namespace talus;

namespace {

void measure(test::GravityCloud& cloud, const gravity::Settings& settings,
             const test::GravityCloud::Forces& exact) {
    gravity::Counts counts;
    double least = 1e300;
    for (int repeat = 0; repeat < 3; ++repeat) {
        const double start = processor_time();
        counts = cloud.evaluate(settings);
        least = std::min(least, processor_time() - start);
    }
    const auto n = static_cast<double>(cloud.particles.size());
    const test::GravityError error = test::error_of(cloud.forces(), exact);
    const bool relative = settings.opening == gravity::Opening::relative;
    fmt::print("{} {:>5} {:>9} {:>8g} {:10.2e} {:10.2e} {:10.2e} {:8.1f} {:8.1f} {:8.1f} {:8.2f} {:8.1f}\n",
               settings.order, settings.precision == gravity::Precision::single_precision ? 32 : 64,
               relative ? "relative" : "geometric", relative ? settings.accuracy : settings.theta, error.rms,
               error.greatest, error.drift, static_cast<double>(counts.points) / n,
               static_cast<double>(counts.softened) / n, static_cast<double>(counts.nodes) / n,
               least / static_cast<double>(counts.interactions()) * 1e9, least / n * 1e9);
}

}  // namespace

int main(int argc, char** argv) {
    const Environment environment(argc, argv);
    const std::string kind = argc > 2 ? argv[2] : "sphere";
    const Communicator comm = world();
    test::GravityCloud cloud(comm, kind, static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 30000));
    gravity::Settings settings;
    if (argc > 3) settings.leaf_size = std::atoi(argv[3]);
    if (argc > 4) settings.group_size = std::atoi(argv[4]);
    settings.direct = true;
    cloud.evaluate(settings);
    const test::GravityCloud::Forces exact = cloud.forces();
    settings.direct = false;
    fmt::print("{} particles, {}; interactions per particle\n", cloud.particles.size(), kind);
    fmt::print("{} {:>5} {:>9} {:>8} {:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "l", "bits",
               "opening", "knob", "rms", "greatest", "drift", "points", "softened", "nodes", "ns each",
               "ns/part");
    for (const auto precision : {gravity::Precision::single_precision, gravity::Precision::double_precision})
        for (const int order : {1, 2, 3}) {
            settings.precision = precision;
            settings.order = order;
            settings.opening = gravity::Opening::geometric;
            for (const double theta : {0.4, 0.5, 0.6, 0.65, 0.7, 0.8, 0.9}) {
                settings.theta = theta;
                measure(cloud, settings, exact);
            }
            settings.opening = gravity::Opening::relative;
            for (const double accuracy : {1e-5, 1e-4, 1e-3, 1e-2}) {
                settings.accuracy = accuracy;
                measure(cloud, settings, exact);
            }
        }
}
