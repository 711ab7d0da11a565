#include "physics/rigid/contacts.hpp"

#include <algorithm>
#include <cmath>

namespace talus::rigid {

namespace {

/// Where the contact spheres of a body are.
class Placed {
  public:
    Placed(const Body& body, const State& state, const Vector3<>& image = {})
        : body_(body), axes_(state.orientation), centre_(state.centre + image) {}

    Vector3<> arm(std::uint32_t sphere) const { return axes_.turned(body_.spheres[sphere].place); }
    Vector3<> centre() const { return centre_; }
    /// Whether a sphere may reach one of the body's.
    bool is_near(const Vector3<>& place, double radius) const {
        const Vector3<> p = axes_.turned_back(place - centre_);
        const double reach = radius + body_.spheres.front().radius;
        return p.x > body_.lower.x - reach && p.x < body_.upper.x + reach && p.y > body_.lower.y - reach &&
               p.y < body_.upper.y + reach && p.z > body_.lower.z - reach && p.z < body_.upper.z + reach;
    }

  private:
    const Body& body_;
    dem::RotationMatrix axes_;
    Vector3<> centre_;
};

}  // namespace

/// A contact: what of it does not depend on the law.
struct Contacts::Touch {
    std::uint64_t first, second;  ///< as in its record
    std::uint32_t part;           ///< of the second: contacts of one share the masses
    dem::ContactKinematics<double> kinematics;
    Vector3<> first_arm, second_arm;  ///< from the centres of mass to where they touch
};

std::vector<dem::WallPose> Contacts::poses_at(double time) const {
    std::vector<dem::WallPose> poses;
    for (const dem::Wall& wall : walls_) poses.push_back(wall.motion.pose(time));
    return poses;
}

void Contacts::list(std::span<const State> states, double time, double reach) {
    groups_.clear();
    const std::vector<dem::WallPose> poses = poses_at(time);
    for (std::uint32_t a = 0; a < bodies_.size(); ++a) {
        if (bodies_[a].spheres.empty()) continue;
        for (std::uint32_t b = a + 1; b < bodies_.size(); ++b)
            if (!bodies_[b].spheres.empty()) list_pair(states, a, b, reach);
        for (std::uint32_t w = 0; w < walls_.size(); ++w) list_wall(states[a], a, w, poses[w], reach);
    }
}

void Contacts::list_pair(std::span<const State> states, std::uint32_t a, std::uint32_t b, double reach) {
    Vector3<> apart = states[b].centre - states[a].centre, image;
    const std::array<double*, 3> along{&apart.x, &apart.y, &apart.z}, shift{&image.x, &image.y, &image.z};
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (box_.boundary[axis] == Boundary::periodic) {
            const double length = box_.length(static_cast<int>(axis));
            *shift[axis] = -length * std::round(*along[axis] / length);
            *along[axis] += *shift[axis];
        }
    if (norm(apart) > bodies_[a].bounding_radius + bodies_[b].bounding_radius + reach) return;
    const Placed first(bodies_[a], states[a]), second(bodies_[b], states[b], image);
    const auto candidates = [&](std::uint32_t body, const Placed& own, const Placed& other) {
        std::vector<std::uint32_t> spheres;
        for (std::uint32_t s = 0; s < bodies_[body].spheres.size(); ++s)
            if (other.is_near(own.centre() + own.arm(s), bodies_[body].spheres[s].radius + reach))
                spheres.push_back(s);
        return spheres;
    };
    Group group{a, b, false, image, {}};
    const std::vector<std::uint32_t> of_second = candidates(b, second, first);
    std::vector<Vector3<>> places;
    for (const std::uint32_t t : of_second) places.push_back(second.centre() + second.arm(t));
    for (const std::uint32_t s : candidates(a, first, second)) {
        const Vector3<> place = first.centre() + first.arm(s);
        for (std::size_t k = 0; k < of_second.size(); ++k) {
            const std::uint32_t t = of_second[k];
            const double limit = bodies_[a].spheres[s].radius + bodies_[b].spheres[t].radius + reach;
            const Vector3<> r = place - places[k];
            if (dot(r, r) < limit * limit) group.spheres.push_back({s, t});
        }
    }
    if (!group.spheres.empty()) groups_.push_back(std::move(group));
}

void Contacts::list_wall(const State& state, std::uint32_t body, std::uint32_t wall,
                         const dem::WallPose& pose, double reach) {
    if (!may_touch(walls_[wall], pose, state.centre, bodies_[body].bounding_radius, reach)) return;
    const Placed placed(bodies_[body], state);
    Group group{body, wall, true, {}, {}};
    for (std::uint32_t s = 0; s < bodies_[body].spheres.size(); ++s)
        if (may_touch(walls_[wall], pose, placed.centre() + placed.arm(s), bodies_[body].spheres[s].radius,
                      reach))
            group.spheres.push_back({s, 0});
    if (!group.spheres.empty()) groups_.push_back(std::move(group));
}

/// Contacts of a group within reach of their law, with the masses not yet shared.
template <class Table>
std::vector<Contacts::Touch> Contacts::find_touches(const Table& table, const Group& group,
                                                    std::span<const State> states,
                                                    std::span<const dem::WallPose> poses) const {
    const Body& a = bodies_[group.body];
    const State& moving = states[group.body];
    const Placed first(a, moving);
    const Vector3<> turning = angular_velocity(a, moving);
    const auto grain = [](const Body& body, const State& state, const Vector3<>& spin, const Vector3<>& arm,
                          double radius) {
        return dem::Grain<double>{state.velocity + cross(spin, arm), spin, radius, body.mass};
    };
    std::vector<Touch> touches;
    if (group.at_wall) {
        const dem::Wall& wall = walls_[group.other];
        const dem::WallPose& pose = poses[group.other];
        const auto& law = table.pairs(a.material, wall.material);
        std::vector<dem::WallContact> found;
        for (const auto& [s, none] : group.spheres) {
            const Vector3<> arm = first.arm(s);
            const double radius = a.spheres[s].radius;
            find_wall_contacts(wall, pose, moving.centre + arm, radius, law.reach(radius), found);
            for (const dem::WallContact& contact : found)
                touches.push_back(
                    {a.spheres[s].id,
                     dem::wall_key(group.other, contact.place),
                     contact.place,
                     wall_kinematics(contact.normal, contact.overlap, grain(a, moving, turning, arm, radius),
                                     contact.wall_velocity, pose.angular_velocity, 0.0),
                     contact.point - moving.centre,
                     {}});
        }
        return touches;
    }
    const Body& b = bodies_[group.other];
    const State& other = states[group.other];
    const Placed second(b, other, group.image);
    const Vector3<> other_turning = angular_velocity(b, other);
    const auto& law = table.pairs(a.material, b.material);
    for (const auto& [s, t] : group.spheres) {
        const Vector3<> arm = first.arm(s), other_arm = second.arm(t),
                        separation = moving.centre + arm - (second.centre() + other_arm);
        const double r = a.spheres[s].radius, q = b.spheres[t].radius, distance = norm(separation);
        if (distance == 0 || distance > r + q + law.reach(r * q / (r + q))) continue;
        const auto k = grain_kinematics(separation, distance, grain(a, moving, turning, arm, r),
                                        grain(b, other, other_turning, other_arm, q), 0.0);
        touches.push_back({a.spheres[s].id, b.spheres[t].id, 0, k,
                           arm - dem::contact_arm(r, k.overlap) * k.normal,
                           other_arm + dem::contact_arm(q, k.overlap) * k.normal});
    }
    return touches;
}

std::vector<Load> Contacts::loads(std::span<const State> states, double time, double time_step) {
    std::vector<Load> sums(bodies_.size());
    std::vector<dem::ContactRecord> next;
    const std::vector<dem::WallPose> poses = poses_at(time);
    const dem::ContactRecordMap known(records_);
    const auto add = [&](const auto& table) {
        using Law = typename std::decay_t<decltype(table)>::Law;
        static_assert(Law::history_count <= dem::most_history);
        for (const Group& group : groups_) {
            const auto& law =
                table.pairs(bodies_[group.body].material,
                            group.at_wall ? walls_[group.other].material : bodies_[group.other].material);
            const std::vector<Touch> touches = find_touches(table, group, states, poses);
            for (const Touch& touch : touches) {
                const auto together = std::ranges::count(touches, touch.part, &Touch::part);
                dem::ContactKinematics<double> k = touch.kinematics;
                k.effective_mass /= static_cast<double>(together);
                k.effective_inertia /= static_cast<double>(together);
                k.time_step = time_step;
                typename Law::History history{};
                if (const dem::ContactRecord* record = known.find(touch.first, touch.second))
                    std::copy_n(record->history.begin(), history.size(), history.begin());
                const dem::ContactLoad<double> load = law(k, history);
                dem::ContactRecord record{touch.first, touch.second, {}};
                std::copy(history.begin(), history.end(), record.history.begin());
                next.push_back(record);
                Load& sum = sums[group.body];
                sum.force += load.force;
                sum.torque += load.couple + cross(touch.first_arm, load.force);
                if (group.at_wall) continue;
                sums[group.other].force += -load.force;
                sums[group.other].torque += -load.couple - cross(touch.second_arm, load.force);
            }
        }
    };
    std::visit(add, laws_);
    if (time_step > 0) records_ = std::move(next);
    return sums;
}

double Contacts::greatest_frequency() const {
    constexpr double tested_overlap = 0.05;  // of the radius: Hertzian contacts stiffen with it
    std::vector<double> square(bodies_.size());
    const auto add_up = [&](const auto& table) {
        for (const Group& group : groups_) {
            const Body& a = bodies_[group.body];
            const double r = a.spheres[group.spheres.front()[0]].radius,
                         q = group.at_wall ? r
                                           : bodies_[group.other].spheres[group.spheres.front()[1]].radius;
            dem::ContactKinematics<double> k{};
            k.effective_radius = group.at_wall ? r : r * q / (r + q);
            k.overlap = tested_overlap * std::min(r, q);
            k.effective_mass = a.mass;
            const auto& law = table.pairs(
                a.material, group.at_wall ? walls_[group.other].material : bodies_[group.other].material);
            const auto response = law.elasticity(k, 1.0);
            const double stiffness = static_cast<double>(group.spheres.size()) *
                                     (1.5 * response.normal_stiffness + 2 * response.tangential_stiffness);
            const auto add = [&](const Body& body, std::uint32_t at) {
                const double arm = body.bounding_radius,
                             least = std::min({body.inertia.x, body.inertia.y, body.inertia.z});
                square[at] += stiffness * (1 / body.mass + arm * arm / least);
            };
            add(a, group.body);
            if (!group.at_wall) add(bodies_[group.other], group.other);
        }
    };
    std::visit(add_up, laws_);
    // Two bodies that swing against each other have no more than both together.
    double greatest = 0;
    for (const double s : square) greatest = std::max(greatest, s);
    return std::sqrt(2 * greatest);
}

Contacts::Overlap Contacts::greatest_overlap(std::span<const State> states, double time) const {
    Overlap greatest;
    const std::vector<dem::WallPose> poses = poses_at(time);
    const auto look = [&](const auto& table) {
        for (const Group& group : groups_)
            for (const Touch& touch : find_touches(table, group, states, poses)) {
                const double radius = bodies_[group.body].spheres.front().radius,
                             other = group.at_wall ? radius : bodies_[group.other].spheres.front().radius,
                             share = touch.kinematics.overlap / std::min(radius, other);
                if (share > greatest.share)
                    greatest = {share, group.body,
                                group.at_wall ? walls_[group.other].name : bodies_[group.other].name};
            }
    };
    std::visit(look, laws_);
    return greatest;
}

}  // namespace talus::rigid
