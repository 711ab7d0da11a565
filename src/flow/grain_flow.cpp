#include "src/flow/grain_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/boundary.hpp"
#include "domain/clump_fields.hpp"
#include "domain/grain_fields.hpp"
#include "domain/random.hpp"

namespace talus {

namespace {

double sphere_mass(double radius, double density) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;
}

/// Brought back into the box.
Point inside(const Box& box, Point place) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (box.boundary[axis] == Boundary::periodic)
            place[axis] = wrapped(place[axis], box.lower[axis], box.upper[axis]);
    return place;
}

bool overlap(const Box& box, const Point& a, double radius_a, const Point& b, double radius_b) {
    double distance2 = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double d = a[axis] - b[axis];
        if (box.boundary[axis] == Boundary::periodic) {
            const double length = box.upper[axis] - box.lower[axis];
            d -= length * std::nearbyint(d / length);
        }
        distance2 += d * d;
    }
    return distance2 < (radius_a + radius_b) * (radius_a + radius_b);
}

/// Finds what is in the cells around a place.
class Nearby {
  public:
    explicit Nearby(const CellGrid& grid) : grid_(grid) {}
    void add(const Point& place, std::uint32_t item) { items_[key_of(cell(place))].push_back(item); }
    template <class Visit>
    void visit(const Point& place, Visit&& visit) const {
        const Cell centre = cell(place);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    Cell other{centre[0] + x, centre[1] + y, centre[2] + z};
                    for (int axis = 0; axis < 3; ++axis)
                        if (const int count = grid_.cell_count(axis); count > 0) {
                            int& index = other[static_cast<std::size_t>(axis)];
                            index = (index + count) % count;
                        }
                    const auto found = items_.find(key_of(other));
                    if (found == items_.end()) continue;
                    for (const std::uint32_t item : found->second) visit(item);
                }
    }

  private:
    Cell cell(const Point& place) const {
        return {grid_.index_along(0, place[0]), grid_.index_along(1, place[1]),
                grid_.index_along(2, place[2])};
    }
    const CellGrid& grid_;
    std::unordered_map<CellKey, std::vector<std::uint32_t>> items_;
};

bool touches_wall(const FlowMoment& now, const Point& place, double radius) {
    std::vector<dem::WallContact> found;
    for (std::size_t w = 0; w < now.walls.size(); ++w) {
        dem::find_wall_contacts(now.walls[w], now.poses[w], {place[0], place[1], place[2]}, radius, 0, found);
        for (const dem::WallContact& contact : found)
            if (contact.overlap > 0) return true;
    }
    return false;
}

}  // namespace

/// A grain that is due and a place where it might go.
struct GrainFlow::Candidate {
    std::size_t source;
    std::uint64_t attempt;
    Point place;
    dem::Quaternion orientation;
    std::uint32_t first;  ///< of its spheres
};

struct GrainFlow::Candidates {
    struct Sphere {
        Point place;
        double radius;
        std::uint32_t candidate;
    };
    std::vector<Candidate> grains;
    std::vector<Sphere> spheres;

    void add(const Box& box, const Candidate& grain, const dem::ClumpShape* clump, double radius) {
        grains.push_back(grain);
        grains.back().first = static_cast<std::uint32_t>(spheres.size());
        const auto index = static_cast<std::uint32_t>(grains.size() - 1);
        if (!clump) {
            spheres.push_back({grain.place, radius, index});
            return;
        }
        const dem::RotationMatrix axes(grain.orientation);
        for (std::size_t k = 0; k < clump->radii.size(); ++k) {
            const dem::Vector3<> arm = axes.turned(clump->centres[k]);
            spheres.push_back(
                {inside(box, plus(grain.place, {arm.x, arm.y, arm.z})), clump->radii[k], index});
        }
    }
    std::span<const Sphere> spheres_of(std::size_t k) const {
        const std::size_t end = k + 1 < grains.size() ? grains[k + 1].first : spheres.size();
        return std::span(spheres).subspan(grains[k].first, end - grains[k].first);
    }
};

