#include "src/rigid_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "comm/exact_sum.hpp"
#include "domain/clump_fields.hpp"
#include "domain/rigid_fields.hpp"
#include "domain/water_fields.hpp"
#include "io/agree.hpp"
#include "physics/dem/contact_pass.hpp"
#include "physics/dem/vectors.hpp"

namespace talus {

using dem::Vector3;

RigidBodies::RigidBodies(const Communicator& comm, RigidSetup setup, const Box& box,
                         const water::Settings& settings)
    : comm_(comm), setup_(std::move(setup)), box_(box), settings_(settings), states_(setup_.states) {
    feels_.assign(256, 0);
    for (const rigid::Body& body : setup_.bodies) feels_[body.index] = 1;
    if (setup_.laws) contacts_.emplace(setup_.bodies, *setup_.laws, setup_.walls, box_);
    limit_ = stable_step();
}

void RigidBodies::add_fields(ParticleSet& particles) {
    particles.add(field::place_in_body);
    particles.add(water_field::wall_force);
}

/// Water sends waves away from a body that moves faster, so that it is slowed at a rate rho c A/(D m), A its
/// surface, of which half or a third faces each axis; viscosity adds to that. Explicit steps bear a rate
/// below 2/dt.
sph::StepLimit RigidBodies::stable_step() const {
    constexpr double share = 0.25;  // docs/decisions/028
    const double h = settings_.smoothing_length, spacing = settings_.spacing(),
                 rho = settings_.state.reference_density, c = settings_.state.sound_speed;
    const double impedance = rho * c * (1 + settings_.artificial_viscosity * h / spacing) +
                             2 * settings_.greatest_viscosity() / spacing;
    sph::StepLimit limit{std::numeric_limits<double>::infinity(), 0, "the lightness of a rigid body"};
    for (const rigid::Body& body : setup_.bodies) {
        const double step = share * 2 * box_.dimension * body.mass / (impedance * body.area);
        if (step < limit.time_step) limit = {step, body.first_id, limit.reason};
    }
    return limit;
}

void RigidBodies::kick(double time) {
    for (rigid::State& state : states_) rigid::kick(state, time);
}

void RigidBodies::move(double time, double time_step) {
    substeps_ = 1;
    if (contacts_) {
        double fastest = 0;
        for (std::size_t k = 0; k < states_.size(); ++k) {
            const double turning = norm(rigid::angular_velocity(setup_.bodies[k], states_[k]));
            fastest =
                std::max(fastest, norm(states_[k].velocity) + turning * setup_.bodies[k].bounding_radius);
        }
        for (const dem::Wall& wall : setup_.walls) {
            const dem::WallPose pose = wall.motion.pose(time);
            double swept = 0;
            for (std::size_t k = 0; k < states_.size(); ++k)
                swept = std::max(swept, norm(states_[k].centre - pose.centre - pose.shift) +
                                            setup_.bodies[k].bounding_radius);
            fastest = std::max(fastest, norm(pose.velocity) + norm(pose.angular_velocity) * swept);
        }
        constexpr double margin = 4;  // two bodies, and twice as fast after a bounce off a heavier one
        contacts_->list(states_, time, margin * fastest * time_step);
    }
    if (!contacts_ || !contacts_->any_near()) {
        if (contacts_) contacts_->records().clear();
        for (std::size_t k = 0; k < states_.size(); ++k)
            rigid::drift(setup_.bodies[k], states_[k], time_step);
        return check(time + time_step);
    }
    constexpr double radians_a_step = 0.1, most = 1e5;
    const double wanted =
        std::max(std::ceil(time_step * contacts_->greatest_frequency() / radians_a_step), 1.0);
    if (wanted > most)
        throw AgreedError(
            1, fmt::format("contacts of rigid bodies ask for {:.3g} steps in one of the water, more "
                           "than {:.0e}: a lower stiffness?",
                           wanted, most));
    substeps_ = static_cast<int>(wanted);
    const double dt = time_step / substeps_;
    std::vector<rigid::Load> loads = contacts_->loads(states_, time, 0);
    const auto kicked = [&](std::vector<rigid::State>& states) {
        for (std::size_t k = 0; k < states.size(); ++k) {
            states[k].velocity += (dt / 2 / setup_.bodies[k].mass) * loads[k].force;
            states[k].angular_momentum += (dt / 2) * loads[k].torque;
        }
    };
    for (int step = 1; step <= substeps_; ++step) {
        kicked(states_);
        for (std::size_t k = 0; k < states_.size(); ++k) rigid::drift(setup_.bodies[k], states_[k], dt);
        std::vector<rigid::State> predicted = states_;
        kicked(predicted);
        loads = contacts_->loads(predicted, time + step * dt, dt);
        kicked(states_);
    }
    check(time + time_step);
}

void RigidBodies::check(double time) const {
    for (std::size_t k = 0; k < states_.size(); ++k) {
        const rigid::State& state = states_[k];
        const auto stop = [&](const std::string& what) {
            throw AgreedError(
                1, fmt::format("time {} s: rigid body '{}' {}", time, setup_.bodies[k].name, what));
        };
        const Vector3<>&x = state.centre, &v = state.velocity, &l = state.angular_momentum,
              &q = state.orientation.vector;
        for (const double value :
             {x.x, x.y, x.z, v.x, v.y, v.z, l.x, l.y, l.z, q.x, q.y, q.z, state.orientation.scalar})
            if (!std::isfinite(value)) stop("has a state that is not finite");
        const std::array<double, 3> place{x.x, x.y, x.z};
        for (std::size_t a = 0; a < static_cast<std::size_t>(box_.dimension); ++a)
            if (box_.boundary[a] != Boundary::periodic && box_.upper[a] > box_.lower[a] &&
                !(place[a] >= box_.lower[a] && place[a] <= box_.upper[a]))
                stop(fmt::format("has left the box along {}, its centre is at {:.6g} m", "xyz"[a], place[a]));
    }
}

void RigidBodies::place(ParticleSet& particles, double time_ahead) const {
    std::vector<rigid::State> predicted = states_;
    for (rigid::State& state : predicted) rigid::kick(state, time_ahead);
    rigid::place_particles(particles, setup_.bodies, predicted);
}

void RigidBodies::complete(std::span<sph::WallNow> walls) const {
    for (const rigid::Body& body : setup_.bodies) walls[body.index].moves_freely = true;
}

void RigidBodies::take_forces(const ParticleSet& particles) {
    constexpr std::size_t each = 6;
    std::vector<ExactSum> sums(each * states_.size());
    const auto dimension = static_cast<std::size_t>(particles.dimension());
    std::array<const double*, 3> force{};
    for (std::size_t a = 0; a < dimension; ++a)
        force[a] = particles.data(water_field::wall_force, static_cast<int>(a));
    rigid::for_each_particle(
        particles, setup_.bodies, states_, [&](std::size_t i, std::size_t k, const Vector3<>& arm) {
            const Vector3<> f{force[0][i], force[1][i], dimension > 2 ? force[2][i] : 0.0};
            const Vector3<> torque = cross(arm, f);
            const std::array<double, each> terms{f.x, f.y, f.z, torque.x, torque.y, torque.z};
            for (std::size_t c = 0; c < each; ++c)
                if (terms[c] != 0) sums[each * k + c].add(terms[c]);
        });
    ExactSum::all_reduce(comm_, sums);
    const auto& g = settings_.gravity;
    for (std::size_t k = 0; k < states_.size(); ++k) {
        const auto total = [&](std::size_t c) { return sums[each * k + c].value(); };
        rigid::State& state = states_[k];
        const rigid::Body& body = setup_.bodies[k];
        state.acceleration = (1 / body.mass) * (body.force + Vector3<>{total(0), total(1), total(2)}) +
                             Vector3<>{g[0], g[1], g[2]};
        state.torque = {total(3), total(4), total(5)};
    }
}

RigidTotals RigidBodies::totals(std::size_t k) const {
    const rigid::Body& body = setup_.bodies[k];
    const rigid::State& state = states_[k];
    const Vector3<> gravity{settings_.gravity[0], settings_.gravity[1], settings_.gravity[2]},
        bearing{settings_.bearing[0], settings_.bearing[1], settings_.bearing[2]};
    return {.state = state,
            .turning = rigid::angular_velocity(body, state),
            .force = body.mass * (state.acceleration - gravity) - body.force,
            .torque = state.torque,
            .kinetic_energy = rigid::kinetic_energy(body, state),
            .potential_energy = -body.mass * dot(bearing, state.centre)};
}

rigid::Contacts::Overlap RigidBodies::greatest_overlap(double time) {
    if (!contacts_) return {};
    contacts_->list(states_, time, 0);
    return contacts_->greatest_overlap(states_, time);
}

namespace {

/// How states and their columns correspond.
template <class Set, class Visit>
void for_each_vector(Set& set, Visit&& visit) {
    const auto column = [&](const Field<double>& field, auto member) {
        visit(dem::Vectors<Set>(set, field), member);
    };
    column(
        field::position, [](auto& s) -> auto& { return s.centre; });
    column(
        field::clump_velocity, [](auto& s) -> auto& { return s.velocity; });
    column(
        field::clump_angular_momentum, [](auto& s) -> auto& { return s.angular_momentum; });
    column(
        field::orientation_vector, [](auto& s) -> auto& { return s.orientation.vector; });
    column(
        field::clump_acceleration, [](auto& s) -> auto& { return s.acceleration; });
    column(
        field::clump_torque, [](auto& s) -> auto& { return s.torque; });
}

}  // namespace

ParticleSet RigidBodies::empty_states() {
    ParticleSet set("rigid_bodies", 3);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::clump_velocity, &field::clump_angular_momentum, &field::orientation_scalar,
             &field::orientation_vector, &field::clump_acceleration, &field::clump_torque})
        set.add(*info);
    return set;
}

