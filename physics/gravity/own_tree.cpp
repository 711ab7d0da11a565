#include <limits>

#include "physics/gravity/tree.hpp"

namespace talus::gravity {

namespace {

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    double total = 0;
    for (std::size_t k = 0; k < 3; ++k) total += (a[k] - b[k]) * (a[k] - b[k]);
    return std::sqrt(total);
}

/// Sum of m x over sum of m; the middle of the bounds if there is no mass.
template <class Parts, class Mass, class Place>
void set_centre(Moments& moments, const Parts& parts, const Bounds& bounds, Mass&& mass, Place&& place) {
    std::array<double, 3> first{};
    moments.mass = 0;
    for (const auto& part : parts) {
        moments.mass += mass(part);
        for (std::size_t a = 0; a < 3; ++a) first[a] += mass(part) * (place(part)[a] - bounds.lower[a]);
    }
    for (std::size_t a = 0; a < 3; ++a) {
        const double middle = 0.5 * (bounds.upper[a] - bounds.lower[a]);
        moments.centre[a] = bounds.lower[a] + (moments.mass > 0 ? first[a] / moments.mass : middle);
    }
}

class OwnTree {
  public:
    OwnTree(Tree& tree, const Partition& partition, int rank, const Settings& settings)
        : tree_(tree),
          partition_(partition),
          rank_(rank),
          leaf_size_(static_cast<std::uint32_t>(settings.leaf_size)),
          group_size_(static_cast<std::uint32_t>(settings.group_size)),
          block_level_(cell_level - partition.block_shift()) {}

    void sort(const ParticleSet& particles, const CellGrid& grid, std::span<const CellEntry> own,
              const Settings& settings);
    /// Makes the topmost own nodes among sources [begin, end).
    void find_topmost(std::uint32_t begin, std::uint32_t end);

    std::vector<std::uint32_t> topmost;

  private:
    bool is_own(const TreeKey& key, int level) const {
        if (level >= block_level_) return true;
        const CellRange range = cells_of(key, level);
        const int shift = partition_.block_shift();
        return partition_.sole_owner(block_key_of(cell_of_morton(range.first), shift),
                                     block_key_of(cell_of_morton(range.last), shift)) == rank_;
    }
    template <class Visit>
    void for_each_child(std::uint32_t begin, std::uint32_t end, int level, Visit&& visit) const;
    void make(std::uint32_t place, std::uint32_t begin, std::uint32_t end, bool in_group);
    void make_leaf(Node& node, std::uint32_t begin, std::uint32_t end) const;

