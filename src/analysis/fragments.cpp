#include "src/analysis/fragments.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "comm/decomposition.hpp"
#include "comm/exact_sum.hpp"
#include "domain/partners.hpp"
#include "physics/sph/pass_support.hpp"
#include "src/analysis/selection.hpp"

namespace talus {

namespace {

/// Sets of indices that can be joined; the smallest index of a set stands for it.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
    }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t i, std::uint32_t j) {
        i = find(i);
        j = find(j);
        if (i != j) parent_[std::max(i, j)] = std::min(i, j);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// The particles that can belong to fragments, as a set of their own.
ParticleSet linkable_particles(const ParticleSet& particles, const FragmentRules& rules) {
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < particles.size(); ++i)
        if (may_link(particles, rules, i)) chosen.push_back(i);
    const FieldInfo* const fields[] = {&field::velocity, &field::mass, &field::body, &field::damage,
                                       &field::smoothing_length};
    ParticleSet linkable = selected("fragments", particles, chosen, fields);
    linkable.add(field::fragment);
    return linkable;
}

/// Joins linked particles, copies included.
template <int D>
void join_linked(const ParticleSet& intact, const CellTable& table, const FragmentRules& rules,
                 DisjointSets& sets) {
    const std::uint8_t* body = intact.data(field::body);
    std::vector<double> reach(intact.size_with_halo());
    for (std::size_t k = 0; k < reach.size(); ++k) reach[k] = rules.linking_length[body[k]];
    Partners<D> partners(sph::components<D>(intact, field::position), reach.data(), 1);
    table.for_each_own(Cells::all, [&](const CellEntry& cell, std::span<const Run> runs, std::size_t) {
        partners.enter(cell, runs);
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            if (rules.all_matter)
                partners.find_mutual(i, 1);
            else
                partners.find(i, 1);
            for (const std::uint32_t k : partners.index())
                if (rules.all_matter || body[k] == body[i]) sets.join(i, k);
        }
    });
}

/// Gives every particle and copy the smallest label of its component, over all ranks.
void spread_labels(const Communicator& comm, ParticleSet& intact, Halo& halo, DisjointSets& sets) {
    const std::size_t all = intact.size_with_halo();
    std::vector<std::uint64_t> least(all);
    std::uint64_t* label = intact.data(field::fragment);
    for (;;) {
        halo.begin(intact, {&field::fragment});
        halo.finish();
        std::copy(label, label + all, least.begin());
        for (std::uint32_t i = 0; i < all; ++i) {
            std::uint64_t& of_set = least[sets.find(i)];
            of_set = std::min(of_set, label[i]);
        }
        int changed = 0;
        for (std::uint32_t i = 0; i < intact.size(); ++i) {
            const std::uint64_t found = least[sets.find(i)];
            changed |= found != label[i];
            label[i] = found;
        }
        if (!comm.all_max(changed)) return;
    }
}

enum Sum { mass_sum, centre_sum, velocity_sum = centre_sum + 3, sum_count = velocity_sum + 3 };

/// A fragment while its particles are being added up.
struct Tally {
    std::uint8_t body = std::numeric_limits<std::uint8_t>::max();
    std::uint64_t particles = 0;
    std::array<ExactSum, sum_count> sums;

    void add(const ParticleSet& intact, std::size_t i) {
        const double mass = intact.data(field::mass)[i];
        body = std::min(body, intact.data(field::body)[i]);
        ++particles;
        sums[mass_sum].add(mass);
        for (int a = 0; a < intact.dimension(); ++a) {
            const auto axis = static_cast<std::size_t>(a);
            sums[centre_sum + axis].add(mass * intact.data(field::position, a)[i]);
            sums[velocity_sum + axis].add(mass * intact.data(field::velocity, a)[i]);
        }
    }
    Fragment fragment(std::uint64_t label) const {
        Fragment result{label, body, particles, sums[mass_sum].value(), {}, {}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            result.centre[axis] = sums[centre_sum + axis].value() / result.mass;
            result.velocity[axis] = sums[velocity_sum + axis].value() / result.mass;
        }
        return result;
    }
};

/// Labels of fragments that reach over borders of ranks, the same sorted list on every rank: those with own
/// particles and copies somewhere.
std::vector<std::uint64_t> shared_labels(const Communicator& comm, const ParticleSet& intact,
                                         const std::vector<std::uint64_t>& own_labels) {
    const std::uint64_t* label = intact.data(field::fragment);
    std::vector<std::uint64_t> shared;
    for (std::size_t i = intact.size(); i < intact.size_with_halo(); ++i)
        if (std::binary_search(own_labels.begin(), own_labels.end(), label[i])) shared.push_back(label[i]);
    const auto unique = [](std::vector<std::uint64_t>& labels) {
        std::sort(labels.begin(), labels.end());
        labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    };
    unique(shared);
    shared = comm.all_gather(std::span<const std::uint64_t>(shared));
    unique(shared);
    return shared;
}