ParticleSet RigidBodies::empty_contacts(const RigidSetup& setup) {
    return dem::empty_contacts(
        3, setup.laws ? dem::history_fields(*setup.laws) : std::vector<const FieldInfo*>{});
}

ParticleSet RigidBodies::saved_states() const {
    ParticleSet set = empty_states();
    if (!comm_.is_root()) return set;
    set.resize(states_.size());
    for_each_vector(set, [&](const auto& column, auto member) {
        for (std::size_t k = 0; k < states_.size(); ++k) column.put(k, member(states_[k]));
    });
    for (std::size_t k = 0; k < states_.size(); ++k) {
        set.data(field::id)[k] = k;
        set.data(field::orientation_scalar)[k] = states_[k].orientation.scalar;
    }
    return set;
}

ParticleSet RigidBodies::saved_contacts() const {
    ParticleSet set = empty_contacts(setup_);
    if (comm_.is_root() && contacts_)
        dem::save_pairs(contacts_->records(), dem::history_fields(*setup_.laws), set);
    return set;
}

void RigidBodies::restore(const ParticleSet& states, const ParticleSet& contacts) {
    struct Row {
        std::uint64_t id;
        rigid::State state;
    };
    std::vector<Row> rows(states.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        rows[k].id = states.data(field::id)[k];
        rows[k].state.orientation.scalar = states.data(field::orientation_scalar)[k];
    }
    for_each_vector(states, [&](const auto& column, auto member) {
        for (std::size_t k = 0; k < rows.size(); ++k) member(rows[k].state) = column[k];
    });
    const std::vector<Row> all = comm_.all_gather(std::span<const Row>(rows));
    if (all.size() != states_.size())
        throw AgreedError(exit_input_output,
                          fmt::format("the checkpoint holds {} rigid bodies; the scene has {}", all.size(),
                                      states_.size()));
    for (const Row& row : all) states_[row.id] = row.state;
    if (!contacts_) return;
    const std::vector<dem::ContactRecord> records =
        dem::rows_of_pairs<dem::most_history>(contacts, dem::history_fields(*setup_.laws));
    contacts_->records() = comm_.all_gather(std::span<const dem::ContactRecord>(records));
}

}  // namespace talus
