#include "src/coupled_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/coupling_fields.hpp"
#include "physics/coupling/free_surface.hpp"
#include "physics/dem/vectors.hpp"

namespace talus {

namespace {

namespace of = coupling_field;

ParticleSet immersed_set(const GrainSetup& setup) {
    ParticleSet set("immersed", 3);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::angular_velocity, &field::acceleration, &field::radius, &field::mass,
             &field::body, &of::home_rank, &of::home_place, &of::kernel_sum, &of::wet_share,
             &of::exchanged_force})
        set.add(*info);
    if (setup.slip_memories > 0) {
        set.add(of::earlier_slip);
        set.add(of::slip_memories, 3 * setup.slip_memories);
    }
    return set;
}

ParticleSet with_fields(ParticleSet water, coupling::VolumeFraction fraction) {
    if (fraction == coupling::VolumeFraction::raw) water.add(of::shared_fraction);
    return water;
}

double ball(double radius) { return 4.0 / 3 * std::numbers::pi * radius * radius * radius; }

}  // namespace

CoupledSetup CoupledSimulation::completed(CoupledSetup setup) {
    setup.water.box = dem::PeriodicPlaces(setup.water.box).aligned(setup.water.box);
    setup.water.holds_grains = true;
    setup.grains.fluid_cells = WaterSimulation::cells(setup.water);
    setup.grains.slip_memories = setup.coupling.laws.basset ? setup.coupling.laws.basset->size() : 0;
    return setup;
}

CoupledSimulation::CoupledSimulation(const Communicator& comm, CoupledSetup setup, ParticleSet water,
                                     ParticleSet grains)
    : comm_(comm),
      setup_(completed(std::move(setup))),
      water_(comm, setup_.water, with_fields(std::move(water), setup_.coupling.fraction)),
      grains_(comm, setup_.grains, std::move(grains)),
      immersed_(immersed_set(setup_.grains)),
      immersed_cells_(comm, setup_.water.partition),
      exchange_(comm) {
    water_.before_evaluation([this](double) { immerse(); });
}

void CoupledSimulation::settle(const std::function<void()>& before_step) {
    grains_.start();
    while (grains_.time() < 0) {
        before_step();
        grains_.step();
    }
    settled_ = true;
}

void CoupledSimulation::start() {
    starting_ = true;
    water_.start();
    starting_ = false;
    grains_.follow(water_.decomposition().partition());
    if (!settled_) grains_.start();
    immerse();
    choose_time_step();
    exchange();
}

void CoupledSimulation::resume(double time, double time_step, std::uint64_t step,
                               const std::map<std::string, double>& numbers, const ParticleSet& contacts) {
    water_.resume(time, time_step, step, numbers);
    grains_.follow(water_.decomposition().partition());
    grains_.resume(time, static_cast<std::uint64_t>(std::llround(numbers.at("grain_steps"))), numbers,
                   contacts);
    choose_time_step();  // of the checkpoint, which a scene may have left with another step of grains
}

void CoupledSimulation::save_numbers(std::map<std::string, double>& numbers) const {
    water_.save_numbers(numbers);
    grains_.save_numbers(numbers);
    numbers["grain_steps"] = static_cast<double>(grains_.step_count());
    if (const auto& kernel = setup_.coupling.laws.basset) {
        numbers[shortest_memory] = kernel->shortest();
        numbers[longest_memory] = kernel->longest();
    }
}

void CoupledSimulation::reset_counters() {
    water_.reset_counters();
    grains_.reset_counters();
    pairs_ = 0;
}

bool CoupledSimulation::holds_some_grains() const {
    const auto& held = setup_.grains.held;
    return std::ranges::any_of(held, [](std::uint8_t h) { return h != 0; }) &&
           std::ranges::any_of(held, [](std::uint8_t h) { return h == 0; });
}

int CoupledSimulation::substeps() const {
    return static_cast<int>(std::lround(water_.time_step() / grains_.time_step()));
}

