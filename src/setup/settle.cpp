#include "src/setup/settle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <utility>

#include "comm/exact_sum.hpp"
#include "io/progress.hpp"
#include "src/analysis/hand_off.hpp"
#include "src/analysis/selection.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

namespace {

constexpr double default_imbalance = 0.1;       // its square is the share of the energy of the ringing
constexpr double default_longest = 100;         // times that of sound through the body
constexpr std::uint64_t least_particles = 100;  // fewer are all surface, which creeps, and never quiet

/// Time that sound needs to pass through a body where it is longest [s].
double sound_passage(const Body& body, const Material& material, int dimension) {
    const BoxShape around = bounds(body.shape, dimension);
    double longest = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        longest = std::max(longest, around.upper[a] - around.lower[a]);
    return longest / evaluate(material.eos, body.density, body.internal_energy).sound_speed;
}

/// The setup under which bodies settle: nothing bears shear or cracks.
Setup as_fluids(Setup setup) {
    for (Material& material : setup.materials) {
        material.shear_modulus = 0;
        material.fracture.reset();
    }
    setup.late_phase.reset();
    setup.first_time_step = std::numeric_limits<double>::infinity();
    return setup;
}

struct Middle {
    Point centre;  ///< of mass [m]
    double size;   ///< rms distance from it [m]
};

Middle middle_of(const Communicator& comm, const ParticleSet& particles) {
    const auto mass = particles.own(field::mass);
    std::vector<ExactSum> sums(4), squares(1);
    const auto position = [&](std::size_t i) {
        Point x{};
        for (int a = 0; a < particles.dimension(); ++a)
            x[static_cast<std::size_t>(a)] = particles.data(field::position, a)[i];
        return x;
    };
    for (std::size_t i = 0; i < mass.size(); ++i) {
        const Point x = position(i);
        for (std::size_t a = 0; a < 3; ++a) sums[a].add(mass[i] * x[a]);
        sums[3].add(mass[i]);
    }
    ExactSum::all_reduce(comm, sums);
    const double all = sums[3].value();
    const Point centre = times(1 / all, {sums[0].value(), sums[1].value(), sums[2].value()});
    for (std::size_t i = 0; i < mass.size(); ++i) {
        const Point arm = minus(position(i), centre);
        squares[0].add(mass[i] * dot(arm, arm));
    }
    ExactSum::all_reduce(comm, squares);
    return {centre, std::sqrt(squares[0].value() / all)};
}

/// Rms of the whole acceleration over that of gravity's, by mass.
double imbalance_of(const Communicator& comm, const ParticleSet& particles) {
    const auto mass = particles.own(field::mass);
    std::vector<ExactSum> sums(2);
    for (int a = 0; a < particles.dimension(); ++a) {
        const auto pull = particles.own(field::gravity_acceleration, a),
                   push = particles.own(field::acceleration, a);
        for (std::size_t i = 0; i < mass.size(); ++i) {
            const double whole = push[i] + pull[i];
            sums[0].add(mass[i] * whole * whole);
            sums[1].add(mass[i] * pull[i] * pull[i]);
        }
    }
    ExactSum::all_reduce(comm, sums);
    return std::sqrt(sums[0].value() / sums[1].value());
}

void damp(ParticleSet& particles, double factor) {
    for (int a = 0; a < particles.dimension(); ++a)
        for (double& v : particles.own(field::velocity, a)) v *= factor;
}

bool is_quiet(const SettlePlan& plan, const Settling& now) {
    return now.imbalance <= plan.imbalance &&
           (!plan.largest_speed || now.largest_speed <= *plan.largest_speed);
}

void measure(const Simulation& run, Settling& now) {
    const Totals totals = run.totals();
    now.time = run.time();
    now.steps = run.step_count();
    now.imbalance = imbalance_of(run.comm(), run.particles());
    now.largest_speed = totals.greatest_speed;
    now.kinetic_share = totals.kinetic_energy / std::abs(totals.potential_energy);
    now.greatest_pressure = totals.greatest_pressure;
}

/// Steps until all is quiet.
Settling come_to_rest(const SettlePlan& plan, double longest, Settling now, Simulation& run,
                      const std::function<void()>& before_step) {
    Progress progress(run.comm().is_root(), {});
    run.start();
    double quiet_since = std::numeric_limits<double>::infinity();
    for (;;) {
        before_step();
        const double time_step = run.time_step();
        run.step();
        damp(run.particles(), std::exp(-time_step / now.damping));
        measure(run, now);
        progress.update(now.steps, now.time, run.time_step(), run.total_particles());
        quiet_since =
            is_quiet(plan, now) ? std::min(quiet_since, now.time) : std::numeric_limits<double>::infinity();
        if (now.time - quiet_since >= now.quiet_for) return now;
        if (now.time >= longest)
            throw AgreedError(
                1,
                fmt::format("not quiet after settle.longest = {:.4g} s ({} steps): the acceleration is "
                            "{:.3g} of gravity's (allowed: {:.3g}), the largest speed {:.3g} m/s{}; quiet "
                            "must last {:.4g} s; a larger settle.imbalance or settle.longest, or "
                            "settle.bodies without it",
                            longest, now.steps, now.imbalance, plan.imbalance, now.largest_speed,
                            plan.largest_speed ? fmt::format(" (allowed: {:.3g})", *plan.largest_speed) : "",
                            now.quiet_for));
    }
}

/// Adds particles to a set; what is no part of a new particle's state stays zero.
void append(ParticleSet& set, const ParticleSet& more, std::span<const FieldInfo* const> fields) {
    const std::size_t before = set.size();
    set.resize(before + more.size());
    for (const FieldInfo* info : fields) {
        if (!set.has(*info)) continue;
        Column& to = set.column(*info);
        const Column& from = more.column(*info);
        const std::size_t bytes = to.value_size();
        for (std::size_t c = 0; c < to.components.size() && more.size() > 0; ++c)
            std::memcpy(to.components[c].data() + before * bytes, from.components[c].data(),
                        more.size() * bytes);
    }
}

constexpr std::array<const FieldInfo*, 12> kept_fields = {
    &field::id,     &field::position,       &field::velocity,        &field::mass,
    &field::body,   &field::density,        &field::internal_energy, &field::smoothing_length,
    &field::damage, &field::flaw_threshold, &field::flaw_exponent,   &field::flaw_count};

/// Back about the centre of mass from before, with the motion that the scene gives the body.
void set_going(const Body& body, const Point& shift, const Point& centre_of_mass, ParticleSet& particles) {
    for (std::size_t i = 0; i < particles.size(); ++i) {
        Point x{};
        for (int a = 0; a < particles.dimension(); ++a) {
            double& along = particles.data(field::position, a)[i];
            along += shift[static_cast<std::size_t>(a)];
            x[static_cast<std::size_t>(a)] = along;
        }
        const Point v = velocity_at(body, x, centre_of_mass, particles.dimension());
        for (int a = 0; a < particles.dimension(); ++a)
            particles.data(field::velocity, a)[i] = v[static_cast<std::size_t>(a)];
    }
}

/// Bodies that swell or change their form may reach into each other, which their shapes as given did not.
void refuse_overlap(const Communicator& comm, const std::vector<Body>& bodies, const ParticleSet& particles) {
    constexpr double closest = 0.5;  // distance over the mean spacing of both
    ParticleSet points(particles.name(), particles.dimension());
    points.add(field::body);
    append(points, particles, kept_fields);
    points.add(field::radius);
    for (std::size_t i = 0; i < points.size(); ++i)
        points.data(field::radius)[i] = 0.5 * closest * bodies[points.data(field::body)[i]].spacing;
    const Overlaps found = overlaps_of(comm, points, Between::different_bodies);
    if (found.pairs > 0)
        throw AgreedError(
            1, fmt::format("bodies overlap once they have settled: {} pairs of particles of different "
                           "bodies are closer than {} spacings; place them farther apart",
                           found.pairs, closest));
}

}  // namespace

