#include "src/grain_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/boundary.hpp"
#include "domain/grain_fields.hpp"

namespace talus {

namespace {

std::size_t history_count(const dem::AnyLawTable& laws) {
    return std::visit([](const auto& table) { return std::decay_t<decltype(table)>::Law::history_count; },
                      laws);
}

/// Force of a contact of a grain of this material pressed in by its own radius, the greatest of all partners
/// [N].
double force_of_flat_grain(const dem::AnyLawTable& laws, std::uint8_t material, double radius, double mass) {
    dem::ContactKinematics<double> flat{};
    flat.overlap = flat.effective_radius = radius;
    flat.effective_mass = mass;
    flat.normal = {1, 0, 0};
    double greatest = 0;
    std::visit(
        [&](const auto& table) {
            for (std::size_t other = 0; other < table.pairs.materials(); ++other)
                greatest = std::max(greatest, table.pairs(material, other).elasticity(flat, 0).normal_force);
        },
        laws);
    return greatest;
}

/// Of all grains that are or may come [m].
double largest_radius(const Communicator& comm, const ParticleSet& grains, const GrainFlowPlan& flow) {
    double largest = 0;
    for (const double r : grains.own(field::radius)) largest = std::max(largest, r);
    for (const GrainSource& source : flow.sources) largest = std::max(largest, source.greatest_radius);
    return comm.all_max(largest);
}

}  // namespace

GrainSimulation::GrainSimulation(const Communicator& comm, GrainSetup setup, ParticleSet grains)
    : comm_(comm),
      places_(setup.box),
      setup_(std::move(setup)),
      grains_(std::move(grains)),
      decomposition_(comm, setup_.partition),
      largest_radius_(largest_radius(comm, grains_, setup_.flow)),
      reach_(dem::greatest_reach(setup_.laws, largest_radius_)),
      flow_(comm, places_.aligned(setup_.box), setup_.flow, largest_radius_),
      pairs_(history_count(setup_.laws)) {
    setup_.box = places_.aligned(setup_.box);
    for (int axis = 0; axis < 3; ++axis)
        for (double& x : grains_.own(field::position, axis)) x = places_(axis, x);
    decomposition_.expect(grains_);
    grid_ = std::make_unique<CellGrid>(setup_.box, 2 * largest_radius_ + listed_gap(), 1);
    decomposition_.divide(grains_, *grid_);
}

void GrainSimulation::add_fields(ParticleSet& grains) {
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::velocity, &field::angular_velocity, &field::acceleration, &field::angular_acceleration,
             &field::radius, &field::mass, &field::body, &field::predicted_velocity,
             &field::predicted_angular_velocity, &field::copied_id})
        grains.add(*info);
}

std::vector<const FieldInfo*> GrainSimulation::history_fields(const GrainSetup& setup) {
    std::vector<const FieldInfo*> fields{&field::sliding};
    if (history_count(setup.laws) > 3) fields.push_back(&field::rolling);
    return fields;
}

void GrainSimulation::start() {
    flow_.begin(grains_);
    if (setup_.settling) time_ = -setup_.settling->longest;
    arrange({}, time_);
    dem::predict(grains_, 0);
    evaluate(0);
    finish(0);
}

void GrainSimulation::resume(double time, std::uint64_t step, const std::map<std::string, double>& numbers,
                             const ParticleSet& contacts) {
    flow_.restore(numbers, grains_);
    if (const auto looks = numbers.find("settle.quiet_looks"); looks != numbers.end())
        quiet_looks_ = static_cast<int>(looks->second);
    time_ = time;
    step_ = last_balance_ = step;
    arrange(dem::read_contacts(comm_, contacts, history_fields(setup_), grains_), time_);
    outdated_ = true;  // how far grains have moved is not known
}

void GrainSimulation::step() {
    phases_.enter(Phase::motion);
    auto kept_contacts = exchange_grains();
    dem::drift(grains_, setup_.time_step, places_);
    if (outdated_ || kept_contacts)
        arrange(kept_contacts ? std::move(*kept_contacts) : records_of_contacts(), time_ + setup_.time_step);
    dem::predict(grains_, setup_.time_step);
    ++step_;
    evaluate(setup_.time_step);
    time_ += setup_.time_step;
    finish(setup_.time_step);
    if (time_ < 0) settle();
    phases_.stop();
}

