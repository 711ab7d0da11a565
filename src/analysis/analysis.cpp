#include "src/analysis/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comm/exact_sum.hpp"
#include "io/agree.hpp"
#include "io/durable.hpp"

namespace talus {

namespace {

/// The antipode of the point hit, if the scene names one; `body` is the first body that can crack.
std::optional<Antipode> read_antipode(const Section& table, const std::vector<Body>& bodies, std::size_t body,
                                      int dimension) {
    if (!table.has("impact_point")) return {};
    const auto count = static_cast<std::size_t>(dimension);
    std::vector<double> hit = table.numbers("impact_point", "m", count);
    hit.resize(3);
    Antipode antipode{body, {}, {}, 0, bodies[body].velocity};
    const Point middle = centre(bodies[body].shape);
    double distance2 = 0;
    for (std::size_t a = 0; a < count; ++a) distance2 += (middle[a] - hit[a]) * (middle[a] - hit[a]);
    const double distance = std::sqrt(distance2);
    if (!(distance > 0)) {
        table.error("impact_point", "is the centre of the body");
        return {};
    }
    for (std::size_t a = 0; a < count; ++a) {
        antipode.outward[a] = (middle[a] - hit[a]) / distance;
        antipode.point[a] = 2 * middle[a] - hit[a];
    }
    antipode.radius = table.number("antipode_radius", "m", 0.2 * distance, {0, 1e30, true});
    return antipode;
}

double outward_speed(const Antipode& antipode, const ParticleSet& particles, std::size_t i) {
    double speed = 0;
    for (int a = 0; a < particles.dimension(); ++a) {
        const auto axis = static_cast<std::size_t>(a);
        speed +=
            (particles.data(field::velocity, a)[i] - antipode.first_velocity[axis]) * antipode.outward[axis];
    }
    return speed;
}

bool is_near(const Antipode& antipode, const ParticleSet& particles, std::size_t i) {
    double distance2 = 0;
    for (int a = 0; a < particles.dimension(); ++a) {
        const double d = particles.data(field::position, a)[i] - antipode.point[static_cast<std::size_t>(a)];
        distance2 += d * d;
    }
    return distance2 < antipode.radius * antipode.radius;
}

/// Mass that the `count` heaviest fragments have together, as a share of all.
double share_of(const Breakup& breakup, std::size_t k) {
    return k < breakup.fragments.size() ? breakup.fragments[k].mass / breakup.mass : 0;
}

std::string fragments_table(const Breakup& breakup) {
    std::string text =
        "rank,label,body,particles,mass [kg],mass_fraction,x [m],y [m],z [m],velocity_x [m s-1],"
        "velocity_y [m s-1],velocity_z [m s-1]\n";
    for (std::size_t k = 0; k < breakup.fragments.size(); ++k) {
        const Fragment& f = breakup.fragments[k];
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", k + 1, f.label, f.body, f.particles,
                            f.mass, f.mass / breakup.mass, f.centre[0], f.centre[1], f.centre[2],
                            f.velocity[0], f.velocity[1], f.velocity[2]);
    }
    return text;
}

std::string figures(double time, const AnalysisPlan& plan, const Breakup& breakup) {
    std::vector<std::pair<std::string_view, std::string>> entries = {
        {"time", fmt::format("{}", time)},
        {"mass", fmt::format("{}", breakup.mass)},
        {"damage_threshold", fmt::format("{}", plan.rules.damage_threshold)},
        {"linking_lengths", fmt::format("[{}]", fmt::join(plan.rules.linking_length, ", "))},
        {"fragments", fmt::format("{}", breakup.fragments.size())},
        {"largest_fraction", fmt::format("{}", share_of(breakup, 0))},
        {"second_largest_fraction", fmt::format("{}", share_of(breakup, 1))},
        {"intact_fraction", fmt::format("{}", breakup.intact)},
        {"fully_damaged_fraction", fmt::format("{}", breakup.fully_damaged)}};
    if (breakup.antipode_speed) {
        entries.emplace_back("antipode_speed", fmt::format("{}", *breakup.antipode_speed));
        entries.emplace_back("antipode_mass", fmt::format("{}", breakup.antipode_mass));
    }
    std::string text = "{";
    for (const auto& [name, value] : entries)
        text += fmt::format("{}\n  \"{}\": {}", text.size() > 1 ? "," : "", name, value);
    return text + "\n}\n";
}

}  // namespace

AnalysisPlan read_analysis(const Section& table, const std::vector<Body>& bodies, const Setup& setup) {
    AnalysisPlan plan;
    if (!table.exists()) return plan;
    plan.fragments = table.flag("fragments", true);
    plan.rules.damage_threshold = table.number("damage_threshold", "1", 1.0, {0, 1, true});
    const double spacings = table.number("linking_length", "1", default_linking_length, {1, 10});
    std::size_t first = bodies.size();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const bool cracks = setup.materials[b].fracture.has_value();
        plan.rules.linking_length.push_back(cracks ? spacings * bodies[b].spacing : 0);
        if (cracks) first = std::min(first, b);
    }
    if (first == bodies.size()) {
        table.error("fragments", "no body has a material that cracks");
        return plan;
    }
    plan.antipode = read_antipode(table, bodies, first, setup.box.dimension);
    return plan;
}

Breakup analyse(const Communicator& comm, const AnalysisPlan& plan, const Box& box,
                const ParticleSet& particles) {
    enum Sum { all, broken, antipode_mass, antipode_momentum, sum_count };
    std::vector<ExactSum> sums(sum_count);
    const std::uint8_t* body = particles.data(field::body);
    const double *mass = particles.data(field::mass), *damage = particles.data(field::damage);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (!(plan.rules.linking_length[body[i]] > 0)) continue;
        sums[all].add(mass[i]);
        if (damage[i] >= 1) sums[broken].add(mass[i]);
        if (plan.antipode && body[i] == plan.antipode->body && is_near(*plan.antipode, particles, i)) {
            sums[antipode_mass].add(mass[i]);
            sums[antipode_momentum].add(mass[i] * outward_speed(*plan.antipode, particles, i));
        }
    }
    ExactSum::all_reduce(comm, sums);
    Breakup breakup;
    breakup.mass = sums[all].value();
    breakup.fully_damaged = sums[broken].value() / breakup.mass;
    breakup.antipode_mass = sums[antipode_mass].value();
    if (breakup.antipode_mass > 0)
        breakup.antipode_speed = sums[antipode_momentum].value() / breakup.antipode_mass;
    breakup.fragments = find_fragments(comm, box, particles, plan.rules);
    for (const Fragment& fragment : breakup.fragments) breakup.intact += fragment.mass;
    breakup.intact /= breakup.mass;
    return breakup;
}

void write_breakup(const Communicator& comm, const std::filesystem::path& folder, double time,
                   const AnalysisPlan& plan, const Breakup& breakup) {
    agree_on_root(comm, [&] {
        replace_file(folder / "fragments.csv", fragments_table(breakup));
        replace_file(folder / "analysis.json", figures(time, plan, breakup));
    });
}

std::string describe(const Breakup& breakup) {
    std::string text = fmt::format(
        "{} fragments; the largest has {:.4f} of the mass, the second {:.4f}, all together {:.4f}; fully "
        "damaged {:.4f}",
        breakup.fragments.size(), share_of(breakup, 0), share_of(breakup, 1), breakup.intact,
        breakup.fully_damaged);
    if (breakup.antipode_speed)
        text += fmt::format("; the antipode moves outward at {:.4g} m/s", *breakup.antipode_speed);
    return text;
}

}  // namespace talus