std::optional<SettlePlan> read_settle(const Section& root, const std::vector<Body>& bodies,
                                      const std::vector<BodyCensus>& census, const Setup& simulation) {
    const Section table = root.section("settle");
    if (!table.exists()) return {};
    constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
    if (!simulation.gravity) table.error("", "bodies settle in their own gravity: the scene needs [gravity]");
    SettlePlan plan;
    plan.imbalance = table.number("imbalance", "1", default_imbalance, {0, 1, true});
    if (table.has("largest_speed")) plan.largest_speed = table.number("largest_speed", "m/s", {}, positive);
    if (table.has("damping")) plan.damping = table.number("damping", "s", {}, positive);
    if (table.has("longest")) plan.longest = table.number("longest", "s", {}, positive);
    std::vector<std::string> all, large;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (simulation.held[b]) continue;
        all.push_back(bodies[b].name);
        if (census[b].count >= least_particles) large.push_back(bodies[b].name);
    }
    const std::vector<std::string> names = table.texts("bodies", 0, large);
    if (names.empty())
        table.error("bodies",
                    fmt::format("no body settles: none that moves has {} particles", least_particles));
    for (const std::string& name : names)
        if (std::find(all.begin(), all.end(), name) == all.end())
            table.error("bodies",
                        fmt::format("'{}' is no body that moves (allowed: {})", name, fmt::join(all, ", ")));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Body& body = bodies[b];
        plan.bodies.push_back(std::find(names.begin(), names.end(), body.name) != names.end());
        if (!plan.bodies.back() || !plan.longest) continue;
        const double quiet = sound_passage(body, simulation.materials[b], simulation.box.dimension);
        if (*plan.longest < quiet)
            table.error("longest",
                        fmt::format("body '{}' must be quiet for {:.4g} s, as long as sound passes "
                                    "through it; allowed: more than that",
                                    body.name, quiet));
    }
    return plan;
}

