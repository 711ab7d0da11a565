#include <cstring>
#include <map>

#include "comm/sparse_exchange.hpp"
#include "physics/gravity/tree.hpp"

namespace talus::gravity {

namespace {

/// A topmost node of one rank, which every rank knows.
struct Branch {
    Node node;
    int rank;
};

void append(std::vector<std::byte>& bytes, const auto* values, std::size_t count) {
    const auto* from = reinterpret_cast<const std::byte*>(values);
    bytes.insert(bytes.end(), from, from + count * sizeof(*values));
}

/// Reads a parcel from its start.
class Reader {
  public:
    explicit Reader(const std::vector<std::byte>& bytes) : bytes_(bytes) {}
    bool at_end() const { return place_ == bytes_.size(); }
    template <class T>
    void take(T* to, std::size_t count) {
        std::memcpy(to, bytes_.data() + place_, count * sizeof(T));
        place_ += count * sizeof(T);
    }
    template <class T>
    T take() {
        T value;
        take(&value, 1);
        return value;
    }

  private:
    const std::vector<std::byte>& bytes_;
    std::size_t place_ = 0;
};

class SharedTree {
  public:
    SharedTree(Tree& tree, const Communicator& comm, const OpeningTest& opening)
        : tree_(tree), comm_(comm), opening_(opening) {}

    void gather(const std::vector<std::uint32_t>& own);
    std::uint64_t exchange();

  private:
    using Places = std::vector<std::uint32_t>;

    void make(std::uint32_t place, std::uint32_t begin, std::uint32_t end);
    void find_needing(const Node& node, std::uint32_t place, std::map<int, Places>& by_rank) const;
    void send(const Node& node, const Places& targets, std::vector<std::byte>& bytes) const;
    void receive(std::uint32_t place, Reader& reader);
    bool may_open(const Node& node, const Node& target) const {
        return !node.is_lone() && !opening_.accepts(node, target.target);
    }