/// A whole number of the grains' steps.
void CoupledSimulation::choose_time_step() {
    constexpr double rounding = 1e-9;
    const double own = grains_.time_step(), most = water_.time_step();
    const double count = std::floor(most / own * (1 + rounding));
    if (count < 1)
        throw AgreedError(
            1, fmt::format("step {}, time {} s: the water asks for a time step of {:.4g} s ({} at "
                           "particle {}), that of the grains is {:.4g} s; a shorter dem.time_step?",
                           water_.step_count(), water_.time(), most, water_.step_limit().reason,
                           water_.step_limit().id, own));
    water_.set_time_step(count * own);
}

void CoupledSimulation::step() {
    last_step_ = water_.time_step();
    grains_.follow(water_.decomposition().partition());
    water_.phases().enter(Phase::grains);
    for (int k = substeps(); k > 0; --k) grains_.step();
    water_.step();
    choose_time_step();
    exchange();
    water_.phases().stop();
}

void CoupledSimulation::refresh_water(std::initializer_list<const FieldInfo*> fields) {
    const WaterSimulation::Access water = water_.access();
    water.decomposition.halo().begin(water.particles, fields);
    water.decomposition.halo().finish();
}

void CoupledSimulation::refresh_immersed(std::initializer_list<const FieldInfo*> fields) {
    immersed_cells_.halo().begin(immersed_, fields);
    immersed_cells_.halo().finish();
}

coupling::Mixture CoupledSimulation::mixture() {
    const WaterSimulation::Access water = water_.access();
    return {immersed_, immersed_cells_.table(), water.particles, water.decomposition.table(),
            water.grid.reach()};
}

const Field<double>& CoupledSimulation::shared_fraction() const {
    return setup_.coupling.fraction == coupling::VolumeFraction::normalised ? of::solid_fraction
                                                                            : of::shared_fraction;
}

/// The own grains as they are.
void CoupledSimulation::fill_immersed() {
    const ParticleSet& grains = std::as_const(grains_).grains();
    immersed_.resize(0);
    immersed_.resize(grains.size());
    const auto copy = [&](const auto& field, int component) {
        const auto from = grains.own(field, component);
        std::copy(from.begin(), from.end(), immersed_.data(field, component));
    };
    copy(field::id, 0);
    copy(field::radius, 0);
    copy(field::mass, 0);
    copy(field::body, 0);
    for (int axis = 0; axis < 3; ++axis) {
        copy(field::position, axis);
        copy(field::velocity, axis);
        copy(field::angular_velocity, axis);
    }
    if (setup_.grains.slip_memories > 0) {
        for (int axis = 0; axis < 3; ++axis) copy(of::earlier_slip, axis);
        for (int k = 0; k < 3 * setup_.grains.slip_memories; ++k) copy(of::slip_memories, k);
    }
    const dem::Vectors velocity(grains, field::velocity), earlier(grains, of::earlier_velocity),
        of_fluid(grains, of::fluid_acceleration), all(grains, field::acceleration);
    const dem::Vectors others(immersed_, field::acceleration);
    for (std::size_t i = 0; i < grains.size(); ++i) {
        others.put(i, last_step_ > 0 ? (1 / last_step_) * (velocity[i] - earlier[i]) - of_fluid[i]
                                     : all[i] - of_fluid[i]);
        immersed_.data(of::home_rank)[i] = static_cast<std::uint32_t>(comm_.rank());
        immersed_.data(of::home_place)[i] = static_cast<std::uint32_t>(i);
    }
}

