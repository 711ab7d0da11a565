#include "physics/dem/wall_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "domain/grain_fields.hpp"

namespace talus::dem {

void WallContacts::list(const ParticleSet& grains, std::span<const Wall> walls,
                        std::span<const WallPose> poses, const PairRule& rule) {
    const double* radius = grains.data(field::radius);
    const std::uint8_t* body = grains.data(field::body);
    const std::array<const double*, 3> x{grains.data(field::position, 0), grains.data(field::position, 1),
                                         grains.data(field::position, 2)};
    near_.clear();
    touches_.clear();
    listed_poses_.assign(poses.begin(), poses.end());
    farthest_.assign(walls.size(), 0.0);
    for (std::uint32_t i = 0; i < grains.size(); ++i) {
        if (rule.held[body[i]]) continue;
        for (std::uint32_t w = 0; w < walls.size(); ++w) {
            const Vector3<> from_centre =
                Vector3<>{x[0][i], x[1][i], x[2][i]} - poses[w].centre - poses[w].shift;
            farthest_[w] = std::max(farthest_[w], norm(from_centre) + radius[i] + 2 * rule.margin);
            if (may_touch(walls[w], poses[w], {x[0][i], x[1][i], x[2][i]}, radius[i], rule.margin))
                near_.push_back({i, w,
                                 static_cast<std::uint32_t>(rule.material[body[i]] * rule.materials +
                                                            walls[w].material)});
        }
    }
}

void WallContacts::append_records(const ParticleSet& grains, std::vector<ContactRecord>& records) const {
    const std::uint64_t* id = grains.data(field::id);
    for (const WallTouch& touch : touches_)
        records.push_back({id[touch.grain], wall_key(touch.wall, touch.place), touch.history});
}

void WallContacts::restore(std::span<const ContactRecord> records, const ParticleSet& grains) {
    std::vector<ContactRecord> known;
    for (const ContactRecord& record : records)
        if (is_wall_key(record.second)) known.push_back(record);
    const auto before = is_before<most_history>;
    std::sort(known.begin(), known.end(), before);
    const std::uint64_t* id = grains.data(field::id);
    for (Near& near : near_) {
        near.begin = static_cast<std::uint32_t>(touches_.size());
        const ContactRecord first{id[near.grain], wall_key(near.wall, 0), {}};
        for (auto at = std::lower_bound(known.begin(), known.end(), first, before);
             at != known.end() && at->first == first.first && at->second < wall_key(near.wall + 1, 0); ++at)
            touches_.push_back(
                {near.grain, near.wall, static_cast<std::uint32_t>(at->second), 0, {}, {}, at->history});
        near.end = static_cast<std::uint32_t>(touches_.size());
    }
}

namespace {

template <class Law>
ContactLoad<double> load_of(const Law& law, const ContactKinematics<double>& k,
                            std::array<double, most_history>& remembered) {
    static_assert(Law::history_count <= most_history);
    typename Law::History history{};
    std::copy_n(remembered.begin(), history.size(), history.begin());
    const ContactLoad<double> load = law(k, history);
    std::copy(history.begin(), history.end(), remembered.begin());
    return load;
}

/// Whether a grain's centre came through the surface in the last step: it is behind it, or no further from it
/// than it may have come since it was behind a sheet with two sides. `departure` is its velocity away from
/// the surface now, less than that of the passage by what the load, `acceleration`, took from it.
bool has_passed(double distance, double departure, double acceleration, double time_step) {
    const double speed = std::max(departure, 0.0) + acceleration * time_step;
    return distance <= 0 || distance < speed * time_step;
}

}  // namespace

Overload WallContacts::evaluate(const Evaluation& evaluation, const AnyLawTable& laws,
                                std::span<const Wall> walls, std::span<const WallPose> poses) {
    Overload overload;
    std::swap(touches_, before_);
    touches_.clear();
    std::vector<WallContact> found;
    const auto loop = [&](const auto& table) {
        for (Near& near : near_) {
            const auto& law = table.pairs[near.law];
            const WallPose& pose = poses[near.wall];
            const PlacedGrain<double> g = placed_grain(evaluation.rows[near.grain]);
            const double radius = g.grain.radius;
            find_wall_contacts(walls[near.wall], pose, g.position, radius, law.reach(radius), found);
            const auto begin = static_cast<std::uint32_t>(touches_.size());
            for (const WallContact& contact : found) {
                WallTouch touch{near.grain, near.wall, contact.place, contact.overlap, contact.point};
                for (std::uint32_t t = near.begin; t < near.end; ++t)
                    if (before_[t].place == contact.place) touch.history = before_[t].history;
                const ContactKinematics<double> k =
                    wall_kinematics(contact.normal, contact.overlap, g.grain, contact.wall_velocity,
                                    pose.angular_velocity, evaluation.time_step);
                const ContactLoad<double> load = touch.load = load_of(law, k, touch.history);
                touches_.push_back(touch);
                ForceSum& sum = evaluation.sums[near.grain];
                const Vector3<> torque =
                    torque_about_centre(k.normal, contact_arm(radius, contact.overlap), load);
                const bool force_fits = add_in_units(load.force, g.units_per_force, sum.force);
                const bool torque_fits = add_in_units(torque, g.units_per_force / radius, sum.torque);
                const double departure = dot(k.normal, g.grain.velocity - contact.wall_velocity);
                const bool behind = has_passed(radius - contact.overlap, departure,
                                               norm(load.force) / g.grain.mass, evaluation.time_step);
                if ((behind || !force_fits || !torque_fits) && !overload.found)
                    overload = {true, near.grain, near.wall, behind};
            }
            near.begin = begin;
            near.end = static_cast<std::uint32_t>(touches_.size());
        }
    };
    std::visit(loop, laws);
    return overload;
}

void WallContacts::append_loads(const GrainRows& rows, const AnyLawTable& laws, std::span<const Wall> walls,
                                std::span<const WallPose> poses, std::vector<LoadedContact>& contacts) const {
    std::vector<WallContact> found;
    const auto loop = [&](const auto& table) {
        for (const Near& near : near_) {
            if (near.begin == near.end) continue;
            const auto& law = table.pairs[near.law];
            const PlacedGrain<double> g = placed_grain(rows[near.grain]);
            find_wall_contacts(walls[near.wall], poses[near.wall], g.position, g.grain.radius,
                               law.reach(g.grain.radius), found);
            for (const WallContact& contact : found) {
                const auto touch =
                    std::find_if(touches_.begin() + near.begin, touches_.begin() + near.end,
                                 [&](const WallTouch& one) { return one.place == contact.place; });
                if (touch == touches_.begin() + near.end) continue;
                const ContactKinematics<double> k =
                    wall_kinematics(contact.normal, contact.overlap, g.grain, contact.wall_velocity,
                                    poses[near.wall].angular_velocity, 0.0);
                std::array<double, most_history> history = touch->history;
                contacts.push_back({near.grain, near.wall, contact.place, true, contact.overlap,
                                    contact_arm(g.grain.radius, contact.overlap), 0, contact.normal,
                                    contact.point, load_of(law, k, history)});
            }
        }
    };
    std::visit(loop, laws);
}

double WallContacts::displacement(std::span<const WallPose> poses) const {
    double greatest = 0;
    for (std::size_t w = 0; w < poses.size(); ++w) {
        const WallPose& from = listed_poses_[w];
        greatest =
            std::max(greatest, greatest_displacement(from, poses[w], from.centre + from.shift, farthest_[w]));
    }
    return greatest;
}

}  // namespace talus::dem