    Tree& tree_;
    const Communicator& comm_;
    const OpeningTest opening_;
    std::vector<Branch> branches_;    ///< in order of key
    Places branch_places_;            ///< among the nodes
    std::uint32_t first_shared_ = 0;  ///< of the nodes that ranks share, to the branches
    Places branch_of_;                ///< of each of those nodes, or none
    static constexpr std::uint32_t none = ~0u;
};

void SharedTree::gather(const std::vector<std::uint32_t>& own) {
    std::vector<Branch> mine;
    for (const std::uint32_t place : own) mine.push_back({tree_.nodes[place], comm_.rank()});
    branches_ = comm_.all_gather(std::span<const Branch>(mine));
    if (branches_.empty()) return;
    std::sort(branches_.begin(), branches_.end(),
              [](const Branch& a, const Branch& b) { return a.node.key < b.node.key; });
    branch_places_.resize(branches_.size());
    first_shared_ = tree_.root = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    make(tree_.root, 0, static_cast<std::uint32_t>(branches_.size()));
    branch_of_.assign(tree_.nodes.size() - first_shared_, none);
    for (std::uint32_t b = 0; b < branches_.size(); ++b) branch_of_[branch_places_[b] - first_shared_] = b;
}

void SharedTree::make(std::uint32_t place, std::uint32_t begin, std::uint32_t end) {
    if (end - begin == 1) {
        tree_.nodes[place] = branches_[begin].node;
        tree_.nodes[place].is_here = branches_[begin].rank == comm_.rank();
        branch_places_[begin] = place;
        return;
    }
    const int level = common_level(branches_[begin].node.key, branches_[end - 1].node.key);
    Places starts;
    for (std::uint32_t k = begin; k < end; ++k)
        if (k == begin || digit(branches_[k].node.key, level) != digit(branches_[k - 1].node.key, level))
            starts.push_back(k);
    const auto count = static_cast<std::uint32_t>(starts.size());
    starts.push_back(end);
    const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(first + count);
    for (std::uint32_t c = 0; c < count; ++c) make(first + c, starts[c], starts[c + 1]);
    Node node = joined({tree_.nodes.data() + first, count});
    node.first = first;
    tree_.nodes[place] = node;
}

/// Lists the other ranks' branches, at or below the shared node at `place`, on behalf of which `node` may
/// have to be opened.
void SharedTree::find_needing(const Node& node, std::uint32_t place, std::map<int, Places>& by_rank) const {
    const Node& target = tree_.nodes[place];
    if (!may_open(node, target)) return;
    const std::uint32_t branch = branch_of_[place - first_shared_];
    if (branch == none) {
        for (std::uint32_t c = 0; c < target.count; ++c) find_needing(node, target.first + c, by_rank);
    } else if (branches_[branch].rank != comm_.rank()) {
        by_rank[branches_[branch].rank].push_back(place);
    }
}

/// Appends what is in `node`, and in those of its children that a target may open.
void SharedTree::send(const Node& node, const Places& targets, std::vector<std::byte>& bytes) const {
    if (node.is_leaf) {
        append(bytes, tree_.sources.data() + node.first, node.count);
        return;
    }
    const Node* children = tree_.nodes.data() + node.first;
    append(bytes, children, node.count);
    std::vector<Places> needing(node.count);
    for (std::uint32_t c = 0; c < node.count; ++c) {
        for (const std::uint32_t target : targets)
            if (may_open(children[c], tree_.nodes[target])) needing[c].push_back(target);
        const std::uint8_t is_opened = !needing[c].empty();
        append(bytes, &is_opened, 1);
    }
    for (std::uint32_t c = 0; c < node.count; ++c)
        if (!needing[c].empty()) send(children[c], needing[c], bytes);
}

void SharedTree::receive(std::uint32_t place, Reader& reader) {
    Node& node = tree_.nodes[place];
    const std::uint32_t count = node.count;
    node.is_here = true;
    if (node.is_leaf) {
        node.first = static_cast<std::uint32_t>(tree_.sources.size());
        tree_.sources.resize(node.first + count);
        reader.take(tree_.sources.data() + node.first, count);
        return;
    }
    const std::uint32_t first = node.first = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(first + count);
    reader.take(tree_.nodes.data() + first, count);
    std::array<std::uint8_t, 8> is_opened{};
    for (std::uint32_t c = 0; c < count; ++c) {
        tree_.nodes[first + c].is_here = false;
        reader.take(&is_opened[c], 1);
    }
    for (std::uint32_t c = 0; c < count; ++c)
        if (is_opened[c]) receive(first + c, reader);
}

std::uint64_t SharedTree::exchange() {
    if (comm_.size() == 1) return 0;
    std::map<int, std::vector<std::byte>> messages;
    for (std::uint32_t b = 0; b < branches_.size(); ++b) {
        if (branches_[b].rank != comm_.rank()) continue;
        const Node& node = tree_.nodes[branch_places_[b]];
        std::map<int, Places> by_rank;
        find_needing(node, tree_.root, by_rank);
        for (const auto& [rank, targets] : by_rank) {
            append(messages[rank], &b, 1);
            send(node, targets, messages[rank]);
        }
    }
    std::vector<Parcel> outgoing;
    std::uint64_t bytes_sent = 0;
    for (auto& [rank, bytes] : messages) {
        bytes_sent += bytes.size();
        outgoing.push_back({rank, std::move(bytes)});
    }
    SparseExchange exchange(comm_);
    for (const Parcel& parcel : exchange(std::move(outgoing)))
        for (Reader reader(parcel.bytes); !reader.at_end();)
            receive(branch_places_[reader.take<std::uint32_t>()], reader);
    return bytes_sent;
}

}  // namespace

std::uint64_t join(Tree& tree, const std::vector<std::uint32_t>& own, const Communicator& comm,
                   const OpeningTest& opening) {
    SharedTree shared(tree, comm, opening);
    shared.gather(own);
    return shared.exchange();
}

}  // namespace talus::gravity