/// Own particles in order of label.
class ByLabel {
  public:
    explicit ByLabel(const ParticleSet& intact) : intact_(intact), order_(intact.size()) {
        std::iota(order_.begin(), order_.end(), std::uint32_t{0});
        const std::uint64_t* label = intact.data(field::fragment);
        std::sort(order_.begin(), order_.end(), [label](auto i, auto j) { return label[i] < label[j]; });
        for (const std::uint32_t i : order_)
            if (labels_.empty() || labels_.back() != label[i]) labels_.push_back(label[i]);
    }
    const std::vector<std::uint64_t>& labels() const { return labels_; }
    /// Adds up this rank's part of a fragment.
    Tally tally(std::uint64_t wanted) const {
        const std::uint64_t* label = intact_.data(field::fragment);
        Tally result;
        for (auto at = std::lower_bound(order_.begin(), order_.end(), wanted,
                                        [label](std::uint32_t i, std::uint64_t l) { return label[i] < l; });
             at != order_.end() && label[*at] == wanted; ++at)
            result.add(intact_, *at);
        return result;
    }

  private:
    const ParticleSet& intact_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint64_t> labels_;
};

/// Adds up fragments that several ranks hold parts of; a few at a time, for exact sums are large.
void reduce_shared(const Communicator& comm, const ByLabel& own, std::span<const std::uint64_t> labels,
                   std::vector<Fragment>& fragments) {
    constexpr std::size_t at_once = 1024;
    for (std::size_t begin = 0; begin < labels.size(); begin += at_once) {
        const auto part = labels.subspan(begin, std::min(at_once, labels.size() - begin));
        std::vector<ExactSum> sums;
        std::vector<std::uint64_t> counts, bodies;
        for (const std::uint64_t label : part) {
            const Tally mine = own.tally(label);
            sums.insert(sums.end(), mine.sums.begin(), mine.sums.end());
            counts.push_back(mine.particles);
            bodies.push_back(mine.body);
        }
        ExactSum::all_reduce(comm, sums);
        comm.all_sum(std::span<std::uint64_t>(counts));
        comm.all_min(std::span<std::uint64_t>(bodies));
        for (std::size_t k = 0; k < part.size(); ++k) {
            Tally total{static_cast<std::uint8_t>(bodies[k]), counts[k], {}};
            std::copy_n(sums.begin() + static_cast<std::ptrdiff_t>(k * sum_count), sum_count,
                        total.sums.begin());
            fragments.push_back(total.fragment(part[k]));
        }
    }
}

}  // namespace

bool may_link(const ParticleSet& particles, const FragmentRules& rules, std::size_t i) {
    if (!(rules.linking_length[particles.data(field::body)[i]] > 0)) return false;
    const bool any_damage = rules.all_matter || !particles.has(field::damage);
    return any_damage || particles.data(field::damage)[i] < rules.damage_threshold;
}

LinkedParticles link_particles(const Communicator& comm, const Box& box, const ParticleSet& particles,
                               const FragmentRules& rules) {
    LinkedParticles linked{linkable_particles(particles, rules), {}};
    ParticleSet& set = linked.particles;
    if (comm.all_sum(static_cast<std::uint64_t>(set.size())) == 0) return linked;

    const CellGrid grid(box, *std::max_element(rules.linking_length.begin(), rules.linking_length.end()), 1);
    Decomposition decomposition(comm, PartitionMethod::cheapest);
    decomposition.expect(set);
    decomposition.divide(set, grid);
    decomposition.arrange(set, grid);
    Halo& halo = decomposition.halo();
    halo.begin(set, {&field::position, &field::body});
    halo.finish();
    std::copy_n(set.data(field::id), set.size(), set.data(field::fragment));
    DisjointSets sets(set.size_with_halo());
    sph::with_dimension(
        set, [&](auto dimension) { join_linked<dimension>(set, decomposition.table(), rules, sets); });
    spread_labels(comm, set, halo, sets);

    const ByLabel own(set);
    const std::vector<std::uint64_t> shared = shared_labels(comm, set, own.labels());
    std::vector<Fragment>& fragments = linked.fragments;
    for (const std::uint64_t label : own.labels())
        if (!std::binary_search(shared.begin(), shared.end(), label))
            fragments.push_back(own.tally(label).fragment(label));
    fragments = comm.all_gather(std::span<const Fragment>(fragments));
    reduce_shared(comm, own, shared, fragments);
    std::sort(fragments.begin(), fragments.end(), [](const Fragment& a, const Fragment& b) {
        return a.mass != b.mass ? a.mass > b.mass : a.label < b.label;
    });
    return linked;
}

std::vector<Fragment> find_fragments(const Communicator& comm, const Box& box, const ParticleSet& particles,
                                     const FragmentRules& rules) {
    return link_particles(comm, box, particles, rules).fragments;
}

}  // namespace talus
