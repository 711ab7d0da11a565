#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/agree.hpp"
#include "io/durable.hpp"
#include "io/snapshot.hpp"
#include "src/analysis/analysis.hpp"

namespace talus {

namespace {

/// Mass of the fragment with that place in the order, as a share of all.
double share_of(const Breakup& breakup, std::size_t k) {
    return k < breakup.fragments.size() ? breakup.fragments[k].mass / breakup.mass : 0;
}

double speed_of(const Fragment& fragment, const Breakup& breakup) {
    return norm(minus(fragment.velocity, breakup.velocity));
}

std::string fragments_table(const Breakup& breakup) {
    std::string text =
        "rank,label,body,particles,mass [kg],mass_fraction,x [m],y [m],z [m],velocity_x [m s-1],"
        "velocity_y [m s-1],velocity_z [m s-1],speed [m s-1]\n";
    for (std::size_t k = 0; k < breakup.fragments.size(); ++k) {
        const Fragment& f = breakup.fragments[k];
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", k + 1, f.label, f.body, f.particles,
                            f.mass, f.mass / breakup.mass, f.centre[0], f.centre[1], f.centre[2],
                            f.velocity[0], f.velocity[1], f.velocity[2], speed_of(f, breakup));
    }
    return text;
}

/// One row for all fragments of one mass.
std::string distribution_table(const Breakup& breakup) {
    std::string text =
        "mass [kg],mass_fraction,fragments,number_at_least,mass_at_least [kg],mean_speed [m s-1],"
        "least_speed [m s-1],greatest_speed [m s-1]\n";
    const std::vector<Fragment>& list = breakup.fragments;
    double mass_so_far = 0;
    for (std::size_t begin = 0, end; begin < list.size(); begin = end) {
        double sum = 0, least = std::numeric_limits<double>::infinity(), greatest = 0;
        for (end = begin; end < list.size() && list[end].mass == list[begin].mass; ++end) {
            const double speed = speed_of(list[end], breakup);
            sum += speed;
            least = std::min(least, speed);
            greatest = std::max(greatest, speed);
            mass_so_far += list[end].mass;
        }
        text += fmt::format("{},{},{},{},{},{},{},{}\n", list[begin].mass, list[begin].mass / breakup.mass,
                            end - begin, end, mass_so_far, sum / static_cast<double>(end - begin), least,
                            greatest);
    }
    return text;
}

/// A JSON object, written entry by entry.
class JsonObject {
  public:
    explicit JsonObject(int depth) : indent_(static_cast<std::size_t>(2 * depth), ' ') {}

    void add(std::string_view name, double value) {
        add_text(name, std::isfinite(value) ? fmt::format("{}", value) : "null");
    }
    void add(std::string_view name, std::uint64_t value) { add_text(name, fmt::format("{}", value)); }
    void add(std::string_view name, const Point& value) {
        add_text(name, fmt::format("[{}]", fmt::join(value, ", ")));
    }
    void add_text(std::string_view name, std::string_view json) {
        entries_ += fmt::format("{}\n{}  \"{}\": {}", entries_.empty() ? "" : ",", indent_, name, json);
    }
    std::string text() const { return fmt::format("{{{}\n{}}}", entries_, indent_); }

