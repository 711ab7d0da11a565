#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "comm/communicator.hpp"
#include "domain/cell_grid.hpp"
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "domain/partition.hpp"
#include "physics/gravity/multipole.hpp"
#include "physics/gravity/settings.hpp"
#include "physics/gravity/tree_key.hpp"

namespace talus::gravity {

/// A particle as a source of gravity.
struct Source {
    std::array<double, 3> position;  ///< [m]
    double mass;                     ///< [kg]
    double softening;                ///< h [m]
};

/// Box around positions.
struct Bounds {
    std::array<double, 3> lower, upper;

    static double square(double x) { return x * x; }
    /// Squared distance from a point, 0 inside [m2].
    double squared_distance(const std::array<double, 3>& x) const {
        double total = 0;
        for (std::size_t a = 0; a < 3; ++a)
            total += square(std::max(std::max(lower[a] - x[a], x[a] - upper[a]), 0.0));
        return total;
    }
    double squared_distance(const Bounds& other) const {
        double total = 0;
        for (std::size_t a = 0; a < 3; ++a)
            total += square(std::max(std::max(lower[a] - other.upper[a], other.lower[a] - upper[a]), 0.0));
        return total;
    }
    void include(const Bounds& other) {
        for (std::size_t a = 0; a < 3; ++a) {
            lower[a] = std::min(lower[a], other.lower[a]);
            upper[a] = std::max(upper[a], other.upper[a]);
        }
    }
};

/// Particles that forces are sought for, one or many.
struct Target {
    Bounds bounds;
    double largest_softening;   ///< [m]
    double least_acceleration;  ///< at the last evaluation [m s-2]
};

/// A node of the tree, as a source and as a target.
struct Node {
    Moments moments;
    Target target;
    double radius;  ///< distance of the centre of mass from the farthest particle, or a bound of it [m]
    TreeKey key;    ///< of its first particle
    std::uint32_t first, count;  ///< its children among the nodes, or its particles among the sources
    bool is_leaf;
    bool is_here;  ///< whether what it contains is on this rank

    /// A single particle: the node itself is all there is to know of it.
    bool is_lone() const { return is_leaf && count == 1; }
};

/// Decides whether the particles of a node act on a target as one. What is decided for a target holds for
/// every part of it: distances and accelerations can only be larger, and rounding keeps the order.
struct OpeningTest {
    bool relative;
    double theta2;        ///< square of the greatest radius over distance
    double half_support;  ///< of the softening kernel, halved [h]
    double constant;      ///< of gravitation
    double accuracy;      ///< error over the least acceleration
    int order;            ///< of the multipoles

    /// The multipoles that represent a node: 0 if it must be opened, less than `order` if the next multipole
    /// adds little even at this distance. Softened pairs are never taken together: softening ends at half the
    /// support times the sum of both h.
    int order_for(const Node& node, const Target& target) const {
        const double d2 = target.bounds.squared_distance(node.moments.centre);
        const double reach =
            node.radius + half_support * (node.target.largest_softening + target.largest_softening);
        const double ratio = node.radius * node.radius / d2;
        if (!(d2 > reach * reach) || !(ratio < theta2)) return 0;
        // Size of the first multipole left out, over that of the mass.
        const double after_third = ratio * ratio, after_second = ratio * std::sqrt(ratio);
        const double after = order == 1 ? ratio : order == 2 ? after_second : after_third;
        const double pull = relative ? constant * node.moments.mass / (accuracy * d2) : 1;
        const double allowed = relative ? target.least_acceleration : theta2 * theta2;
        if (relative && !(pull * after < allowed)) return 0;
        return order == 3 && pull * after_second < negligible * allowed ? 2 : order;
    }
    bool accepts(const Node& node, const Target& target) const { return order_for(node, target) > 0; }

    static constexpr double negligible = 0.5;  ///< of the error allowed
};

/// Own particles that share a list of interactions.
struct Group {
    std::uint32_t begin, end;  ///< among the sources
    Target target;
};

/// The octree of all particles. It follows from their positions alone, whoever owns them: a node that would
/// have one child is left out, and a leaf is a node of at most leaf_size particles within one block of cells,
/// so that it lies on one rank. A rank holds the nodes of its own particles, those that several ranks share,
/// and what its own particles need of the others'.
struct Tree {
    std::vector<Node> nodes;
    std::uint32_t root = 0;
    std::vector<Source> sources;         ///< own particles in the order of their keys, then others'
    std::vector<std::uint32_t> members;  ///< place in the set of each own source
    std::vector<std::uint32_t> cells;    ///< own cell of each own source
    std::vector<Group> groups;           ///< of own particles, in the order of their keys

    bool empty() const { return nodes.empty(); }
};

/// The own part of the tree: sources, groups and nodes; returns the places of the topmost nodes whose region
/// `partition` gives to this rank alone. `own`: the set's own cells. 3D only.
std::vector<std::uint32_t> build_own(Tree& tree, const ParticleSet& particles, const CellGrid& grid,
                                     const Partition& partition, std::span<const CellEntry> own, int rank,
                                     const Settings& settings);

/// Adds the nodes that ranks share above their `own` topmost ones, and what the opening test may ask for of
/// other ranks on behalf of any own particle. Returns the bytes sent. Collective.
std::uint64_t join(Tree& tree, const std::vector<std::uint32_t>& own, const Communicator& comm,
                   const OpeningTest& opening);

/// A node of several parts, in their order.
Node joined(std::span<const Node> parts);

}  // namespace talus::gravity