double GrainSource::greatest_radius() const {
    return clump ? std::ranges::max(clump->radii) : sizes.greatest;
}

GrainFlow::GrainFlow(const Communicator& comm, const Box& box, GrainFlowPlan plan, double largest_radius)
    : comm_(comm),
      plan_(std::move(plan)),
      grid_(box, largest_radius > 0 ? 2 * largest_radius : 1, 1),
      passed_(plan_.sinks.size()),
      came_(plan_.sources.size()),
      noted_(plan_.sources.size(), false) {}

void GrainFlow::begin(const ParticleSet& grains, const dem::ClumpMotion& clumps) {
    first_count_ = next_id_ = 0;
    const std::uint64_t* id = grains.data(field::id);
    const std::uint8_t* body = grains.data(field::body);
    for (std::size_t i = 0; i < grains.size(); ++i) {
        next_id_ = std::max(next_id_, id[i] + 1);
        if (clumps.counts(body[i], id[i])) ++first_count_;
    }
    first_count_ = comm_.all_sum(first_count_);
    next_id_ = comm_.all_max(next_id_);
}

void GrainFlow::save(std::map<std::string, double>& numbers) const {
    if (plan_.empty()) return;
    numbers["flow.first_count"] = static_cast<double>(first_count_);
    numbers["flow.next_id"] = static_cast<double>(next_id_);
    for (std::size_t s = 0; s < passed_.size(); ++s) {
        const std::string prefix = "sink." + plan_.sinks[s].name;
        numbers[prefix + ".count"] = static_cast<double>(passed_[s].count);
        numbers[prefix + ".mass"] = passed_[s].mass;
    }
    for (std::size_t s = 0; s < came_.size(); ++s) {
        const std::string prefix = "source." + plan_.sources[s].name;
        numbers[prefix + ".count"] = static_cast<double>(came_[s].count);
        numbers[prefix + ".mass"] = came_[s].mass;
        numbers[prefix + ".missed"] = static_cast<double>(came_[s].missed);
        numbers[prefix + ".attempts"] = static_cast<double>(came_[s].attempts);
        numbers[prefix + ".due"] = came_[s].due;
    }
}

void GrainFlow::restore(const std::map<std::string, double>& numbers, double time, const ParticleSet& grains,
                        const dem::ClumpMotion& clumps) {
    begin(grains, clumps);
    for (std::size_t s = 0; s < came_.size(); ++s)  // what a new source was not there to insert is not due
        came_[s].due = plan_.sources[s].rate * std::max(time - plan_.sources[s].begin, 0.0);
    if (plan_.empty() || !numbers.contains("flow.first_count")) return;
    const std::uint64_t total = first_count_;
    const auto stored = [&](const std::string& name) {
        const auto found = numbers.find(name);
        return found == numbers.end() ? 0.0 : found->second;
    };
    const auto count = [&](const std::string& name) { return static_cast<std::uint64_t>(stored(name)); };
    first_count_ = count("flow.first_count");
    next_id_ = count("flow.next_id");
    std::uint64_t expected = first_count_;
    for (std::size_t s = 0; s < passed_.size(); ++s) {
        const std::string prefix = "sink." + plan_.sinks[s].name;
        passed_[s] = {count(prefix + ".count"), stored(prefix + ".mass")};
        expected -= passed_[s].count;
    }
    for (std::size_t s = 0; s < came_.size(); ++s) {
        const std::string prefix = "source." + plan_.sources[s].name;
        if (!numbers.contains(prefix + ".due")) continue;
        came_[s] = {count(prefix + ".count"), count(prefix + ".missed"), count(prefix + ".attempts"),
                    stored(prefix + ".mass"), stored(prefix + ".due")};
        expected += came_[s].count;
    }
    if (expected != total)
        throw AgreedError(1,
                          fmt::format("the checkpoint holds {} grains; those that the run began with, those "
                                      "inserted and those deleted come to {}: are its [[sink]] and "
                                      "[[source]] those of this scene?",
                                      total, expected));
}