  private:
    std::string indent_, entries_;
};

void add_matter(JsonObject& object, const MatterFigures& matter, double all) {
    object.add("particles", matter.particles);
    object.add("mass", matter.mass);
    object.add("mass_fraction", matter.mass / all);
    object.add("centre", matter.centre);
    object.add("velocity", matter.velocity);
    object.add("angular_momentum", matter.angular_momentum);
    if (!matter.mean_damage) return;
    object.add("mean_damage", *matter.mean_damage);
    object.add("fully_damaged_fraction", *matter.fully_damaged);
}

double period(const BodyFigures& shape) { return 2 * std::numbers::pi / norm(shape.spin); }

std::string body_json(const Remnant& remnant, double all) {
    const BodyFigures& shape = remnant.shape;
    JsonObject object(3);
    object.add("label", remnant.set.seed);
    add_matter(object, remnant.body, all);
    object.add("spin", shape.spin);
    object.add("period", period(shape));
    object.add("semi_axes", shape.semi_axes);
    object.add("b_over_a", shape.semi_axes[1] / shape.semi_axes[0]);
    object.add("c_over_a", shape.semi_axes[2] / shape.semi_axes[0]);
    object.add("extents", shape.extents);
    object.add("extent_b_over_a", shape.extents[1] / shape.extents[0]);
    object.add("extent_c_over_a", shape.extents[2] / shape.extents[0]);
    object.add("bulk_density", shape.density);
    std::string axes;
    for (const Point& axis : shape.axes)
        axes += fmt::format("{}[{}]", axes.empty() ? "" : ", ", fmt::join(axis, ", "));
    object.add_text("axes", "[" + axes + "]");
    return object.text();
}

void add_remnants(JsonObject& report, const RemnantRules& rules, const Remnants& remnants) {
    std::string list;
    double bound = 0;
    for (const Remnant& remnant : remnants.list) {
        JsonObject object(2);
        object.add("pieces", remnant.set.pieces);
        object.add("binding_rounds", static_cast<std::uint64_t>(remnant.set.rounds));
        object.add("unsettled", remnant.set.unsettled);
        add_matter(object, remnant.bound, remnants.mass);
        if (remnant.body.particles > 0) object.add_text("body", body_json(remnant, remnants.mass));
        list += fmt::format("{}\n    {}", list.empty() ? "" : ",", object.text());
        bound += remnant.bound.mass;
    }
    report.add("gravitational_constant", rules.binding.constant);
    report.add_text("binding", rules.particles_bind ? "\"particles\"" : "\"groups\"");
    report.add("all_mass", remnants.mass);
    const double largest = remnants.list.empty() ? 0 : remnants.list[0].bound.mass;
    report.add("escaping_mass", remnants.mass - largest);
    report.add("escaping_fraction", (remnants.mass - largest) / remnants.mass);
    report.add("in_no_remnant_mass", remnants.mass - bound);
    report.add_text("remnants", "[" + list + "\n  ]");
}

std::string report_of(double time, const AnalysisPlan& plan, const Breakup& breakup) {
    JsonObject report(0);
    report.add("time", time);
    if (plan.fragments) {
        report.add("mass", breakup.mass);
        report.add_text("link", plan.rules.all_matter ? "\"all\"" : "\"undamaged\"");
        report.add("damage_threshold", plan.rules.damage_threshold);
        report.add_text("linking_lengths", fmt::format("[{}]", fmt::join(plan.rules.linking_length, ", ")));
        report.add("fragments", static_cast<std::uint64_t>(breakup.fragments.size()));
        report.add("largest_fraction", share_of(breakup, 0));
        report.add("second_largest_fraction", share_of(breakup, 1));
        report.add("intact_fraction", breakup.in_fragments);
        report.add("fully_damaged_fraction", breakup.fully_damaged);
    }
    if (breakup.antipode_speed) {
        report.add("antipode_speed", *breakup.antipode_speed);
        report.add("antipode_mass", breakup.antipode_mass);
    }
    if (breakup.remnants) add_remnants(report, *plan.remnants, *breakup.remnants);
    return report.text() + "\n";
}

void describe_remnants(const Remnants& remnants, std::vector<std::string>& parts) {
    if (remnants.list.empty()) parts.emplace_back("nothing is bound by gravity");
    for (std::size_t k = 0; k < remnants.list.size(); ++k) {
        const Remnant& r = remnants.list[k];
        const Point& axes = r.shape.semi_axes;
        std::string text = fmt::format("remnant {}: {:.4f} of the mass, bound by gravity", k + 1,
                                       r.bound.mass / remnants.mass);
        if (r.set.pieces > 1) text += fmt::format(", in {} pieces", r.set.pieces);
        if (r.body.particles > 0)
            text += fmt::format("; its body {:.4f}, b/a {:.3f}, c/a {:.3f}", r.body.mass / remnants.mass,
                                axes[1] / axes[0], axes[2] / axes[0]);
        if (norm(r.shape.spin) > 0) text += fmt::format(", period {:.4g} h", period(r.shape) / 3600);
        if (r.set.unsettled > 0)
            text += fmt::format(
                "; {} units still joined or left it after {} rounds, its mass is in doubt by theirs",
                r.set.unsettled, r.set.rounds);
        parts.push_back(std::move(text));
    }
}

void write_bound_particles(const Communicator& comm, const std::filesystem::path& folder,
                           const RunState& state, const ParticleSet& bound) {
    if (comm.all_sum(static_cast<std::uint64_t>(bound.size())) == 0) return;
    std::vector<SnapshotField> fields;
    for (const Column& column : bound.columns()) fields.push_back({.field = column.info});
    write_snapshot(comm, folder, 0, state, bound, fields);
}

}  // namespace

void write_breakup(const Communicator& comm, const std::filesystem::path& folder, const RunState& state,
                   const AnalysisPlan& plan, const Breakup& breakup) {
    if (breakup.remnants) write_bound_particles(comm, folder, state, breakup.remnants->bound);
    agree_on_root(comm, [&] {
        if (plan.fragments) {
            replace_file(folder / "fragments.csv", fragments_table(breakup));
            replace_file(folder / "distribution.csv", distribution_table(breakup));
        }
        replace_file(folder / "analysis.json", report_of(state.time, plan, breakup));
    });
}

std::string describe(const AnalysisPlan& plan, const Breakup& breakup) {
    std::vector<std::string> parts;
    if (plan.fragments)
        parts.push_back(fmt::format(
            "{} fragments; the largest has {:.4f} of the mass, the second {:.4f}, all together {:.4f}; fully "
            "damaged {:.4f}",
            breakup.fragments.size(), share_of(breakup, 0), share_of(breakup, 1), breakup.in_fragments,
            breakup.fully_damaged));
    if (breakup.antipode_speed)
        parts.push_back(fmt::format("the antipode moves outward at {:.4g} m/s", *breakup.antipode_speed));
    if (breakup.remnants) describe_remnants(*breakup.remnants, parts);
    return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace talus
