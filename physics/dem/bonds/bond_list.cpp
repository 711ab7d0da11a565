#include "physics/dem/bonds/bond_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "domain/grain_fields.hpp"
#include "physics/dem/vectors.hpp"

namespace talus::dem {

namespace {

static_assert(bond_values == 3 + BeamBond::history_count);
constexpr std::uint32_t nowhere = ~std::uint32_t{0};

using GrainVectors = Vectors<const ParticleSet>;

/// Where the grains and copies of each id are stored.
class Places {
  public:
    explicit Places(const ParticleSet& grains) : grains_(grains), positions_(grains, field::position) {
        const std::uint64_t* id = grains.data(field::copied_id);
        places_.reserve(grains.size_with_halo());
        for (std::uint32_t i = 0; i < grains.size_with_halo(); ++i) places_.push_back({id[i], i});
        std::sort(places_.begin(), places_.end());
    }
    /// The own grain, if it is one.
    std::uint32_t own(std::uint64_t id) const {
        const auto at = std::lower_bound(places_.begin(), places_.end(), std::pair{id, std::uint32_t{0}});
        return at != places_.end() && at->first == id && at->second < grains_.size() ? at->second : nowhere;
    }
    /// The grain or image of it that is nearest to grain `i`.
    std::uint32_t nearest(std::uint64_t id, std::uint32_t i) const {
        std::uint32_t found = nowhere;
        double least = std::numeric_limits<double>::infinity();
        const Vector3<> from = positions_[i];
        for (auto at = std::lower_bound(places_.begin(), places_.end(), std::pair{id, std::uint32_t{0}});
             at != places_.end() && at->first == id; ++at) {
            const Vector3<> r = positions_[at->second] - from;
            if (const double distance2 = dot(r, r); distance2 < least) {
                least = distance2;
                found = at->second;
            }
        }
        return found;
    }

