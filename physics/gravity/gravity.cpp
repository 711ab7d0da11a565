#include "physics/gravity/gravity.hpp"

#include "physics/gravity/group_forces.hpp"

namespace talus::gravity {

namespace {

// Time of each kind of interaction, listing included, over the 25 ns of a pair of Godunov SPH
// (gravity_bench).
constexpr double point_work = 0.03, softened_work = 0.07, node_work = 0.1;

double work_of(const PairCounts& counts) {
    return point_work * static_cast<double>(counts.points) +
           softened_work * static_cast<double>(counts.softened) +
           node_work * static_cast<double>(counts.nodes);
}

/// Where the results go.
struct Columns {
    explicit Columns(ParticleSet& particles) : potential(particles.data(field::gravity_potential)) {
        for (int a = 0; a < 3; ++a)
            acceleration[static_cast<std::size_t>(a)] = particles.data(field::gravity_acceleration, a);
    }
    std::array<double*, 3> acceleration;
    double* potential;
};

bool any_acceleration(const Communicator& comm, const ParticleSet& particles) {
    int found = 0;
    for (int a = 0; a < 3; ++a)
        for (const double g : particles.own(field::gravity_acceleration, a)) found |= g != 0;
    return comm.all_max(found) != 0;
}

}  // namespace

Gravity::Gravity(const Communicator& comm, const Settings& settings, const sph::Settings& sph)
    : comm_(comm), settings_(settings), softening_(softening_of(sph)) {}

void Gravity::evaluate(ParticleSet& particles, const CellGrid& grid, const Decomposition& decomposition,
                       std::span<double> work_of_cell) {
    if (settings_.direct)
        evaluate_direct(particles, work_of_cell);
    else if (settings_.precision == Precision::single_precision)
        evaluate_tree<float>(particles, grid, decomposition, work_of_cell);
    else
        evaluate_tree<double>(particles, grid, decomposition, work_of_cell);
}

template <class Scalar>
void Gravity::evaluate_tree(ParticleSet& particles, const CellGrid& grid, const Decomposition& decomposition,
                            std::span<double> work_of_cell) {
    const bool relative = settings_.opening == Opening::relative && any_acceleration(comm_, particles);
    const OpeningTest opening{.relative = relative,
                              .theta2 = relative ? 0.9 : settings_.theta * settings_.theta,
                              .half_support = 0.5 * softening_.support,
                              .constant = settings_.constant,
                              .accuracy = settings_.accuracy,
                              .order = settings_.order};
    Tree tree;
    const std::vector<std::uint32_t> own = build_own(tree, particles, grid, decomposition.partition(),
                                                     decomposition.own_cells(), comm_.rank(), settings_);
    counts_.bytes_sent += join(tree, own, comm_, opening);

    std::string gap;
    if (!tree.empty()) {
        GroupForces<Scalar> forces(tree, opening, softening_,
                                   Units::near(grid.cell_size(0), tree.nodes[tree.root].moments.mass));
        const Columns to(particles);
        for (const Group& group : tree.groups) {
            const PairCounts counts = forces.evaluate(group);
            counts_.points += counts.points;
            counts_.softened += counts.softened;
            counts_.nodes += counts.nodes;
            const double work = work_of(counts) / (group.end - group.begin);
            for (std::uint32_t k = group.begin; k < group.end; ++k) {
                const std::uint32_t i = tree.members[k];
                for (std::size_t a = 0; a < 3; ++a)
                    to.acceleration[a][i] = settings_.constant * forces.acceleration(k - group.begin, a);
                to.potential[i] = settings_.constant * forces.potential(k - group.begin);
                work_of_cell[tree.cells[k]] += work;
            }
        }
        if (forces.found_gap()) gap = "the tree of gravity lacks a part that another rank should have sent";
    }
    comm_.all_agree(1, gap);
}

void Gravity::evaluate_direct(ParticleSet& particles, std::span<double> work_of_cell) {
    struct Numbered {
        std::uint64_t id;
        SoftSource<double> source;
    };
    const auto ids = particles.own(field::id);
    const std::size_t size = particles.size();
    std::vector<Numbered> mine(size);
    Targets<double> targets;
    targets.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
        SoftSource<double>& source = mine[i].source;
        mine[i].id = ids[i];
        for (std::size_t a = 0; a < 3; ++a)
            targets.position[a][i] = source.position[a] =
                particles.data(field::position, static_cast<int>(a))[i];
        source.mass = particles.data(*settings_.mass_field)[i];
        targets.softening[i] = source.softening =
            settings_.softening_length > 0
                ? settings_.softening_length
                : settings_.softening_factor * particles.data(*settings_.softening_field)[i];
    }
    std::vector<Numbered> all = comm_.all_gather(std::span<const Numbered>(mine));
    if (size == 0) return;
    targets.pad(size);
    std::sort(all.begin(), all.end(), [](const Numbered& a, const Numbered& b) { return a.id < b.id; });
    std::vector<SoftSource<double>> sources;
    for (const Numbered& numbered : all) sources.push_back(numbered.source);
    add_softened(targets, sources, softening_);
    const Columns to(particles);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t a = 0; a < 3; ++a)
            to.acceleration[a][i] = settings_.constant * targets.acceleration[a][i];
        to.potential[i] = settings_.constant * targets.potential[i];
    }
    counts_.softened += size * sources.size();
    const double work =
        work_of({.softened = size * sources.size()}) / static_cast<double>(work_of_cell.size());
    for (double& of_cell : work_of_cell) of_cell += work;
}

sph::StepLimit stable_time_step(const ParticleSet& particles, const Settings& settings) {
    sph::StepLimit limit{std::numeric_limits<double>::infinity(), 0, "gravity"};
    const double* g[3];
    for (int a = 0; a < 3; ++a) g[a] = particles.data(field::gravity_acceleration, a);
    const double* h = particles.data(field::smoothing_length);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double strength = std::sqrt(g[0][i] * g[0][i] + g[1][i] * g[1][i] + g[2][i] * g[2][i]);
        const double step = settings.step_factor * std::sqrt(h[i] / strength);
        if (step < limit.time_step) limit = {step, particles.data(field::id)[i], "gravity"};
    }
    return limit;
}

}  // namespace talus::gravity