bool GrainFlow::due(std::uint64_t step) const {
    const auto acts = [step](const auto& one) { return step % one.interval == 0; };
    return std::any_of(plan_.sinks.begin(), plan_.sinks.end(), acts) ||
           std::any_of(plan_.sources.begin(), plan_.sources.end(), acts);
}

GrainFlow::Change GrainFlow::apply(ParticleSet& grains, const FlowMoment& now) {
    Change change;
    change.removed = remove(grains, now);
    change.added = insert(grains, now);
    return change;
}

Decomposition::Ledger GrainFlow::remove(ParticleSet& grains, const FlowMoment& now) {
    std::vector<std::size_t> acting;
    for (std::size_t s = 0; s < plan_.sinks.size(); ++s)
        if (const GrainSink& sink = plan_.sinks[s];
            now.step % sink.interval == 0 && now.time >= sink.begin && now.time < sink.end)
            acting.push_back(s);
    if (acting.empty()) return {};
    const std::uint8_t* body = grains.data(field::body);
    std::vector<std::uint32_t> kept;
    std::vector<std::uint64_t> counts(passed_.size() + 2);  // of each sink; of spheres, sum of their ids
    std::vector<ExactSum> masses(passed_.size());
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const Point place = place_in_box(grains, i, grid_.box(), now.clumps);
        const auto taker = std::find_if(acting.begin(), acting.end(), [&](std::size_t s) {
            return !now.held[body[i]] && plan_.sinks[s].region.contains(place);
        });
        if (taker == acting.end()) {
            kept.push_back(static_cast<std::uint32_t>(i));
            continue;
        }
        const std::uint64_t id = grains.data(field::id)[i];
        ++counts[passed_.size()];
        counts.back() += id;
        if (!now.clumps.counts(body[i], id)) continue;
        ++counts[*taker];
        masses[*taker].add(grains.data(field::mass)[i]);
    }
    comm_.all_sum(std::span<std::uint64_t>(counts));
    const Decomposition::Ledger removed{{counts[passed_.size()], counts.back()}};
    if (removed.count() == 0) return {};
    ExactSum::all_reduce(comm_, masses);
    for (std::size_t s = 0; s < passed_.size(); ++s) {
        passed_[s].count += counts[s];
        passed_[s].mass += masses[s].value();
    }
    grains.reorder(kept);
    return removed;
}

RandomStream GrainFlow::random(std::size_t source) const {
    return {plan_.seed, RandomPurpose::sources, static_cast<std::uint16_t>(source)};
}

namespace {
constexpr std::uint32_t beyond_places = 1U << 31;
}

double GrainFlow::radius_of(std::size_t source, std::uint64_t attempt) const {
    return plan_.sources[source].sizes.radius(random(source), attempt, beyond_places);
}

double GrainFlow::mass_of(std::size_t source, std::uint64_t attempt) const {
    const GrainSource& s = plan_.sources[source];
    return s.clump ? s.density * s.clump->volume : sphere_mass(radius_of(source, attempt), s.density);
}

double GrainFlow::amount_of(std::size_t source, std::uint64_t attempt) const {
    return plan_.sources[source].by_mass ? mass_of(source, attempt) : 1;
}

dem::Quaternion GrainFlow::orientation_of(std::size_t source, std::uint64_t attempt) const {
    if (!plan_.sources[source].turned) return {};
    std::array<double, 3> numbers{};
    for (std::uint32_t k = 0; k < 3; ++k) numbers[k] = random(source).uniform(attempt, beyond_places + k);
    return dem::evenly_spread_rotation(numbers);
}