std::string describe(const Settling& settling) {
    return fmt::format(
        "body '{}' settled in {:.4g} s, {} steps, damped in {:.3g} s, and was quiet for {:.3g} s: "
        "acceleration "
        "{:.3g} of gravity's, largest speed {:.3g} m/s, kinetic over potential energy {:.2e}; greatest "
        "pressure {:.4g} Pa, size changed by {:+.2e}",
        settling.body, settling.time, settling.steps, settling.damping, settling.quiet_for,
        settling.imbalance, settling.largest_speed, settling.kinetic_share, settling.greatest_pressure,
        settling.growth);
}

std::vector<Settling> settle(const Communicator& comm, const SceneSetup& scene, ParticleSet& particles,
                             const std::function<void()>& before_step) {
    std::vector<Settling> result;
    if (!scene.settle) return result;
    const SettlePlan& plan = *scene.settle;
    const Setup fluids = as_fluids(scene.simulation);
    ParticleSet settled = empty_particles(scene);
    std::vector<const FieldInfo*> all_fields;
    for (const Column& column : particles.columns()) all_fields.push_back(column.info);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const Body& body = scene.bodies[b];
        std::vector<std::uint32_t> chosen;
        for (std::uint32_t i = 0; i < particles.size(); ++i)
            if (particles.data(field::body)[i] == b) chosen.push_back(i);
        ParticleSet alone = selected(particles.name(), particles, chosen, all_fields);
        if (!plan.bodies[b]) {
            append(settled, alone, kept_fields);
            continue;
        }
        damp(alone, 0);
        Settling start{.body = body.name};
        start.quiet_for = sound_passage(body, scene.simulation.materials[b], particles.dimension());
        // Critical for the breathing of a body, whose period is about twice the radius over the speed of
        // sound.
        start.damping = plan.damping.value_or(start.quiet_for / (4 * std::numbers::pi));
        const double longest = plan.longest.value_or(default_longest * start.quiet_for);
        const Middle before = middle_of(comm, alone);
        Simulation run(comm, fluids, std::move(alone));
        try {
            result.push_back(come_to_rest(plan, longest, start, run, before_step));
        } catch (const AgreedError& error) {
            throw AgreedError(error.exit_code,
                              fmt::format("settling body '{}': {}", body.name, error.what()));
        }
        const Middle after = middle_of(comm, run.particles());
        result.back().growth = after.size / before.size - 1;
        set_going(body, minus(before.centre, after.centre), before.centre, run.particles());
        append(settled, run.particles(), kept_fields);
    }
    if (!result.empty() && particles.dimension() == 3) refuse_overlap(comm, scene.bodies, settled);
    particles = std::move(settled);
    return result;
}

}  // namespace talus
