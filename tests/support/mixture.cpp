#include "tests/support/mixture.hpp"

#include <cmath>
#include <numbers>

#include "comm/exact_sum.hpp"
#include "domain/random.hpp"

namespace talus::test {

namespace {

namespace of = coupling_field;

void place_fluid(const MixtureSample::Choice& choice, const Communicator& comm, ParticleSet& fluid) {
    const RandomStream random{.seed = 5};
    std::array<int, 3> count{};
    for (std::size_t a = 0; a < 3; ++a)
        count[a] =
            static_cast<int>(std::lround((choice.box.upper[a] - choice.box.lower[a]) / choice.spacing));
    std::uint64_t id = 0;
    for (int z = 0; z < count[2]; ++z)
        for (int y = 0; y < count[1]; ++y)
            for (int x = 0; x < count[0]; ++x, ++id) {
                if (id % static_cast<std::uint64_t>(comm.size()) != static_cast<std::uint64_t>(comm.rank()))
                    continue;
                const std::size_t a = fluid.size();
                fluid.resize(a + 1);
                fluid.data(field::id)[a] = id;
                const std::array<int, 3> index{x, y, z};
                for (std::uint32_t c = 0; c < 3; ++c) {
                    const double shift = choice.jitter * (2 * random.uniform(id, c) - 1);
                    fluid.data(field::position, static_cast<int>(c))[a] =
                        choice.box.lower[c] + (index[c] + 0.5 + shift) * choice.spacing;
                }
                fluid.data(field::mass)[a] = 1000 * std::pow(choice.spacing, 3);
            }
}

}  // namespace

MixtureSample::MixtureSample(const Choice& choice, const std::vector<PlacedSphere>& spheres)
    : comm(choice.ranks),
      spreading(choice.spreading),
      grid(choice.box, choice.spreading.radius, 1),
      fluid("fluid", 3),
      grains("grains", 3),
      fluid_cells(comm, choice.method),
      grain_cells(comm, choice.method) {
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::predicted_velocity, &field::mass, &of::quadrature_volume, &of::solid_fraction,
             &of::shared_fraction, &of::pair_acceleration, &of::grain_acceleration})
        fluid.add(*info);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::radius, &of::kernel_sum, &of::wet_share, &of::exchanged_force})
        grains.add(*info);
    place_fluid(choice, comm, fluid);
    for (std::size_t k = 0; k < spheres.size(); ++k) {
        if (static_cast<int>(k % static_cast<std::size_t>(comm.size())) != comm.rank()) continue;
        const std::size_t i = grains.size();
        grains.resize(i + 1);
        grains.data(field::id)[i] = k;
        for (int c = 0; c < 3; ++c)
            grains.data(field::position, c)[i] = spheres[k].place[static_cast<std::size_t>(c)];
        grains.data(field::radius)[i] = spheres[k].radius;
    }
    fluid_cells.expect(fluid);
    fluid_cells.divide(fluid, grid);
    fluid_cells.arrange(fluid, grid);
    grain_cells.expect(grains);
    grain_cells.follow(fluid_cells.partition());
    grain_cells.arrange(grains, grid);
    const RandomStream random{.seed = 6};
    for (std::size_t a = 0; a < fluid.size(); ++a) {
        fluid.data(of::quadrature_volume)[a] = std::pow(choice.spacing, 3);
        for (int c = 0; c < 3; ++c)
            fluid.data(field::predicted_velocity, c)[a] =
                random.uniform(fluid.data(field::id)[a], static_cast<std::uint32_t>(c)) - 0.5;
    }
    refresh_fluid({&field::position, &field::mass, &field::predicted_velocity, &of::quadrature_volume});
    refresh_grains({&field::position, &field::radius});
}

void MixtureSample::find_fractions(coupling::VolumeFraction kind) {
    coupling::sum_weights(mixture(), spreading);
    refresh_grains({&of::kernel_sum, &of::wet_share});
    coupling::spread_volume(mixture(), spreading, kind, of::solid_fraction);
    coupling::spread_volume(mixture(), spreading, coupling::VolumeFraction::normalised, of::shared_fraction);
    refresh_fluid({&of::solid_fraction, &of::shared_fraction});
}

void MixtureSample::refresh_fluid(std::initializer_list<const FieldInfo*> fields) {
    fluid_cells.halo().begin(fluid, fields);
    fluid_cells.halo().finish();
}

void MixtureSample::refresh_grains(std::initializer_list<const FieldInfo*> fields) {
    grain_cells.halo().begin(grains, fields);
    grain_cells.halo().finish();
}

double MixtureSample::integral(const Field<double>& field) const {
    ExactSum sum;
    for (std::size_t a = 0; a < fluid.size(); ++a)
        sum.add(fluid.data(of::quadrature_volume)[a] * fluid.data(field)[a]);
    ExactSum::all_reduce(comm, std::span<ExactSum>(&sum, 1));
    return sum.value();
}

double MixtureSample::grain_volume() const {
    ExactSum sum;
    for (const double r : grains.own(field::radius)) sum.add(4.0 / 3 * std::numbers::pi * r * r * r);
    ExactSum::all_reduce(comm, std::span<ExactSum>(&sum, 1));
    return sum.value();
}

}  // namespace talus::test
