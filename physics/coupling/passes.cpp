#include "physics/coupling/passes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "domain/coupling_fields.hpp"
#include "physics/dem/vectors.hpp"

namespace talus::coupling {

namespace {

namespace of = coupling_field;

/// Places of particles side by side, those near a cell or the images of one grain.
struct Places {
    std::vector<double> x, y, z;
    std::vector<std::uint32_t> index;

    void clear() {
        for (std::vector<double>* values : {&x, &y, &z}) values->clear();
        index.clear();
    }
    void append(const dem::Vector3<>& place, std::uint32_t i) {
        x.push_back(place.x);
        y.push_back(place.y);
        z.push_back(place.z);
        index.push_back(i);
    }
    std::size_t size() const { return index.size(); }
};

/// The box around the particles of a cell.
struct Bounds {
    std::array<double, 3> lower, upper;

    Bounds(const CellEntry& cell, const std::array<const double*, 3>& position) {
        for (std::size_t a = 0; a < 3; ++a) {
            const auto [least, greatest] =
                std::minmax_element(position[a] + cell.begin, position[a] + cell.end);
            lower[a] = *least;
            upper[a] = *greatest;
        }
    }
    double distance2(const dem::Vector3<>& p) const {
        double sum = 0;
        const std::array<double, 3> place{p.x, p.y, p.z};
        for (std::size_t a = 0; a < 3; ++a) {
            const double outside = std::max({lower[a] - place[a], place[a] - upper[a], 0.0});
            sum += outside * outside;
        }
        return sum;
    }
};

std::array<const double*, 3> positions(const ParticleSet& set) {
    return {set.data(field::position, 0), set.data(field::position, 1), set.data(field::position, 2)};
}

dem::Vector3<> place_of(const std::array<const double*, 3>& position, std::size_t i) {
    return {position[0][i], position[1][i], position[2][i]};
}

/// Places in reach of one centre, with their weights.
struct Reached {
    std::vector<double> r2, weight;
    std::vector<std::uint32_t> place;
    std::uint64_t pairs = 0;  ///< weighed so far