/// Looks whether the grains are quiet; time 0 begins once they have been for long enough.
void GrainSimulation::settle() {
    const GrainSettling& settling = *setup_.settling;
    if (step_ % settling.interval != 0) return;
    const double imbalance = force_imbalance(comm_, grains_, setup_.held, loaded_contacts());
    quiet_looks_ = imbalance <= settling.imbalance && !flow_.inserting(time_) ? quiet_looks_ + 1 : 0;
    if (quiet_looks_ >= settling.lasting) {
        notes_.push_back(fmt::format("{} grains settled in {} steps, {:.4g} s; forces balance to {:.2g}",
                                     total_grains(), step_, time_ + settling.longest, imbalance));
        time_ = 0;
        outdated_ = true;  // walls may set out
    } else if (time_ + static_cast<double>(settling.interval) * setup_.time_step >= 0) {
        throw AgreedError(1,
                          fmt::format("step {}: the grains have not settled within {} s: the rms force on a "
                                      "grain is {:.3g} of that of a contact (settle.imbalance = {}){}",
                                      step_, settling.longest, imbalance, settling.imbalance,
                                      flow_.inserting(time_) ? ", and sources are not done" : ""));
    }
}

std::vector<dem::LoadedContact> GrainSimulation::loaded_contacts() {
    dem::predict(grains_, 0);
    Halo& halo = decomposition_.halo();
    halo.begin(grains_, {&field::position, &field::predicted_velocity, &field::predicted_angular_velocity});
    halo.finish();
    rows_.update(grains_, 0, grains_.size_with_halo());
    std::vector<dem::LoadedContact> contacts = dem::loaded_pairs(rows_, setup_.laws, pairs_);
    at_walls_.append_loads(rows_, setup_.laws, setup_.walls, poses_at(time_), contacts);
    return contacts;
}

void GrainSimulation::save_numbers(std::map<std::string, double>& numbers) const {
    flow_.save(numbers);
    if (time_ < 0) numbers["settle.quiet_looks"] = quiet_looks_;
}

std::vector<std::string> GrainSimulation::take_notes() {
    std::vector<std::string> notes = flow_.take_notes();
    notes.insert(notes.end(), notes_.begin(), notes_.end());
    notes_.clear();
    return notes;
}

/// Grains come and go before the step; then the contacts as they were are returned, for the list has to be
/// made anew. Those of grains that went are not found again.
std::optional<std::vector<dem::ContactRecord>> GrainSimulation::exchange_grains() {
    if (!flow_.due(step_)) return {};
    std::vector<dem::ContactRecord> contacts = records_of_contacts();
    const std::vector<dem::WallPose> poses = poses_at(time_);
    const GrainFlow::Change change =
        flow_.apply(grains_, {time_, step_, places_, setup_.walls, poses, setup_.held, setup_.gravity});
    if (!change.any()) return {};
    decomposition_.expect_change(change.added, change.removed);
    return contacts;
}

/// Forces and torques of all contacts, those of own grains while copies are on their way.
void GrainSimulation::evaluate(double time_step) {
    phases_.enter(Phase::halo);
    Halo& halo = decomposition_.halo();
    halo.begin(grains_, {&field::position, &field::predicted_velocity, &field::predicted_angular_velocity});
    phases_.enter(Phase::forces);
    const std::size_t own = grains_.size();
    rows_.update(grains_, 0, own);
    sums_.assign(own, {});
    const dem::Evaluation evaluation{rows_, time_step, static_cast<std::uint32_t>(step_) + 1, sums_,
                                     largest_radius_};
    refuse_overload(dem::evaluate_pairs(evaluation, setup_.laws, dem::Pairs::own, pairs_), false);
    poses_ = poses_at(time_ + time_step);
    refuse_overload(at_walls_.evaluate(evaluation, setup_.laws, setup_.walls, poses_), true);
    phases_.enter(Phase::halo);
    halo.finish();
    phases_.enter(Phase::forces);
    rows_.update(grains_, own, grains_.size_with_halo());
    refuse_overload(dem::evaluate_pairs(evaluation, setup_.laws, dem::Pairs::with_copies, pairs_), false);
    evaluated_ += pairs_.touching_count + at_walls_.touches().size();
}

