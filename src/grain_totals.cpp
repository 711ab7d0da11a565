#include <algorithm>
#include <cmath>

#include "comm/exact_sum.hpp"
#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"
#include "src/grain_simulation.hpp"

namespace talus {

std::vector<dem::LoadedContact> GrainSimulation::loaded_contacts() {
    rows_.predict(grains_, sums_, 0, 0, grains_.size());
    if (shear_) shear_->place_velocities(grains_, rows_);
    clumps_.predict(grains_, 0, rows_, shear());
    rows_halo_.begin(rows_.values());
    rows_halo_.finish(rows_.values());
    if (shear_) shear_->move_copies(rows_);
    std::vector<dem::LoadedContact> contacts = dem::loaded_pairs(rows_, setup_.laws, pairs_);
    at_walls_.append_loads(rows_, setup_.laws, setup_.walls, poses_at(time_), contacts);
    return contacts;
}

std::uint64_t GrainSimulation::bytes_of_lists() const {
    std::size_t bytes = sums_.capacity() * sizeof(dem::ForceSum) + rows_.bytes();
    bytes += pairs_.bytes() + at_walls_.bytes() + bonds_.bytes() + rows_halo_.bytes();
    bytes += clumps_.bytes() + units_.capacity() * sizeof(double);
    for (const StaggeredVector<double>* values :
         {&responses_.acceleration, &responses_.start[0], &responses_.start[1], &responses_.start[2]})
        bytes += values->capacity() * sizeof(double);
    return bytes;
}

/// Steps are chosen for contacts as they are expected: some are pressed harder than that, which lasts longer
/// than the steps between two looks.
void GrainSimulation::look_at_pressed_grains() {
    constexpr std::uint64_t interval = 100;
    if (step_ % interval != 0) return;
    const dem::HardestPressed now = dem::find_hardest_pressed(rows_, grains_.size(), setup_.laws, pairs_,
                                                              setup_.walls, at_walls_.touches());
    if (now.stable_step < hardest_pressed_.stable_step) hardest_pressed_ = now;
}

GrainTotals GrainSimulation::totals() const {
    enum Sum { mass, kinetic, rotational, potential, px, py, pz, lx, ly, lz, sum_count };
    std::vector<ExactSum> sums(sum_count + 6 * setup_.walls.size());
    double greatest_speed2 = 0;
    const double *m = grains_.data(field::mass), *r = grains_.data(field::radius);
    const std::uint8_t* body = grains_.data(field::body);
    const double* attraction = gravity_ ? grains_.data(field::gravity_potential) : nullptr;
    const std::array<double, 3> g{setup_.gravity.x, setup_.gravity.y, setup_.gravity.z};
    // Contacts, at walls, grains that are not held, bonds, ends of broken ones, grains.
    std::array<std::uint64_t, 6> counts{};
    const double* attracted = attraction && clumps_.exists() ? grains_.data(field::attracting_mass) : m;
    for (std::size_t i = 0; i < grains_.size(); ++i) {
        if (attraction) sums[potential].add(0.5 * attracted[i] * attraction[i]);
        if (!clumps_.counts(body[i], grains_.data(field::id)[i])) continue;
        ++counts[5];
        counts[2] += setup_.held[body[i]] ? 0 : 1;
        const dem::ClumpBody* clump = clumps_.of_body(body[i]);
        const Field<double>&centre = clump ? field::clump_centre : field::position,
              &velocity = clump ? field::clump_velocity : field::velocity;
        double speed2 = 0, spin2 = 0, potential_per_mass = 0;
        std::array<double, 3> x, p;
        const double flow = dem::shear_flow(setup_.box, grains_.data(centre, 1)[i]);
        for (int axis = 0; axis < 3; ++axis) {
            const double v = grains_.data(velocity, axis)[i] - (axis == 0 ? flow : 0.0),
                         w = grains_.data(field::angular_velocity, axis)[i];
            speed2 += v * v;
            spin2 += w * w;
            const auto a = static_cast<std::size_t>(axis);
            x[a] = grains_.data(centre, axis)[i];
            p[a] = m[i] * v;
            if (setup_.box.boundary[a] != Boundary::periodic)  // where it is, a place has no height
                potential_per_mass -= g[a] * x[a];
            sums[px + a].add(p[a]);
            sums[lx + a].add(clump ? grains_.data(field::clump_angular_momentum, axis)[i]
                                   : 0.4 * m[i] * r[i] * r[i] * w);
        }
        for (std::size_t a = 0; a < 3; ++a) {
            const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
            sums[lx + a].add(x[b] * p[c] - x[c] * p[b]);
        }
        sums[mass].add(m[i]);
        sums[kinetic].add(0.5 * m[i] * speed2);
        sums[rotational].add(clump ? clumps_.rotational_energy(grains_, i)
                                   : 0.5 * 0.4 * m[i] * r[i] * r[i] * spin2);
        sums[potential].add(m[i] * potential_per_mass);
        greatest_speed2 = std::max(greatest_speed2, speed2);
        if (bonds_.in_use()) counts[4] += grains_.data(field::broken_bonds)[i];
    }
    std::array<double, 2> greatest{std::sqrt(greatest_speed2), 0};
    const auto sticks_at = std::visit(
        []<class Table>(const Table&) -> std::size_t {
            return Table::Law::sticks ? Table::Law::history_count : 0;
        },
        setup_.laws);
    // Laws that act across gaps list pairs that only do that.
    const auto is_contact = [&](double overlap, const auto& remembered) {
        return reach_ == 0 || overlap > 0 || (sticks_at > 0 && remembered(sticks_at - 1) > 0);
    };
    pairs_.for_each_contact([&](std::size_t p, std::size_t k) {
        const std::uint32_t i = pairs_.first[p], j = pairs_.second[p];
        double distance2 = 0;
        for (std::size_t a = 0; a < 3; ++a)
            distance2 += (rows_[i][a] - rows_[j][a]) * (rows_[i][a] - rows_[j][a]);
        const double overlap = r[i] + r[j] - std::sqrt(distance2);
        counts[0] +=
            i < grains_.size() && is_contact(overlap, [&](std::size_t c) { return pairs_.history[c][k]; })
                ? 1
                : 0;
        greatest[1] = std::max(greatest[1], overlap / std::min(r[i], r[j]));
    });
    for (const dem::WallTouch& touch : at_walls_.touches()) {
        greatest[1] = std::max(greatest[1], touch.overlap / r[touch.grain]);
        counts[1] += is_contact(touch.overlap, [&](std::size_t c) { return touch.history[c]; }) ? 1 : 0;
        const dem::Vector3<> force = -touch.load.force;
        const dem::WallPose& pose = poses_[touch.wall];
        const dem::Vector3<> torque =
            cross(touch.point - pose.centre - pose.shift, force) - touch.load.couple;
        std::size_t sum = sum_count + 6 * touch.wall;
        for (const double component : {force.x, force.y, force.z, torque.x, torque.y, torque.z})
            sums[sum++].add(component);
    }
    counts[3] = bonds_.count_below(grains_.size());
    ExactSum::all_reduce(comm_, sums);
    comm_.all_max(std::span<double>(greatest));
    comm_.all_sum(std::span<std::uint64_t>(counts));
    const double stable_step = comm_.all_min(hardest_pressed_.stable_step);
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
            .angular_momentum = {sums[lx].value(), sums[ly].value(), sums[lz].value()},
            .greatest_speed = greatest[0],
            .greatest_overlap = greatest[1],
            .stable_step = stable_step,
            .overlap_of_stable_step = comm_.all_max(
                hardest_pressed_.stable_step == stable_step ? hardest_pressed_.overlap_share : 0.0),
            .grains = counts[5],
            .contacts = counts[0],
            .wall_contacts = counts[1],
            .bonds = counts[3],
            .broken_bonds = counts[4] / 2,
            .wall_forces = wall_forces,
            .wall_torques = wall_torques,
            .coordination = 2 * static_cast<double>(counts[0]) / mobile};
}

}  // namespace talus