bool GrainFlow::complete(std::size_t source) const {
    const Came& came = came_[source];
    const double there = plan_.sources[source].by_mass ? came.mass : static_cast<double>(came.count);
    return there + amount_of(source, came.attempts) > plan_.sources[source].total;
}

bool GrainFlow::inserting(double time) const {
    for (std::size_t s = 0; s < came_.size(); ++s)
        if (plan_.sources[s].begin < std::max(time, 0.0) && time < plan_.sources[s].end && !complete(s))
            return true;
    return false;
}

/// Appends a source's grains that are due, each with all places that may be tried.
void GrainFlow::draw_due(std::size_t s, const FlowMoment& now, Candidates& candidates) {
    const GrainSource& source = plan_.sources[s];
    Came& came = came_[s];
    const double elapsed = std::min(now.time, source.end) - source.begin;
    if (now.step % source.interval != 0 || elapsed <= 0) return;
    constexpr std::uint32_t most_draws = 100;  // for a place inside of the region
    const BoxShape around = bounds(source.region, 3);
    const Box& box = grid_.box();
    const auto draw = [&](std::uint64_t attempt, std::uint32_t number) {
        Point place{};
        for (std::uint32_t a = 0; a < 3; ++a) {
            const double share = random(s).uniform(attempt, 3 * number + a);
            place[a] = around.lower[a] + (around.upper[a] - around.lower[a]) * share;
        }
        return place;
    };
    double there = source.by_mass ? came.mass : static_cast<double>(came.count);
    for (;; ++came.attempts) {
        const double amount = amount_of(s, came.attempts);
        if (came.due + amount > source.rate * elapsed || there + amount > source.total) return;
        came.due += amount;
        there += amount;
        const double radius = source.clump ? 0 : radius_of(s, came.attempts);
        const dem::Quaternion orientation = orientation_of(s, came.attempts);
        for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(source.tries); ++t) {
            Point place = draw(came.attempts, t * most_draws);
            for (std::uint32_t d = 1; d < most_draws && !contains(source.region, place, 3); ++d)
                place = draw(came.attempts, t * most_draws + d);
            if (!contains(source.region, place, 3)) continue;
            for (int axis = 0; axis < 3; ++axis)
                place[static_cast<std::size_t>(axis)] =
                    now.places(axis, place[static_cast<std::size_t>(axis)]);
            place = inside(box, place);
            candidates.add(box, {s, came.attempts, place, orientation, 0}, source.clump.get(), radius);
        }
    }
}