/// Puts the grains where the water around them is, and finds what share of space they fill.
void CoupledSimulation::immerse() {
    water_.phases().enter(Phase::exchange);
    const WaterSimulation::Access water = water_.access();
    const double *mass = water.particles.data(field::mass), *density = water.particles.data(field::density);
    const std::uint8_t* body = water.particles.data(field::body);
    double* volume = water.particles.data(of::quadrature_volume);
    const auto& walls = setup_.water.walls;
    const dem::Vectors place(std::as_const(water.particles), field::position);
    const double depth = setup_.water.settings.spacing();
    const auto is_behind = [&](const dem::Vector3<>& x) {
        return std::ranges::any_of(setup_.coupling.spreading.planes, [&](const coupling::MirrorPlane& plane) {
            return dot(x - plane.point, plane.normal) < -depth;
        });
    };
    for (std::size_t a = 0; a < water.particles.size(); ++a) {
        const bool counts = (walls.empty() || !walls[body[a]]) && !is_behind(place[a]);
        volume[a] = (counts ? 1 : -1) * mass[a] / density[a];
    }
    refresh_water({&field::position, &of::quadrature_volume});
    fill_immersed();
    immersed_cells_.expect(immersed_);
    immersed_cells_.follow(water.decomposition.partition());
    immersed_cells_.arrange(immersed_, water.grid);
    refresh_immersed({&field::position, &field::radius});
    pairs_ += coupling::sum_weights(mixture(), setup_.coupling.spreading);
    refresh_immersed({&of::kernel_sum, &of::wet_share});
    const CouplingSetup& how = setup_.coupling;
    pairs_ += coupling::spread_volume(mixture(), how.spreading, how.fraction, of::solid_fraction);
    if (&shared_fraction() != &of::solid_fraction)
        pairs_ += coupling::spread_volume(mixture(), how.spreading, coupling::VolumeFraction::normalised,
                                          of::shared_fraction);
    if (!starting_) {
        coupling::relieve_free_surface(water.particles, water.decomposition.table(),
                                       setup_.water.settings.radius(),
                                       setup_.water.settings.state.reference_density);
        return;
    }
    const double* solid = water.particles.data(of::solid_fraction);
    for (std::size_t a = 0; a < water.particles.size(); ++a) {
        if (!(volume[a] > 0)) continue;
        const double left = water::share_of_water(solid[a]);
        water.particles.data(field::mass)[a] *= left;
        water.particles.data(field::density)[a] *= left;
    }
}

/// Forces between water and grains until the next exchange.
void CoupledSimulation::exchange() {
    water_.phases().enter(Phase::exchange);
    const WaterSimulation::Access water = water_.access();
    const CouplingSetup& how = setup_.coupling;
    for (int axis = 0; axis < 3; ++axis) {
        const double* a = water.particles.data(field::acceleration, axis);
        double* pairs = water.particles.data(of::pair_acceleration, axis);
        const double gravity = setup_.water.settings.gravity[static_cast<std::size_t>(axis)];
        const double* v = water.particles.data(field::velocity, axis);
        std::copy(v, v + water.particles.size(), water.particles.data(field::predicted_velocity, axis));
        for (std::size_t k = 0; k < water.particles.size(); ++k) pairs[k] = a[k] - gravity;
    }
    refresh_water({&field::mass, &field::predicted_velocity, &of::solid_fraction, &of::shared_fraction,
                   &of::pair_acceleration, &of::grain_acceleration});
    std::vector<coupling::Gathered> around(immersed_.size());
    pairs_ +=
        coupling::gather(mixture(), how.spreading, shared_fraction(), how.laws.needs_vorticity(), around);
    coupling::HistoryKernel::Passage passage;
    std::vector<dem::Vector3<>> remembered;
    if (how.laws.basset) {
        passage = how.laws.basset->between(last_step_, water_.time_step());
        remembered = remembered_slips(around, passage);
    }
    const dem::Vectors velocity(immersed_, field::velocity), spin(immersed_, field::angular_velocity),
        others(immersed_, field::acceleration), force(immersed_, of::exchanged_force);
    for (std::size_t i = 0; i < immersed_.size(); ++i) {
        around[i].acceleration += how.laws.gravity;
        const coupling::MovingGrain grain{.radius = immersed_.data(field::radius)[i],
                                          .mass = immersed_.data(field::mass)[i],
                                          .held = setup_.grains.held[immersed_.data(field::body)[i]] != 0,
                                          .velocity = velocity[i],
                                          .spin = spin[i],
                                          .other_acceleration = others[i],
                                          .remembered = how.laws.basset ? remembered[i] : dem::Vector3<>{}};
        const double wet = immersed_.data(of::wet_share)[i];
        force.put(i, coupling::mean_force(how.laws, grain, around[i], wet, water_.time_step()));
        if (how.laws.torque)
            spin.put(i, coupling::relaxed_spin(how.laws, grain, around[i], wet, water_.time_step()));
    }
    if (how.laws.feedback) {
        refresh_immersed({&of::exchanged_force});
        pairs_ += coupling::spread_force(mixture(), how.spreading);
    }
    return_forces();
    if (how.laws.basset) grains_.remember_slips(at_home(of::earlier_slip), passage);
    weigh_work();
}

