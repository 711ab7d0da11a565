#include "physics/dem/shear.hpp"

#include <algorithm>
#include <cmath>

#include "domain/grain_fields.hpp"

namespace talus::dem {

double shear_flow(const Box& box, double y) {
    if (box.shear_rate == 0) return 0;
    const double length = box.length(1), above = y - box.lower[1];
    return box.shear_rate * (above - length * std::floor(above / length) - 0.5 * length);
}

Shear::Shear(const Box& box, const PeriodicPlaces& places, double time_step, double largest_radius)
    : lower_(box.lower[1]),
      length_x_(box.length(0)),
      length_y_(box.length(1)),
      time_step_(time_step),
      advance_(places(0, box.shear_rate * box.length(1) * time_step)) {
    constexpr int bits = 50;
    const double fastest = std::max(largest_radius, std::abs(advance_)) / time_step;
    int exponent = 0;
    std::frexp(fastest, &exponent);
    rounding_ = std::ldexp(1.5, exponent + 52 - bits);
    velocity_ = (advance_ / time_step + rounding_) - rounding_;
}

double Shear::turns_of(double y) const { return std::floor((y - lower_) / length_y_); }

/// The offset is step * advance modulo the length, of whole places throughout: exact, by doubling.
void Shear::go_to(std::uint64_t step) {
    step_ = step;
    const auto within = [this](double x) { return x >= length_x_ ? x - length_x_ : x; };
    double power = std::fmod(advance_, length_x_);
    if (power < 0) power += length_x_;
    offset_ = 0;
    for (std::uint64_t rest = step; rest > 0; rest >>= 1) {
        if (rest & 1) offset_ = within(offset_ + power);
        power = within(power + power);
    }
}

void Shear::drift(ParticleSet& grains, std::span<const ForceSum> rates, double time_step,
                  const PeriodicPlaces& places) {
    const double* y = grains.data(field::position, 1);
    std::vector<double> before(grains.size());
    for (std::size_t i = 0; i < grains.size(); ++i) before[i] = turns_of(y[i]);
    dem::drift(grains, rates, time_step, places);
    double *x = grains.data(field::position, 0), *v = grains.data(field::velocity, 0);
    for (std::size_t i = 0; i < grains.size(); ++i) {
        x[i] += before[i] * advance_;
        v[i] -= (turns_of(y[i]) - before[i]) * velocity_;
    }
    go_to(step_ + 1);
}

void Shear::place_velocities(const ParticleSet& grains, GrainRows& rows) const {
    const double* y = grains.data(field::position, 1);
    double* v = rows.values().data() + GrainRows::velocity_at;
    for (std::size_t i = 0; i < grains.size(); ++i, v += GrainRows::width) *v = placed(*v, turns_of(y[i]));
}

void Shear::bring_back(ParticleSet& grains) const {
    double *x = grains.data(field::position, 0), *y = grains.data(field::position, 1);
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const double turns = turns_of(y[i]);
        x[i] -= turns * offset_;
        y[i] -= turns * length_y_;
    }
}

void Shear::note_copies(const ParticleSet& grains, std::span<const std::uint8_t> needed) {
    const double* y = grains.data(field::position, 1);
    copies_.clear();
    for (std::size_t i = grains.size(); i < grains.size_with_halo(); ++i)
        if (const double turns = turns_of(y[i]); turns != 0 && needed[i - grains.size()])
            copies_.push_back({i, turns});
    listed_step_ = step_;
}

void Shear::move_copies(GrainRows& rows) const {
    const double advanced = static_cast<double>(step_ - listed_step_) * advance_;
    for (const Copy& copy : copies_) {
        double* row = rows.values().data() + copy.row * GrainRows::width;
        row[0] += copy.turns * advanced;
        row[GrainRows::velocity_at] += copy.turns * velocity_;
    }
}

/// Two grains at r at the list that moved with the flow would now be at A r, A = 1 + g e_x e_y with the shear
/// g since then, |A r| >= |r| / (1 + |g|): nearer by at most |r| |g| / (1 + |g|). What each moved besides
/// adds.
double Shear::moved2(const ParticleSet& grains, std::span<const ForceSum> rates,
                     const std::array<StaggeredVector<double>, 3>& start, double listed) const {
    const double sheared = static_cast<double>(step_ + 1 - listed_step_) * advance_ / length_y_;
    double most2 = 0;
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const Rates of_grain = rates_in(rates[i]);
        double distance2 = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            const int axis = static_cast<int>(a);
            double moved = grains.data(field::position, axis)[i] - start[a][i] +
                           time_step_ * (grains.data(field::velocity, axis)[i] +
                                         0.5 * time_step_ * of_grain.acceleration[a]);
            if (axis == 0)
                moved += turns_of(grains.data(field::position, 1)[i]) * advance_ -
                         sheared * (start[1][i] - lower_ - 0.5 * length_y_);
            distance2 += moved * moved;
        }
        most2 = std::max(most2, distance2);
    }
    const double by_flow = 0.5 * listed * std::abs(sheared) / (1 + std::abs(sheared));
    return (std::sqrt(most2) + by_flow) * (std::sqrt(most2) + by_flow);
}

}  // namespace talus::dem
