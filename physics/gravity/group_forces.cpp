#include "physics/gravity/group_forces.hpp"

namespace talus::gravity {

template <class Scalar>
GroupForces<Scalar>::GroupForces(const Tree& tree, const OpeningTest& opening,
                                 const Softening<double>& softening, const Units& units)
    : tree_(tree), opening_(opening), softening_(rounded<Scalar>(softening)), units_(units) {
    const double second = 1 / (units.mass * units.length * units.length), third = second / units.length;
    multipoles_.resize(tree.nodes.size());
    for (std::size_t k = 0; k < tree.nodes.size(); ++k) {
        const Moments& moments = tree.nodes[k].moments;
        NodeSource<Scalar>& source = multipoles_[k];
        source.mass = static_cast<Scalar>(moments.mass / units.mass);
        if (opening.order >= 2) {
            const auto quadrupole = quadrupole_of(moments);
            for (std::size_t c = 0; c < 6; ++c)
                source.quadrupole[c] = static_cast<Scalar>(quadrupole[c] * second);
        }
        if (opening.order >= 3) {
            const auto octupole = octupole_of(moments);
            for (std::size_t c = 0; c < 10; ++c)
                source.octupole[c] = static_cast<Scalar>(octupole[c] * third);
        }
    }
}

template <class Scalar>
void GroupForces<Scalar>::take_targets(const Group& group) {
    const Bounds& bounds = group.target.bounds;
    for (std::size_t a = 0; a < 3; ++a) middle_[a] = 0.5 * (bounds.lower[a] + bounds.upper[a]);
    const std::size_t size = group.end - group.begin;
    targets_.resize(size);
    for (std::size_t k = 0; k < size; ++k) {
        const Source& source = tree_.sources[group.begin + k];
        const auto x = relative(source.position);
        for (std::size_t a = 0; a < 3; ++a) targets_.position[a][k] = x[a];
        targets_.softening[k] = static_cast<Scalar>(source.softening / units_.length);
    }
    targets_.pad(size);
}

template <class Scalar>
void GroupForces<Scalar>::list_particles(std::span<const Source> sources, const Target& target) {
    for (const Source& source : sources) {
        const auto x = relative(source.position);
        const auto mass = static_cast<Scalar>(source.mass / units_.mass);
        const double reach = opening_.half_support * (source.softening + target.largest_softening);
        if (target.bounds.squared_distance(source.position) > reach * reach)
            points_.push_back({x, mass});
        else
            softened_.push_back({x, mass, static_cast<Scalar>(source.softening / units_.length)});
    }
}

template <class Scalar>
void GroupForces<Scalar>::list_sources(const Target& target) {
    points_.clear();
    softened_.clear();
    for (auto& nodes : nodes_) nodes.clear();
    stack_.assign(1, tree_.root);
    while (!stack_.empty()) {
        const std::uint32_t place = stack_.back();
        stack_.pop_back();
        const Node& node = tree_.nodes[place];
        if (node.is_lone()) {
            const Source source{node.moments.centre, node.moments.mass, node.target.largest_softening};
            list_particles({&source, 1}, target);
            continue;
        }
        if (const int order = opening_.order_for(node, target)) {
            auto& nodes = nodes_[static_cast<std::size_t>(order - 1)];
            nodes.push_back(multipoles_[place]);
            nodes.back().position = relative(node.moments.centre);
        } else if (!node.is_here) {
            found_gap_ = true;
        } else if (node.is_leaf) {
            list_particles({tree_.sources.data() + node.first, node.count}, target);
        } else {
            for (std::uint32_t c = node.count; c-- > 0;) stack_.push_back(node.first + c);
        }
    }
}

template <class Scalar>
PairCounts GroupForces<Scalar>::evaluate(const Group& group) {
    take_targets(group);
    list_sources(group.target);
    add_points(targets_, points_);
    add_softened(targets_, softened_, softening_);
    add_nodes<1>(targets_, nodes_[0]);
    add_nodes<2>(targets_, nodes_[1]);
    add_nodes<3>(targets_, nodes_[2]);
    const std::uint64_t size = group.end - group.begin;
    return {size * points_.size(), size * softened_.size(),
            size * (nodes_[0].size() + nodes_[1].size() + nodes_[2].size())};
}

template class GroupForces<float>;
template class GroupForces<double>;

}  // namespace talus::gravity