/// What the immersed grains remember of their slips, as MovingGrain has it; the slips of now become
/// earlier_slip. A grain that is dry has none.
std::vector<dem::Vector3<>> CoupledSimulation::remembered_slips(
    std::span<const coupling::Gathered> around, const coupling::HistoryKernel::Passage& passage) {
    const dem::Vectors velocity(immersed_, field::velocity), earlier(immersed_, of::earlier_slip);
    const double* wet = immersed_.data(of::wet_share);
    std::vector<dem::Vector3<>> remembered(immersed_.size());
    for (std::size_t i = 0; i < immersed_.size(); ++i) {
        const dem::Vector3<> slip = wet[i] > 0 ? around[i].velocity - velocity[i] : dem::Vector3<>{};
        remembered[i] = passage.recent * (slip - earlier[i]);
        earlier.put(i, slip);
    }
    int component = 0;
    for (const auto& [kept, taken, felt] : passage.memories)
        for (const auto axis : {&dem::Vector3<>::x, &dem::Vector3<>::y, &dem::Vector3<>::z}) {
            const double* memory = immersed_.data(of::slip_memories, component++);
            for (std::size_t i = 0; i < immersed_.size(); ++i)
                remembered[i].*axis += felt * (kept * memory[i]);
        }
    return remembered;
}

/// A field of the immersed grains, on the ranks that move them and in their order there.
std::vector<dem::Vector3<>> CoupledSimulation::at_home(const Field<double>& field) {
    struct Returned {
        std::uint32_t place, unused;
        dem::Vector3<> value;
    };
    const dem::Vectors values(std::as_const(immersed_), field);
    std::vector<dem::Vector3<>> home(grains_.grains().size());
    std::map<int, std::vector<Returned>> leaving;
    for (std::size_t i = 0; i < immersed_.size(); ++i) {
        const std::uint32_t place = immersed_.data(of::home_place)[i];
        const int rank = static_cast<int>(immersed_.data(of::home_rank)[i]);
        if (rank == comm_.rank())
            home[place] = values[i];
        else
            leaving[rank].push_back({place, 0, values[i]});
    }
    std::vector<Parcel> outgoing;
    for (const auto& [rank, records] : leaving) {
        Parcel parcel{rank, std::vector<std::byte>(records.size() * sizeof(Returned))};
        std::memcpy(parcel.bytes.data(), records.data(), parcel.bytes.size());
        outgoing.push_back(std::move(parcel));
    }
    for (const Parcel& parcel : exchange_(std::move(outgoing))) {
        std::vector<Returned> records(parcel.bytes.size() / sizeof(Returned));
        std::memcpy(records.data(), parcel.bytes.data(), parcel.bytes.size());
        for (const Returned& found : records) home[found.place] = found.value;
    }
    return home;
}

/// To the ranks that move the grains.
void CoupledSimulation::return_forces() {
    std::vector<dem::Vector3<>> accelerations = at_home(of::exchanged_force);
    const auto mass = grains_.grains().own(field::mass);
    for (std::size_t i = 0; i < mass.size(); ++i) accelerations[i] = (1 / mass[i]) * accelerations[i];
    grains_.set_fluid_accelerations(accelerations);
    if (setup_.coupling.laws.torque) grains_.set_spins(at_home(field::angular_velocity));
}