void GrainSimulation::finish(double kick_step) {
    phases_.enter(Phase::motion);
    const double moved2 = dem::finish_step(grains_, sums_, responses_, setup_.gravity, kick_step,
                                           setup_.time_step, remaining_motion(kick_step));
    // Two grains, or a grain and a wall, may each come nearer by half the skin before a pair is missing in
    // the list.
    const double allowed = 0.499 * setup_.skin;
    if (!std::isfinite(moved2)) refuse_not_finite();
    const bool walls_moved =
        walls_move() && at_walls_.displacement(poses_at(time_ + setup_.time_step)) > allowed;
    std::array<int, 2> flags{walls_moved || moved2 > allowed * allowed, !fault_.empty()};
    phases_.enter(Phase::wait);
    comm_.all_max(std::span<int>(flags));
    outdated_ = flags[0] > 0;
    if (flags[1] > 0) comm_.all_agree(1, fault_);
}

/// Factor by which damping makes velocities smaller in a step, 1 once grains have settled.
double GrainSimulation::remaining_motion(double time_step) const {
    if (!setup_.settling || setup_.settling->damping == 0 || time_ >= 0) return 1;
    return std::exp(-time_step / setup_.settling->damping);
}

void GrainSimulation::refuse_not_finite() {
    if (!fault_.empty()) return;
    fault_ = fmt::format("step {}, time {} s: ", step_, time_);
    if (const NotFinite found = find_not_finite(grains_); found.field) {
        fault_ += fmt::format("{} of grain {} is not finite", found.field->name, found.id);
        return;
    }
    std::size_t fastest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto v = std::as_const(grains_).own(field::velocity, axis);
        for (std::size_t i = 0; i < v.size(); ++i)
            if (!std::isfinite(v[i] * v[i])) fastest = i;
    }
    fault_ += fmt::format("grain {} moves too fast to follow", grains_.data(field::id)[fastest]);
}

void GrainSimulation::refuse_overload(const dem::Overload& overload, bool at_wall) {
    if (!overload.found || !fault_.empty()) return;
    const std::uint64_t* id = grains_.data(field::copied_id);
    const std::string place = fmt::format(
        "({:.6g}, {:.6g}, {:.6g}) m", grains_.data(field::position, 0)[overload.first],
        grains_.data(field::position, 1)[overload.first], grains_.data(field::position, 2)[overload.first]);
    const std::string when = fmt::format("step {}, time {} s: ", step_, time_);
    if (overload.behind) {
        fault_ = when + fmt::format("grain {} at {} has left through wall '{}'", id[overload.first], place,
                                    setup_.walls[overload.second].name);
        return;
    }
    fault_ = when + fmt::format(
                        "the force between grain {} at {} and {} is not finite, or beyond that of a grain "
                        "pressed flat; a smaller time step, or grains that do not overlap at the start?",
                        id[overload.first], place,
                        at_wall ? fmt::format("wall '{}'", setup_.walls[overload.second].name)
                                : fmt::format("grain {}", id[overload.second]));
}

std::vector<dem::WallPose> GrainSimulation::poses_at(double time) const {
    std::vector<dem::WallPose> poses;
    for (const dem::Wall& wall : setup_.walls) poses.push_back(wall.motion.pose(time));
    return poses;
}

/// Whether any wall ever does.
bool GrainSimulation::walls_move() const {
    const auto moves = [](const dem::Wall& wall) {
        const dem::WallMotion& m = wall.motion;
        return norm(m.velocity) > 0 || norm(m.amplitude) > 0 || m.angular_velocity != 0 ||
               m.angle_amplitude != 0;
    };
    return std::any_of(setup_.walls.begin(), setup_.walls.end(), moves);
}