    /// Makes room for all places of a cell.
    void reserve(std::size_t count) {
        r2.resize(count);
        weight.resize(count);
        place.resize(count);
    }
};

/// Calls visit(k, weight) for the places that have a weight at `centre`. Those in reach are put side by side
/// first, without branches, so that weights are found several at a time.
template <class Weight, class Visit>
void for_each_weight(const Places& places, const dem::Vector3<>& centre, double radius, const Weight& weight,
                     Reached& reached, Visit&& visit) {
    reached.reserve(places.size());
    double *r2 = reached.r2.data(), *found = reached.weight.data();
    std::uint32_t* place = reached.place.data();
    for (std::size_t k = 0; k < places.size(); ++k) {
        const double x = centre.x - places.x[k], y = centre.y - places.y[k], z = centre.z - places.z[k];
        r2[k] = x * x + y * y + z * z;
    }
    const double radius2 = radius * radius;
    std::size_t count = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const double distance2 = r2[k];
        r2[count] = distance2;
        place[count] = static_cast<std::uint32_t>(k);
        count += distance2 < radius2 ? 1 : 0;
    }
    for (std::size_t n = 0; n < count; ++n) found[n] = weight(r2[n]);
    for (std::size_t n = 0; n < count; ++n) visit(place[n], found[n]);
    reached.pairs += count;
}

/// Calls with_weight(w) with the weight function that is asked for.
template <class Use>
void with_weight(const Spreading& spreading, Use&& use) {
    if (spreading.shape == Spreading::Shape::mollifier)
        use(Mollifier<3>(spreading.radius));
    else
        use(WendlandWeight(spreading.radius));
}

/// For each own particle k of one set: append(j, place) for each particle of the other that is within reach
/// of its cell, to be put among `near`, then visit(k, place).
template <class Append, class Visit>
void for_each_own(const ParticleSet& set, const CellTable& cells, const ParticleSet& others,
                  const CellTable& other_cells, int reach, double radius, Places& near, Append&& append,
                  Visit&& visit) {
    const auto own_position = positions(set), other_position = positions(others);
    std::vector<Run> runs;
    cells.for_each_own(Cells::all, [&](const CellEntry& cell, std::span<const Run>, std::size_t) {
        other_cells.list_runs(cell_of(cell.key), 3, reach, runs);
        const Bounds bounds(cell, own_position);
        near.clear();
        for (const Run& run : runs)
            for (std::uint32_t j = run.begin; j < run.end; ++j)
                if (const dem::Vector3<> place = place_of(other_position, j);
                    bounds.distance2(place) < radius * radius)
                    append(j, place);
        for (std::uint32_t k = cell.begin; k < cell.end; ++k) visit(k, place_of(own_position, k));
    });
}

/// For each own grain: begin(i), pair(a, weight) for each image and fluid particle in reach, end(i). Returns
/// the pairs. `with_walls`: those of walls, too.
template <class Begin, class Pair, class End>
std::uint64_t for_each_grain(const Mixture& m, const Spreading& spreading, bool with_walls, Begin&& begin,
                             Pair&& pair, End&& end) {
    const double* volume = m.fluid.data(of::quadrature_volume);
    Places near;
    Reached reached;
    std::vector<dem::Vector3<>> images;
    const auto append = [&](std::uint32_t a, const dem::Vector3<>& place) {
        if (with_walls || volume[a] > 0) near.append(place, a);
    };
    with_weight(spreading, [&](const auto& weight) {
        for_each_own(m.grains, m.grain_cells, m.fluid, m.fluid_cells, m.reach, spreading.radius, near, append,
                     [&](std::uint32_t i, const dem::Vector3<>& place) {
                         begin(i);
                         list_images(place, spreading.planes, spreading.radius, images);
                         for (const dem::Vector3<>& image : images)
                             for_each_weight(near, image, spreading.radius, weight, reached,
                                             [&](std::size_t k, double w) { pair(near.index[k], w); });
                         end(i);
                     });
    });
    return reached.pairs;
}

/// For each own fluid particle: begin(a), pair(i, weight) for each grain and image in reach if a counts,
/// end(a). Returns the pairs.
template <class Begin, class Pair, class End>
std::uint64_t for_each_fluid(const Mixture& m, const Spreading& spreading, Begin&& begin, Pair&& pair,
                             End&& end) {
    const double* volume = m.fluid.data(of::quadrature_volume);
    Places near;
    Reached reached;
    std::vector<dem::Vector3<>> images;
    const auto append = [&](std::uint32_t i, const dem::Vector3<>& place) {
        list_images(place, spreading.planes, spreading.radius, images);
        for (const dem::Vector3<>& image : images) near.append(image, i);
    };
    with_weight(spreading, [&](const auto& weight) {
        for_each_own(m.fluid, m.fluid_cells, m.grains, m.grain_cells, m.reach, spreading.radius, near, append,
                     [&](std::uint32_t a, const dem::Vector3<>& place) {
                         begin(a);
                         if (volume[a] > 0)
                             for_each_weight(near, place, spreading.radius, weight, reached,
                                             [&](std::size_t k, double w) { pair(near.index[k], w); });
                         end(a);
                     });
    });
    return reached.pairs;
}

}  // namespace

std::uint64_t sum_weights(const Mixture& mixture, const Spreading& spreading) {
    const double* volume = mixture.fluid.data(of::quadrature_volume);
    double *sums = mixture.grains.data(of::kernel_sum), *wet = mixture.grains.data(of::wet_share);
    Spreading itself = spreading;
    itself.planes.clear();
    double sum = 0, of_walls = 0;
    const std::uint64_t pairs = for_each_grain(
        mixture, itself, true, [&](std::uint32_t) { sum = of_walls = 0; },
        [&](std::uint32_t a, double weight) {
            (volume[a] > 0 ? sum : of_walls) += std::abs(volume[a]) * weight;
        },
        [&](std::uint32_t i) {
            sums[i] = sum;
            wet[i] = spreading.wet_share(of_walls < 1 ? sum / (1 - of_walls) : 0.0);
        });
    if (spreading.planes.empty()) return pairs;
    return pairs + for_each_grain(
                       mixture, spreading, false, [&](std::uint32_t) { sum = 0; },
                       [&](std::uint32_t a, double weight) { sum += volume[a] * weight; },
                       [&](std::uint32_t i) {
                           sums[i] = sum;
                           wet[i] = std::max(wet[i], spreading.wet_share(sum));
                       });
}

std::uint64_t spread_volume(const Mixture& mixture, const Spreading& spreading, VolumeFraction kind,
                            const Field<double>& fraction) {
    const double *radius = mixture.grains.data(field::radius), *sums = mixture.grains.data(of::kernel_sum),
                 *wet = mixture.grains.data(of::wet_share);
    Spreading used = spreading;
    if (kind == VolumeFraction::raw) used.planes.clear();
    std::vector<double> spread(mixture.grains.size_with_halo());  // of each weight
    for (std::size_t i = 0; i < spread.size(); ++i) {
        const double ball = 4.0 / 3 * std::numbers::pi * radius[i] * radius[i] * radius[i];
        spread[i] = kind == VolumeFraction::raw ? ball : sums[i] > 0 ? ball * wet[i] / sums[i] : 0.0;
    }
    double *to = mixture.fluid.data(fraction), sum = 0;
    return for_each_fluid(
        mixture, used, [&](std::uint32_t) { sum = 0; },
        [&](std::uint32_t i, double weight) { sum += spread[i] * weight; },
        [&](std::uint32_t a) { to[a] = sum; });
}