    Tree& tree_;
    const Partition& partition_;
    int rank_;
    std::uint32_t leaf_size_, group_size_;
    int block_level_;
    std::vector<TreeKey> keys_;
    std::vector<double> accelerations_;
};

void OwnTree::sort(const ParticleSet& particles, const CellGrid& grid, std::span<const CellEntry> own,
                   const Settings& settings) {
    struct Place {
        std::uint64_t morton;
        std::uint32_t index;
        auto operator<=>(const Place&) const = default;
    };
    std::vector<Place> cells(own.size()), within;
    for (std::uint32_t c = 0; c < own.size(); ++c) cells[c] = {morton_of(cell_of(own[c].key)), c};
    std::sort(cells.begin(), cells.end());
    const double* x[3];
    for (int a = 0; a < 3; ++a) x[a] = particles.data(field::position, a);
    const double *mass = particles.data(*settings.mass_field),
                 *own_softening = particles.data(*settings.softening_field);
    const double* g[3];
    for (int a = 0; a < 3; ++a) g[a] = particles.data(field::gravity_acceleration, a);
    for (const Place& place : cells) {
        const CellEntry& entry = own[place.index];
        const Cell cell = cell_of(entry.key);
        within.clear();
        for (std::uint32_t i = entry.begin; i < entry.end; ++i)
            within.push_back({morton_within(grid, cell, {x[0][i], x[1][i], x[2][i]}), i});
        std::sort(within.begin(), within.end());  // particles of a cell are in order of id
        for (const auto& [morton, i] : within) {
            keys_.push_back({place.morton, morton});
            const double softening = settings.softening_length > 0
                                         ? settings.softening_length
                                         : settings.softening_factor * own_softening[i];
            tree_.sources.push_back({{x[0][i], x[1][i], x[2][i]}, mass[i], softening});
            tree_.members.push_back(i);
            tree_.cells.push_back(place.index);
            accelerations_.push_back(std::sqrt(g[0][i] * g[0][i] + g[1][i] * g[1][i] + g[2][i] * g[2][i]));
        }
    }
}

template <class Visit>
void OwnTree::for_each_child(std::uint32_t begin, std::uint32_t end, int level, Visit&& visit) const {
    while (begin < end) {
        const unsigned child = digit(keys_[begin], level);
        std::uint32_t next = begin + 1;
        while (next < end && digit(keys_[next], level) == child) ++next;
        visit(begin, next);
        begin = next;
    }
}

void OwnTree::find_topmost(std::uint32_t begin, std::uint32_t end) {
    if (begin == end) return;
    const int level = common_level(keys_[begin], keys_[end - 1]);
    if (!is_own(keys_[begin], level)) {
        for_each_child(begin, end, level, [this](std::uint32_t b, std::uint32_t e) { find_topmost(b, e); });
        return;
    }
    const auto place = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    topmost.push_back(place);
    make(place, begin, end, false);
}

void OwnTree::make_leaf(Node& node, std::uint32_t begin, std::uint32_t end) const {
    const std::span<const Source> sources(tree_.sources.data() + begin, end - begin);
    node = {};
    node.first = begin;
    node.count = end - begin;
    node.is_leaf = node.is_here = true;
    node.target = {{sources[0].position, sources[0].position}, 0, std::numeric_limits<double>::infinity()};
    for (std::uint32_t k = begin; k < end; ++k) {
        const Source& source = tree_.sources[k];
        node.target.bounds.include({source.position, source.position});
        node.target.largest_softening = std::max(node.target.largest_softening, source.softening);
        node.target.least_acceleration = std::min(node.target.least_acceleration, accelerations_[k]);
    }
    set_centre(
        node.moments, sources, node.target.bounds, [](const Source& source) { return source.mass; },
        [](const Source& source) -> const auto& { return source.position; });
    for (const Source& source : sources) {
        node.moments.add_part({source.mass, source.position, {}, {}});
        node.radius = std::max(node.radius, distance(source.position, node.moments.centre));
    }
}

void OwnTree::make(std::uint32_t place, std::uint32_t begin, std::uint32_t end, bool in_group) {
    const int level = common_level(keys_[begin], keys_[end - 1]);
    const bool in_block = level >= block_level_,
               is_leaf = (in_block && end - begin <= leaf_size_) || level == last_level;
    const bool is_group = !in_group && in_block && (is_leaf || end - begin <= group_size_);
    Node node;
    if (is_leaf) {
        make_leaf(node, begin, end);
    } else {
        std::array<std::uint32_t, 9> starts{};
        std::uint32_t count = 0;
        for_each_child(begin, end, level, [&](std::uint32_t b, std::uint32_t e) {
            starts[count++] = b;
            starts[count] = e;
        });
        const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
        tree_.nodes.resize(first + count);
        for (std::uint32_t c = 0; c < count; ++c)
            make(first + c, starts[c], starts[c + 1], in_group || is_group);
        node = joined({tree_.nodes.data() + first, count});
        node.first = first;
    }
    node.key = keys_[begin];
    tree_.nodes[place] = node;
    if (is_group) tree_.groups.push_back({begin, end, node.target});
}

}  // namespace

Node joined(std::span<const Node> parts) {
    Node node{};
    node.count = static_cast<std::uint32_t>(parts.size());
    node.is_here = true;
    node.key = parts[0].key;
    node.target = parts[0].target;
    for (const Node& part : parts) {
        node.target.bounds.include(part.target.bounds);
        node.target.largest_softening =
            std::max(node.target.largest_softening, part.target.largest_softening);
        node.target.least_acceleration =
            std::min(node.target.least_acceleration, part.target.least_acceleration);
    }
    set_centre(
        node.moments, parts, node.target.bounds, [](const Node& part) { return part.moments.mass; },
        [](const Node& part) -> const auto& { return part.moments.centre; });
    double from_parts = 0;
    for (const Node& part : parts) {
        node.moments.add_part(part.moments);
        from_parts = std::max(from_parts, distance(part.moments.centre, node.moments.centre) + part.radius);
    }
    std::array<double, 3> corner;
    const Bounds& bounds = node.target.bounds;
    for (std::size_t a = 0; a < 3; ++a)
        corner[a] = node.moments.centre[a] - bounds.lower[a] > bounds.upper[a] - node.moments.centre[a]
                        ? bounds.lower[a]
                        : bounds.upper[a];
    node.radius = std::min(from_parts, distance(corner, node.moments.centre));
    return node;
}

std::vector<std::uint32_t> build_own(Tree& tree, const ParticleSet& particles, const CellGrid& grid,
                                     const Partition& partition, std::span<const CellEntry> own, int rank,
                                     const Settings& settings) {
    OwnTree builder(tree, partition, rank, settings);
    builder.sort(particles, grid, own, settings);
    builder.find_topmost(0, static_cast<std::uint32_t>(tree.sources.size()));
    return builder.topmost;
}

}  // namespace talus::gravity