/// Brings grains back into the box and to their owners, contacts with them, and lists the pairs anew. `time`:
/// that of the positions [s].
void GrainSimulation::arrange(std::vector<dem::ContactRecord> records, double time) {
    phases_.enter(Phase::decompose);
    apply_boundaries(grains_, setup_.box);
    const auto interval = static_cast<std::uint64_t>(setup_.rebalance_interval);
    if (interval > 0 && step_ >= last_balance_ + interval) {
        last_balance_ = step_;
        std::vector<double> work;
        for (const CellEntry& cell : decomposition_.own_cells()) work.push_back(cell.end - cell.begin);
        decomposition_.rebalance(work);
    }
    dem::follow_grains(comm_, decomposition_, *grid_, grains_, records);
    decomposition_.arrange(grains_, *grid_);
    const auto ids = std::as_const(grains_).own(field::id);
    std::copy(ids.begin(), ids.end(), grains_.data(field::copied_id));
    Halo& halo = decomposition_.halo();
    halo.begin(grains_, {&field::position, &field::radius, &field::mass, &field::body, &field::copied_id});
    halo.finish();
    describe_grains();
    list_contacts(records, time);
    ++lists_;
}

/// What follows from the order of grains: units of force, responses, places from which displacement counts.
void GrainSimulation::describe_grains() {
    const double *radius = grains_.data(field::radius), *mass = grains_.data(field::mass);
    const std::uint8_t* body = grains_.data(field::body);
    const std::size_t own = grains_.size(), all = grains_.size_with_halo();
    std::vector<double> units(all);
    for (std::size_t i = 0; i < all; ++i)
        units[i] =
            dem::force_unit(force_of_flat_grain(setup_.laws, setup_.material[body[i]], radius[i], mass[i]));
    rows_.reset(grains_, units);
    responses_.acceleration.resize(own);
    responses_.angular.resize(own);
    for (std::size_t i = 0; i < own; ++i) {
        const double mobile = setup_.held[body[i]] ? 0.0 : 1.0;
        responses_.acceleration[i] = mobile * units[i] / mass[i];
        responses_.angular[i] = mobile * units[i] * radius[i] / (0.4 * mass[i] * radius[i] * radius[i]);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const auto x = std::as_const(grains_).own(field::position, axis);
        responses_.start[static_cast<std::size_t>(axis)].assign(x.begin(), x.end());
    }
}

void GrainSimulation::list_contacts(const std::vector<dem::ContactRecord>& records, double time) {
    const std::size_t materials =
        std::visit([](const auto& table) { return table.pairs.materials(); }, setup_.laws);
    const dem::PairRule rule{listed_gap(), setup_.material, setup_.held, materials};
    dem::list_pairs(grains_, decomposition_.table(), rule, pairs_);
    const std::uint64_t* id = grains_.data(field::copied_id);
    const auto id_of = [id](std::uint32_t i) { return id[i]; };
    const dem::ContactRecordMap map(records);
    const auto now = static_cast<std::uint32_t>(step_) + 1;
    dem::restore_records(map, now, id_of, id_of, pairs_);
    poses_ = poses_at(time);
    at_walls_.list(grains_, setup_.walls, poses_, rule);
    at_walls_.restore(records, grains_);
}

std::vector<dem::ContactRecord> GrainSimulation::records_of_contacts() const {
    return records_below(grains_.size_with_halo());
}

/// The contacts of the last evaluation whose first grain is stored below `end`.
std::vector<dem::ContactRecord> GrainSimulation::records_below(std::size_t end) const {
    const std::uint64_t* id = grains_.data(field::copied_id);
    const auto id_of = [id](std::uint32_t i) { return id[i]; };
    std::vector<dem::ContactRecord> records;
    dem::append_records(pairs_, end, id_of, id_of, records);
    at_walls_.append_records(grains_, records);
    return records;
}

ParticleSet GrainSimulation::save() {
    arrange(records_of_contacts(), time_);
    outdated_ = true;
    phases_.stop();
    return dem::saved_contacts(records_below(grains_.size()), grains_.dimension(), history_fields(setup_));
}

std::uint64_t GrainSimulation::bytes_of_lists() const {
    std::size_t bytes = sums_.capacity() * sizeof(dem::ForceSum) + rows_.bytes();
    bytes += pairs_.bytes() + at_walls_.bytes();
    for (const std::vector<double>* values :
         {&responses_.acceleration, &responses_.angular, &responses_.start[0], &responses_.start[1],
          &responses_.start[2]})
        bytes += values->capacity() * sizeof(double);
    return bytes;
}

void GrainSimulation::reset_counters() {
    evaluated_ = lists_ = 0;
    phases_ = {};
}

