#include "physics/coupling/history.hpp"

#include <cmath>
#include <numbers>

namespace talus::coupling {

namespace {

/// (1 - exp(-z))/z: the mean of exp(-t) from 0 to z.
double mean_of_decay(double z) { return z > 0 ? -std::expm1(-z) / z : 1.0; }

}  // namespace

HistoryKernel::HistoryKernel(double shortest, double longest) : shortest_(shortest), longest_(longest) {
    // The rule errs by 2 |Gamma(1/2 + 2 pi i/h)|/Gamma(1/2) = 2/sqrt(cosh(2 pi^2/h)), 5e-4, and the ends by
    // less: rates above 3/shortest have erfc(sqrt(3)), a fourteenth, of the kernel, of which the rule keeps
    // nearly half in its last term, and those below half of 1/longest are one term.
    constexpr double step = 1.15, fastest = 3, slowest = 0.5;
    const double ratio = std::exp(-step);
    double rate = fastest / shortest;
    const auto weight = [&] { return step * std::sqrt(rate / std::numbers::pi); };
    for (; rate > slowest / longest * ratio; rate *= ratio) terms_.push_back({rate, weight()});
    // Sums of the weights, and of weights times rates, of all terms from here on.
    const double all = weight() / (1 - std::sqrt(ratio)),
                 rates = weight() * rate / (1 - std::sqrt(ratio) * ratio);
    terms_.push_back({rates / all, all});
}

double HistoryKernel::operator()(double time) const {
    double sum = 0;
    for (const Term& term : terms_) sum += term.weight * std::exp(-term.rate * time);
    return sum;
}

HistoryKernel::Passage HistoryKernel::between(double last, double next) const {
    Passage passage{{}, 2 / std::sqrt(next)};
    if (last > 0)
        passage.recent = 4 / (3 * last * next) *
                         (std::pow(last + next, 1.5) - last * std::sqrt(last) - next * std::sqrt(next));
    for (const Term& term : terms_)
        passage.memories.push_back({std::exp(-term.rate * last), mean_of_decay(term.rate * last),
                                    term.weight * mean_of_decay(term.rate * next)});
    return passage;
}

double HistoryKernel::added(double step) { return 4.0 / 3 * std::sqrt(step); }

}  // namespace talus::coupling