  private:
    const ParticleSet& grains_;
    GrainVectors positions_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> places_;
};

double inertia_of(const Grain<double>& grain) { return 0.4 * grain.mass * grain.radius * grain.radius; }

}  // namespace

double greatest_bond_reach(std::span<const BondRule> rules, double largest_radius) {
    double reach = 0;
    for (const BondRule& rule : rules)
        reach = std::max(reach, (most_stretched * (2 + rule.gap) - 2) * largest_radius);
    return reach;
}

double greatest_bond_force(std::span<const BondRule> rules, double radius) {
    double force = 0;
    for (const BondRule& rule : rules) {
        const double section = rule.radius_factor * radius;
        force = std::max(force, rule.material.youngs_modulus * std::numbers::pi * section * section);
    }
    return force;
}

const BondRule* BondList::rule_of(std::uint8_t a, std::uint8_t b, std::size_t& index) const {
    const std::array<std::uint8_t, 2> bodies{std::min(a, b), std::max(a, b)};
    for (index = 0; index < rules_.size(); ++index)
        if (rules_[index].bodies == bodies) return &rules_[index];
    return nullptr;
}

BondList::Bond BondList::bond_of(const BondRecord& record) const {
    const auto table = static_cast<std::size_t>(record.history[0]);
    return {.record = record,
            .beam = BeamBond(rules_.at(table).material, record.history[2], record.history[1])};
}

void BondList::join(const ParticleSet& grains, const ContactList& near) {
    const std::uint8_t* body = grains.data(field::body);
    const double* radius = grains.data(field::radius);
    const std::uint64_t* id = grains.data(field::copied_id);
    const GrainVectors positions(grains, field::position);
    for (std::size_t p = 0; p < near.size(); ++p) {
        const std::uint32_t i = near.first[p], j = near.second[p];
        std::size_t table = 0;
        const BondRule* rule = rule_of(body[i], body[j], table);
        if (!rule) continue;
        const double length = norm(positions[i] - positions[j]);
        const double smaller = std::min(radius[i], radius[j]);
        if (length - (radius[i] + radius[j]) > rule->gap * smaller) continue;
        bonds_.push_back(
            bond_of({id[i], id[j], {static_cast<double>(table), length, rule->radius_factor * smaller}}));
    }
}

void BondList::adopt(const std::vector<BondRecord>& records) {
    bonds_.clear();
    for (const BondRecord& record : records) bonds_.push_back(bond_of(record));
}

std::optional<std::array<std::uint64_t, 2>> BondList::list(const ParticleSet& grains) {
    std::vector<BondRecord> known = records();
    std::sort(known.begin(), known.end(), is_before<bond_values>);
    const auto same = [](const BondRecord& a, const BondRecord& b) {
        return a.first == b.first && a.second == b.second;
    };
    known.erase(std::unique(known.begin(), known.end(), same), known.end());
    bonds_.clear();
    broken_ = 0;
    const Places places(grains);
    std::optional<std::array<std::uint64_t, 2>> lost;
    for (const BondRecord& record : known) {
        const std::uint32_t i = places.own(record.first), j = places.own(record.second);
        if (i == nowhere && j == nowhere) continue;
        Bond bond = bond_of(record);
        const auto add = [&](std::uint32_t first, std::uint32_t second) {
            if (first == nowhere || second == nowhere) {
                lost = {record.first, record.second};
                return;
            }
            bond.first = first;
            bond.second = second;
            bonds_.push_back(bond);
        };
        const std::uint32_t near_i = i == nowhere ? nowhere : places.nearest(record.second, i);
        if (i != nowhere) add(i, near_i);
        if (j != nowhere && near_i != j) add(places.nearest(record.first, j), j);
    }
    return lost;
}

std::function<bool(std::uint32_t, std::uint32_t)> BondList::pairs() const {
    if (bonds_.empty()) return {};
    const auto key = [](std::uint32_t i, std::uint32_t j) {
        return std::uint64_t{std::min(i, j)} << 32 | std::max(i, j);
    };
    std::vector<std::uint64_t> bonded;
    for (const Bond& bond : bonds_) bonded.push_back(key(bond.first, bond.second));
    std::sort(bonded.begin(), bonded.end());
    return [key, bonded = std::move(bonded)](std::uint32_t i, std::uint32_t j) {
        return std::binary_search(bonded.begin(), bonded.end(), key(i, j));
    };
}

void BondList::mark_copies(std::size_t own, std::span<std::uint8_t> copies) const {
    for (const Bond& bond : bonds_)
        for (const std::uint32_t i : {bond.first, bond.second})
            if (i >= own) copies[i - own] = 1;
}

BondFault BondList::evaluate(const Evaluation& evaluation, ParticleSet& grains) {
    BondFault fault;
    std::uint64_t* broken_of = grains.data(field::broken_bonds);
    const GrainVectors velocities(grains, field::half_step_velocity),
        spins(grains, field::half_step_angular_velocity);
    for (Bond& bond : bonds_) {
        if (bond.broken) continue;
        std::array<PlacedGrain<double>, 2> ends{placed_grain(evaluation.rows[bond.first]),
                                                placed_grain(evaluation.rows[bond.second])};
        const std::array<std::uint32_t, 2> places{bond.first, bond.second};
        for (std::size_t e = 0; e < 2; ++e) {
            ends[e].grain.velocity = velocities[places[e]];
            ends[e].grain.angular_velocity = spins[places[e]];
        }
        const BondKinematics k =
            bond_kinematics(ends[0].position - ends[1].position, ends[0].grain, inertia_of(ends[0].grain),
                            ends[1].grain, inertia_of(ends[1].grain), evaluation.time_step);
        BeamBond::History history;
        double* remembered = bond.record.history.data() + 3;
        std::copy_n(remembered, history.size(), history.begin());
        const BondResponse response = bond.beam(k, history);
        std::copy(history.begin(), history.end(), remembered);
        bond.broken = bond.beam.breaks(response);
        broken_ += bond.broken ? 1 : 0;

        bool bearable = true;
        for (std::size_t e = 0; e < 2; ++e) {
            if (places[e] >= grains.size()) continue;  // a copy
            broken_of[places[e]] += bond.broken ? 1 : 0;
            const ContactLoad<double>& l = response.load;
            const ContactLoad<double> load = e == 0 ? l : ContactLoad<double>{-l.force, -l.couple};
            const Vector3<> normal = e == 0 ? k.normal : -k.normal;
            const Vector3<> torque = torque_about_centre(normal, 0.5 * k.length, load);
            ForceSum& sum = evaluation.sums[places[e]];
            const double units = ends[e].units_per_force;
            const bool force_fits = add_in_units(load.force, units, sum.force);
            const bool torque_fits = add_in_units(torque, units / ends[e].grain.radius, sum.torque);
            bearable = bearable && force_fits && torque_fits;
        }
        // A bond that breaks is let go, however long it is.
        const bool lost = !bond.broken && !(k.length <= most_stretched * bond.record.history[1]);
        if ((bearable && !lost) || fault.kind != BondFault::none) continue;
        fault = {bearable ? BondFault::stretched : BondFault::overload, bond.record.first,
                 bond.record.second};
    }
    return fault;
}

std::vector<BondRecord> BondList::records() const {
    return records_below(std::numeric_limits<std::size_t>::max());
}

std::vector<BondRecord> BondList::records_below(std::size_t end) const {
    std::vector<BondRecord> records;
    for (const Bond& bond : bonds_)
        if (bond.first < end && !bond.broken) records.push_back(bond.record);
    return records;
}

std::uint64_t BondList::count_below(std::size_t end) const {
    return static_cast<std::uint64_t>(std::count_if(
        bonds_.begin(), bonds_.end(), [&](const Bond& bond) { return bond.first < end && !bond.broken; }));
}

double BondList::stable_step(const ParticleSet& grains) const {
    std::vector<int> bonds_of(grains.size());
    const auto for_each_own_end = [&](auto&& visit) {
        for (const Bond& bond : bonds_)
            for (const std::uint32_t i : {bond.first, bond.second})
                if (i < grains.size()) visit(bond, i);
    };
    for_each_own_end([&](const Bond&, std::uint32_t i) { ++bonds_of[i]; });
    const double *mass = grains.data(field::mass), *radius = grains.data(field::radius);
    double least = std::numeric_limits<double>::infinity();
    for_each_own_end([&](const Bond& bond, std::uint32_t i) {
        least = std::min(least,
                         bond.beam.stable_step(mass[i], 0.4 * mass[i] * radius[i] * radius[i], bonds_of[i]));
    });
    return least;
}

std::vector<const FieldInfo*> BondList::fields() {
    return {&field::bond_table, &field::rest_length, &field::bond_radius,
            &field::shearing,   &field::bending,     &field::twisting};
}

}  // namespace talus::dem