GrainTotals GrainSimulation::totals() const {
    enum Sum { mass, kinetic, rotational, potential, px, py, pz, sum_count };
    std::vector<ExactSum> sums(sum_count + 6 * setup_.walls.size());
    double greatest_speed2 = 0;
    const double *m = grains_.data(field::mass), *r = grains_.data(field::radius);
    const std::uint8_t* body = grains_.data(field::body);
    const std::array<double, 3> g{setup_.gravity.x, setup_.gravity.y, setup_.gravity.z};
    std::array<std::uint64_t, 3> counts{};  // contacts, at walls, grains that are not held
    for (std::size_t i = 0; i < grains_.size(); ++i) {
        double speed2 = 0, spin2 = 0, potential_per_mass = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double v = grains_.data(field::velocity, axis)[i],
                         w = grains_.data(field::angular_velocity, axis)[i];
            speed2 += v * v;
            spin2 += w * w;
            const auto a = static_cast<std::size_t>(axis);
            if (setup_.box.boundary[a] != Boundary::periodic)  // where it is, a place has no height
                potential_per_mass -= g[a] * grains_.data(field::position, axis)[i];
            sums[static_cast<std::size_t>(px + axis)].add(m[i] * v);
        }
        sums[mass].add(m[i]);
        sums[kinetic].add(0.5 * m[i] * speed2);
        sums[rotational].add(0.5 * 0.4 * m[i] * r[i] * r[i] * spin2);
        sums[potential].add(m[i] * potential_per_mass);
        greatest_speed2 = std::max(greatest_speed2, speed2);
        counts[2] += setup_.held[body[i]] ? 0 : 1;
    }
    std::array<double, 2> greatest{std::sqrt(greatest_speed2), 0};
    for (std::size_t k = 0; k < pairs_.touching_count; ++k) {
        const std::uint32_t i = pairs_.first[pairs_.touching[k]], j = pairs_.second[pairs_.touching[k]];
        counts[0] += i < grains_.size() ? 1 : 0;
        double distance2 = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double* x = grains_.data(field::position, axis);
            distance2 += (x[i] - x[j]) * (x[i] - x[j]);
        }
        greatest[1] = std::max(greatest[1], (r[i] + r[j] - std::sqrt(distance2)) / std::min(r[i], r[j]));
    }
    for (const dem::WallTouch& touch : at_walls_.touches()) {
        greatest[1] = std::max(greatest[1], touch.overlap / r[touch.grain]);
        const dem::Vector3<> force = -touch.load.force;
        const dem::WallPose& pose = poses_[touch.wall];
        const dem::Vector3<> torque =
            cross(touch.point - pose.centre - pose.shift, force) - touch.load.couple;
        std::size_t sum = sum_count + 6 * touch.wall;
        for (const double component : {force.x, force.y, force.z, torque.x, torque.y, torque.z})
            sums[sum++].add(component);
    }
    counts[1] = at_walls_.touches().size();
    ExactSum::all_reduce(comm_, sums);
    comm_.all_max(std::span<double>(greatest));
    comm_.all_sum(std::span<std::uint64_t>(counts));
    const auto mobile = static_cast<double>(std::max<std::uint64_t>(counts[2], 1));
    std::vector<std::array<double, 3>> wall_forces(setup_.walls.size()), wall_torques(setup_.walls.size());
    for (std::size_t w = 0; w < wall_forces.size(); ++w)
        for (std::size_t a = 0; a < 3; ++a) {
            wall_forces[w][a] = sums[sum_count + 6 * w + a].value();
            wall_torques[w][a] = sums[sum_count + 6 * w + 3 + a].value();
        }
    return {.mass = sums[mass].value(),
            .kinetic_energy = sums[kinetic].value(),
            .rotational_energy = sums[rotational].value(),
            .potential_energy = sums[potential].value(),
            .momentum = {sums[px].value(), sums[py].value(), sums[pz].value()},
            .greatest_speed = greatest[0],
            .greatest_overlap = greatest[1],
            .grains = total_grains(),
            .contacts = counts[0],
            .wall_contacts = counts[1],
            .wall_forces = wall_forces,
            .wall_torques = wall_torques,
            .coordination = 2 * static_cast<double>(counts[0]) / mobile};
}

}  // namespace talus