Decomposition::Ledger GrainFlow::insert(ParticleSet& grains, const FlowMoment& now) {
    Candidates candidates;
    for (std::size_t s = 0; s < plan_.sources.size(); ++s) draw_due(s, now, candidates);
    const std::vector<Candidate>& wanted = candidates.grains;
    const std::vector<Candidates::Sphere>& spheres = candidates.spheres;
    if (wanted.empty()) return {};  // on every rank
    const Box& box = grid_.box();
    Nearby near(grid_);
    for (std::size_t k = 0; k < spheres.size(); ++k)
        near.add(spheres[k].place, static_cast<std::uint32_t>(k));
    std::vector<int> blocked(wanted.size());
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const Point place = sphere_in_box(grains, i, box);
        const double radius = grains.data(field::radius)[i];
        near.visit(place, [&](std::uint32_t k) {
            if (overlap(box, place, radius, spheres[k].place, spheres[k].radius))
                blocked[spheres[k].candidate] = 1;
        });
    }
    comm_.all_max(std::span<int>(blocked));

    // From here on every rank does the same.
    Nearby taken(grid_);
    std::vector<std::size_t> accepted;
    const auto is_free = [&](const Candidates::Sphere& sphere) {
        bool is = true;
        taken.visit(sphere.place, [&](std::uint32_t k) {
            is = is && !overlap(box, sphere.place, sphere.radius, spheres[k].place, spheres[k].radius);
        });
        return is && !touches_wall(now, sphere.place, sphere.radius);
    };
    std::vector<std::uint64_t> missed(came_.size());
    for (std::size_t k = 0; k < wanted.size();) {
        const Candidate& first = wanted[k];
        bool placed = false;
        for (; k < wanted.size() && wanted[k].source == first.source && wanted[k].attempt == first.attempt;
             ++k) {
            const std::span<const Candidates::Sphere> own = candidates.spheres_of(k);
            if (placed || blocked[k] || !std::ranges::all_of(own, is_free)) continue;
            placed = true;
            for (const Candidates::Sphere& sphere : own)
                taken.add(sphere.place, static_cast<std::uint32_t>(&sphere - spheres.data()));
            accepted.push_back(k);
        }
        if (!placed) ++missed[first.source];
    }
    for (std::size_t s = 0; s < came_.size(); ++s) {
        came_[s].missed += missed[s];
        if (missed[s] == 0 || noted_[s]) continue;
        noted_[s] = true;
        notes_.push_back(fmt::format(
            "source '{}' is full at {:.6g} s: {} of the grains due found no place in {} tries; "
            "from now on the column missed_{} counts them",
            plan_.sources[s].name, now.time, missed[s], plan_.sources[s].tries, plan_.sources[s].name));
    }

    Decomposition::Ledger added;
    if (accepted.empty()) return added;  // the set stays as it is, with its copies
    const std::size_t before = grains.size();
    grains.resize(before);  // copies would be taken for new grains
    for (const std::size_t k : accepted) put(wanted[k], now, grains, added);
    now.clumps.start(grains, now.places, before);
    return added;
}

/// Makes a grain, or the spheres of a clump, each on one rank.
void GrainFlow::put(const Candidate& grain, const FlowMoment& now, ParticleSet& grains,
                    Decomposition::Ledger& added) {
    const GrainSource& source = plan_.sources[grain.source];
    const dem::ClumpBody* clump = now.clumps.of_body(source.body);
    const double mass = mass_of(grain.source, grain.attempt);
    ++came_[grain.source].count;
    came_[grain.source].mass += mass;
    const std::uint64_t first = clump ? clump->first_from(next_id_) : next_id_;
    next_id_ = first + (clump ? clump->shape->radii.size() : 1);
    for (std::uint64_t id = first; id < next_id_; ++id) {
        ++added.sums[0];
        added.sums[1] += id;
        if (id % static_cast<std::uint64_t>(comm_.size()) != static_cast<std::uint64_t>(comm_.rank()))
            continue;
        const std::size_t i = grains.size();
        grains.resize(i + 1);
        grains.data(field::id)[i] = id;
        grains.data(field::body)[i] = source.body;
        const auto set = [&](const Field<double>& field, const Point& value) {
            for (int axis = 0; axis < 3; ++axis)
                grains.data(field, axis)[i] = value[static_cast<std::size_t>(axis)];
        };
        const Point gravity{now.gravity.x, now.gravity.y, now.gravity.z};
        if (clump) {
            const auto vector = [](const Point& p) { return dem::Vector3<>{p[0], p[1], p[2]}; };
            dem::place_new_sphere(
                grains, i, *clump, id - first,
                dem::moving_clump(*clump, vector(grain.place), grain.orientation, vector(source.velocity),
                                  vector(source.angular_velocity)));
            set(field::clump_acceleration, gravity);
            continue;
        }
        grains.data(field::radius)[i] = radius_of(grain.source, grain.attempt);
        grains.data(field::mass)[i] = mass;
        set(field::position, grain.place);
        set(field::velocity, source.velocity);
        set(field::angular_velocity, source.angular_velocity);
        set(field::acceleration, gravity);
    }
}

std::vector<std::string> GrainFlow::take_notes() { return std::exchange(notes_, {}); }

}  // namespace talus