/// Grains count in the cells of the water that they are in, in pairs of particles.
void CoupledSimulation::weigh_work() {
    constexpr double of_exchange = 400, of_contacts = 30;  // pairs that cost as much as a grain
    const WaterSimulation::Access water = water_.access();
    const std::span<const CellEntry> cells = water.decomposition.own_cells();
    const double each = of_exchange + of_contacts * substeps();
    for (const CellEntry& grains : immersed_cells_.own_cells()) {
        const auto at = std::lower_bound(cells.begin(), cells.end(), grains.key,
                                         [](const CellEntry& cell, CellKey key) { return cell.key < key; });
        if (at != cells.end() && at->key == grains.key)
            water.work_of_cell[static_cast<std::size_t>(at - cells.begin())] +=
                each * (grains.end - grains.begin);
    }
}

CouplingTotals CoupledSimulation::totals() const {
    enum Sum {
        on_grains,
        on_held = 3,
        together = 6,
        sizes = 9,
        volume,
        spread,
        mass,
        places,
        sum_count = places + 3
    };
    std::vector<ExactSum> sums(sum_count);
    const auto add = [&](int sum, double value) { sums[static_cast<std::size_t>(sum)].add(value); };
    CouplingTotals totals;
    std::array<double, 2> greatest{0, 0};  // solid fraction, kernel sum
    const bool some_held = holds_some_grains();
    for (std::size_t i = 0; i < immersed_.size(); ++i) {
        const double sum = immersed_.data(of::kernel_sum)[i], whole = ball(immersed_.data(field::radius)[i]);
        const double m = immersed_.data(field::mass)[i];
        const bool held = setup_.grains.held[immersed_.data(field::body)[i]] != 0,
                   placed = !held || !some_held;
        add(volume, whole);
        if (placed) add(mass, m);
        greatest[1] = std::max(greatest[1], sum);
        for (int axis = 0; axis < 3; ++axis) {
            const double f = immersed_.data(of::exchanged_force, axis)[i];
            add(on_grains + axis, f);
            if (held) add(on_held + axis, f);
            if (placed) add(places + axis, m * immersed_.data(field::position, axis)[i]);
            add(together + axis, f);
            add(sizes, std::abs(f));
        }
    }
    const ParticleSet& water = water_.particles();
    std::uint64_t clipped = 0;
    for (std::size_t a = 0; a < water.size(); ++a) {
        const double v = water.data(of::quadrature_volume)[a], solid = water.data(of::solid_fraction)[a];
        if (!(v > 0)) continue;
        add(spread, v * solid);
        greatest[0] = std::max(greatest[0], solid);
        clipped += 1 - solid < setup_.coupling.laws.least_fluid_fraction ? 1 : 0;
        for (int axis = 0; axis < 3; ++axis)
            add(together + axis, water.data(field::mass)[a] * water.data(of::grain_acceleration, axis)[a]);
    }
    ExactSum::all_reduce(comm_, sums);
    comm_.all_max(std::span<double>(greatest));
    double left2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
        totals.force[static_cast<std::size_t>(axis)] =
            sums[static_cast<std::size_t>(on_grains + axis)].value();
        totals.held_force[static_cast<std::size_t>(axis)] =
            sums[static_cast<std::size_t>(on_held + axis)].value();
        const double left = sums[static_cast<std::size_t>(together + axis)].value();
        left2 += left * left;
    }
    for (int axis = 0; axis < 3; ++axis)
        totals.mean_place[static_cast<std::size_t>(axis)] =
            sums[static_cast<std::size_t>(places + axis)].value() / sums[mass].value();
    totals.imbalance = sums[sizes].value() > 0 ? std::sqrt(left2) / sums[sizes].value() : 0;
    totals.least_fluid_fraction = 1 - greatest[0];
    totals.greatest_kernel_sum = greatest[1];
    totals.grain_volume = sums[volume].value();
    totals.spread_volume = sums[spread].value();
    totals.clipped = comm_.all_sum(clipped);
    return totals;
}

}  // namespace talus