namespace {

/// Moments of velocities over places, for the gradient of the plane that fits them best.
struct LinearFit {
    double sum = 0;
    Eigen::Vector3d place = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
    Eigen::Matrix3d places = Eigen::Matrix3d::Zero(), mixed = Eigen::Matrix3d::Zero();

    void add(double weight, const Eigen::Vector3d& x, const Eigen::Vector3d& u) {
        sum += weight;
        place += weight * x;
        velocity += weight * u;
        places += weight * x * x.transpose();
        mixed += weight * u * x.transpose();
    }
    /// Curl of the fit; 0 where places do not span space.
    dem::Vector3<> curl(double scale) const {
        constexpr double least = 1e-6;
        if (sum == 0) return {};
        const Eigen::Matrix3d spread = places - place * place.transpose() / sum;
        if (std::abs(spread.determinant()) < least * std::pow(sum * scale * scale, 3)) return {};
        const Eigen::Matrix3d g = (mixed - velocity * place.transpose() / sum) * spread.inverse();
        return {g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1)};
    }
};

Eigen::Vector3d eigen(const dem::Vector3<>& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::uint64_t gather(const Mixture& mixture, const Spreading& spreading, const Field<double>& shared_fraction,
                     bool vorticity, std::span<Gathered> gathered) {
    const ParticleSet &fluid = std::as_const(mixture.fluid), &grains = std::as_const(mixture.grains);
    const double *volume = fluid.data(of::quadrature_volume), *mass = fluid.data(field::mass);
    const double *solid = fluid.data(of::solid_fraction), *shared = fluid.data(shared_fraction);
    const dem::Vectors velocity(fluid, field::predicted_velocity), pair(fluid, of::pair_acceleration),
        reaction(fluid, of::grain_acceleration), place(fluid, field::position),
        centre(grains, field::position);
    const double* sums = grains.data(of::kernel_sum);
    Gathered now{};
    LinearFit fit;
    std::uint32_t grain = 0;
    return for_each_grain(
        mixture, spreading, false,
        [&](std::uint32_t i) {
            now = {};
            fit = {};
            grain = i;
        },
        [&](std::uint32_t a, double weight) {
            const double share = volume[a] * weight, density = mass[a] / volume[a];
            now.velocity += share * velocity[a];
            now.force_density += (share * density) * pair[a];
            now.acceleration += share * pair[a];
            now.reaction += share * reaction[a];
            now.solid_fraction += share * solid[a];
            now.density += share * density;
            now.crowding += share * (shared[a] / density);
            if (vorticity) fit.add(share, eigen(place[a] - centre[grain]), eigen(velocity[a]));
        },
        [&](std::uint32_t i) {
            const double inverse = sums[i] > 0 ? 1 / sums[i] : 0.0;
            gathered[i] = {.velocity = inverse * now.velocity,
                           .vorticity = fit.curl(spreading.radius),
                           .force_density = inverse * now.force_density,
                           .acceleration = inverse * now.acceleration,
                           .reaction = inverse * now.reaction,
                           .solid_fraction = inverse * now.solid_fraction,
                           .density = inverse * now.density,
                           .crowding = inverse * now.crowding};
        });
}

std::uint64_t spread_force(const Mixture& mixture, const Spreading& spreading) {
    const ParticleSet& grains = std::as_const(mixture.grains);
    const double* sums = grains.data(of::kernel_sum);
    const dem::Vectors force(grains, of::exchanged_force);
    const double *volume = mixture.fluid.data(of::quadrature_volume), *mass = mixture.fluid.data(field::mass);
    const dem::Vectors to(mixture.fluid, of::grain_acceleration);
    dem::Vector3<> sum;
    return for_each_fluid(
        mixture, spreading, [&](std::uint32_t) { sum = {}; },
        [&](std::uint32_t i, double weight) { sum += (weight / sums[i]) * force[i]; },
        [&](std::uint32_t a) { to.put(a, -(volume[a] / mass[a]) * sum); });
}

}  // namespace talus::coupling
