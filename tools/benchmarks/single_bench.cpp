// single_bench [SIDE [REPEATS]]: pair loops of Godunov SPH in double and in the trials' single precision.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "comm/environment.hpp"
#include "tests/support/sph_sample.hpp"
#include "tools/benchmarks/processor_time.hpp"

using namespace talus;

namespace {

using Values = std::vector<std::vector<double>>;

Values copy(const ParticleSet& particles, const Field<double>& field, int count) {
    Values values;
    for (int c = 0; c < count; ++c)
        values.emplace_back(particles.data(field, c), particles.data(field, c) + particles.size());
    return values;
}

struct Result {
    Values velocity_gradient, pressure_gradient, volume_gradient, acceleration, power;
};

Result results(const ParticleSet& p) {
    return {copy(p, field::velocity_gradient, 9), copy(p, field::pressure_gradient, 3),
            copy(p, field::volume_gradient, 3), copy(p, field::acceleration, 3),
            copy(p, field::specific_power, 1)};
}

/// Root mean square of the difference over that of the reference.
double error(const Values& found, const Values& reference) {
    double difference = 0, size = 0;
    for (std::size_t c = 0; c < found.size(); ++c)
        for (std::size_t k = 0; k < found[c].size(); ++k) {
            difference += std::pow(found[c][k] - reference[c][k], 2);
            size += std::pow(reference[c][k], 2);
        }
    return std::sqrt(difference / size);
}

/// |sum m a| / sum m |a|
double drift(const ParticleSet& p, const Values& a) {
    double sum2 = 0, size = 0;
    const double* m = p.data(field::mass);
    for (const auto& component : a) {
        double sum = 0;
        for (std::size_t k = 0; k < component.size(); ++k) {
            sum += m[k] * component[k];
            size += m[k] * std::abs(component[k]);
        }
        sum2 += sum * sum;
    }
    return std::sqrt(sum2) / size;
}

void put(ParticleSet& p, const Result& from) {
    const auto set = [&](const Field<double>& field, const Values& values) {
        for (std::size_t c = 0; c < values.size(); ++c)
            std::copy(values[c].begin(), values[c].end(), p.data(field, static_cast<int>(c)));
    };
    set(field::velocity_gradient, from.velocity_gradient);
    set(field::pressure_gradient, from.pressure_gradient);
    set(field::volume_gradient, from.volume_gradient);
}

}  // namespace

int main(int argc, char** argv) {
    const Environment environment(argc, argv);
    const auto argument = [&](int k, int otherwise) { return argc > k ? std::atoi(argv[k]) : otherwise; };
    test::SphSample sample({.side = argument(1, 37), .bodies = true});
    const std::vector<const char*> trials{"", "single", "wide", "cell"};
    struct Times {
        std::vector<double> gradients, forces;
    };
    std::vector<Times> times(trials.size());
    std::vector<Result> found(trials.size()), mixed(trials.size());
    for (int repeat = 0; repeat < argument(2, 10); ++repeat)
        for (std::size_t t = 0; t < trials.size(); ++t) {
            sample.settings.trial = trials[t];
            const double start = processor_time();
            sample.gradients();
            const double middle = processor_time();
            sample.forces();
            times[t].gradients.push_back(middle - start);
            times[t].forces.push_back(processor_time() - middle);
            if (repeat > 0) continue;
            found[t] = results(sample.particles);
            put(sample.particles, found[0]);
            sample.forces();
            mixed[t] = results(sample.particles);
        }
    const auto n = static_cast<double>(sample.particles.size());
    const auto median = [](std::vector<double> values) {
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                         values.end());
        return values[values.size() / 2];
    };
    const auto gain = [&](const std::vector<double>& of, const std::vector<double>& in_double) {
        std::vector<double> ratios;
        for (std::size_t k = 0; k < of.size(); ++k) ratios.push_back(in_double[k] / of[k]);
        return median(ratios);
    };
    fmt::print("{} particles\ntrial  gradients ns/particle (least) gain (median of pairs)  forces ... | errors: grad v, grad P, "
               "grad V | a, power (double gradients) | a, power (own gradients) | momentum, energy\n",
               n);
    for (std::size_t t = 0; t < trials.size(); ++t) {
        const auto least = [&](const std::vector<double>& v) {
            return *std::min_element(v.begin(), v.end()) / n * 1e9;
        };
        fmt::print("{:7} {:7.1f} {:5.2f} {:7.1f} {:5.2f} | {:.2e} {:.2e} {:.2e} | {:.2e} {:.2e} | {:.2e} {:.2e} | "
                   "{:.2e} {:.2e}\n",
                   trials[t], least(times[t].gradients), gain(times[t].gradients, times[0].gradients),
                   least(times[t].forces), gain(times[t].forces, times[0].forces),
                   error(found[t].velocity_gradient, found[0].velocity_gradient),
                   error(found[t].pressure_gradient, found[0].pressure_gradient),
                   error(found[t].volume_gradient, found[0].volume_gradient),
                   error(mixed[t].acceleration, found[0].acceleration), error(mixed[t].power, found[0].power),
                   error(found[t].acceleration, found[0].acceleration), error(found[t].power, found[0].power),
                   drift(sample.particles, mixed[t].acceleration), drift(sample.particles, mixed[t].power));
    }
}
