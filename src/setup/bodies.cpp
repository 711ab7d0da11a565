#include "src/setup/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "domain/random.hpp"
#include "src/setup/geostatic.hpp"

namespace talus {

namespace {

/// Shape of the first bending mode of a clamped thin beam at x/length = s; k length = 1.875104.
double cantilever_mode(double s) {
    constexpr double k = 1.8751040687119611;
    return (std::cos(k) + std::cosh(k)) * (std::cosh(k * s) - std::cos(k * s)) +
           (std::sin(k) - std::sinh(k)) * (std::sinh(k * s) - std::sin(k * s));
}

struct VelocityAt {
    const Point& x;
    int dimension;

    Point operator()(std::monostate) const { return {}; }
    Point operator()(const SineVelocity& wave) const {
        double angle = wave.phase;
        for (std::size_t a = 0; a < 3; ++a) angle += wave.wave_vector[a] * x[a];
        Point v = wave.amplitude;
        for (double& component : v) component *= std::sin(angle);
        return v;
    }
    Point operator()(const CantileverVelocity& bend) const {
        const double s = (x[0] - bend.clamp) / bend.length;
        return {0, s > 0 ? bend.tip_velocity * cantilever_mode(s) / cantilever_mode(1) : 0, 0};
    }
    Point operator()(const StretchVelocity& stretch) const {
        Point v{};
        for (std::size_t a = 0; a < 3; ++a) v[a] = stretch.rate[a] * (x[a] - stretch.centre[a]);
        return v;
    }
    Point operator()(const RadialVelocity& flow) const {
        Point v{};
        double r2 = 0;
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
            v[a] = x[a] - flow.centre[a];
            r2 += v[a] * v[a];
        }
        const double r = std::sqrt(r2);
        const double speed = flow.speed * (flow.radius > 0 ? std::pow(flow.radius / r, dimension - 1) : 1);
        for (double& component : v) component *= r > 0 ? -speed / r : 0;
        return v;
    }
    Point operator()(const VortexVelocity& vortices) const {
        const double k = 2 * std::numbers::pi / vortices.length;
        return {-vortices.speed * std::cos(k * x[0]) * std::sin(k * x[1]),
                vortices.speed * std::sin(k * x[0]) * std::cos(k * x[1]), 0};
    }
    Point operator()(const StandingWaveVelocity& wave) const {
        const auto up = static_cast<std::size_t>(dimension - 1);
        const double k = 2 * std::numbers::pi / wave.length, above = x[up] - wave.bottom,
                     scale = wave.speed / std::sinh(k * wave.depth);
        Point v{};
        v[0] = -scale * std::sin(k * x[0]) * std::cosh(k * above);
        v[up] = scale * std::cos(k * x[0]) * std::sinh(k * above);
        return v;
    }
};

}  // namespace

Point velocity_at(const Body& body, const Point& x, const Point& centre_of_mass, int dimension) {
    const Point field = std::visit(VelocityAt{x, dimension}, body.velocity_field);
    return plus(field, plus(body.velocity, cross(body.spin, minus(x, centre_of_mass))));
}

namespace {

/// Where a point of an even sphere goes so that its distance from the centre encloses the same mass.
Point displaced(const Body& body, const Point& x) {
    if (body.profile == DensityProfile::even) return x;
    const auto& sphere = std::get<SphereShape>(body.shape);
    const Point arm = minus(x, sphere.centre);
    const double even = norm(arm) / sphere.radius;
    if (even == 0) return x;
    const double radius = radius_enclosing(body.profile, enclosed_mass(DensityProfile::even, even));
    return plus(sphere.centre, times(radius / even, arm));
}

/// Density at a particle over the mean of its body. At the centre that of the innermost particle's share.
double relative_density(const Body& body, const BodyCensus& census, const Point& x) {
    if (body.profile == DensityProfile::even) return 1;
    const auto& sphere = std::get<SphereShape>(body.shape);
    const double least = radius_enclosing(body.profile, 0.5 / static_cast<double>(census.count));
    return density_at(body.profile, std::max(least, norm(minus(x, sphere.centre)) / sphere.radius));
}

/// Whether a point of a body's packing is no particle.
bool is_left_out(const Body& body, const Point& point, int dimension) {
    return std::ranges::any_of(body.left_out, [&](const BodyShape& region) {
        return contains(bounds(region, dimension), point, dimension) && contains(region, point, dimension);
    });
}

/// Calls visit(id, position) for every particle of a body.
template <class Visit>
void for_each_particle(const Body& body, std::uint64_t first_id, int dimension, std::uint64_t seed,
                       Visit&& visit) {
    const RandomStream displacement{seed, RandomPurpose::positions, 0};
    std::uint64_t id = first_id;
    for_each_point(body.shape, body.cell, body.spacing, dimension, [&](const Point& point) {
        if (is_left_out(body, point, dimension)) return;
        Point x = displaced(body, point);
        for (int a = 0; a < dimension && body.jitter > 0; ++a)
            x[static_cast<std::size_t>(a)] +=
                body.jitter * body.spacing *
                (2 * displacement.uniform(id, static_cast<std::uint32_t>(a)) - 1);
        visit(id++, x);
    });
}

void draw_flaws(ParticleSet& particles, const Fracture& fracture, double body_volume, std::uint64_t count,
                std::uint64_t seed, std::uint8_t body) {
    const FlawSampler sampler(fracture, body_volume, count, seed, body);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (particles.data(field::body)[i] != body) continue;
        const Flaws flaws = sampler.sample(particles.data(field::id)[i]);
        particles.data(field::flaw_threshold)[i] = flaws.threshold;
        particles.data(field::flaw_exponent)[i] = flaws.exponent;
        particles.data(field::flaw_count)[i] = flaws.count;
    }
}

struct NewParticle {
    std::uint64_t id;
    std::uint8_t body;
    Point x;
};

void put_particle(ParticleSet& particles, std::size_t i, const NewParticle& made, const Body& body,
                  const BodyCensus& census, double eta) {
    const int dimension = particles.dimension();
    const Point v = velocity_at(body, made.x, census.centre_of_mass, dimension);
    particles.data(field::id)[i] = made.id;
    for (int a = 0; a < dimension; ++a) {
        particles.data(field::position, a)[i] = made.x[static_cast<std::size_t>(a)];
        particles.data(field::velocity, a)[i] = v[static_cast<std::size_t>(a)];
    }
    particles.data(field::mass)[i] = body.density * census.particle_volume;
    const double relative = relative_density(body, census, made.x);
    particles.data(field::body)[i] = made.body;
    if (particles.has(field::internal_energy))
        particles.data(field::internal_energy)[i] = body.internal_energy * (body.hydrostatic ? relative : 1);
    if (particles.has(field::smoothing_length)) {
        // A lattice is fitted to a box; other shapes cut it, and keep its spacing.
        const bool fitted = body.cell.fits_boxes && std::holds_alternative<BoxShape>(body.shape);
        particles.data(field::smoothing_length)[i] =
            eta * (fitted ? std::pow(census.particle_volume, 1.0 / dimension) : body.spacing) /
            std::pow(relative, 1.0 / dimension);
    }
    if (particles.has(field::density)) particles.data(field::density)[i] = body.density * relative;
    if (particles.has(field::damage)) particles.data(field::damage)[i] = body.damage;
}

}  // namespace

std::vector<BodyCensus> take_census(const std::vector<Body>& bodies, int dimension, std::uint64_t seed) {
    std::vector<BodyCensus> result;
    std::uint64_t next_id = 0;
    for (const Body& body : bodies) {
        BodyCensus census{.first_id = next_id};
        const Point middle = centre(body.shape);
        Point arms{};
        for_each_particle(body, next_id, dimension, seed, [&](std::uint64_t, const Point& x) {
            arms = plus(arms, minus(x, middle));
            ++census.count;
        });
        if (census.count > 0) {
            std::uint64_t left_out = 0;
            if (!body.left_out.empty())
                for_each_point(body.shape, body.cell, body.spacing, dimension, [&](const Point& point) {
                    left_out += is_left_out(body, point, dimension) ? 1 : 0;
                });
            census.particle_volume =
                volume(body.shape, dimension) / static_cast<double>(census.count + left_out);
            census.mass = body.density * census.particle_volume * static_cast<double>(census.count);
            census.centre_of_mass = plus(middle, times(1 / static_cast<double>(census.count), arms));
        }
        next_id += census.count;
        result.push_back(census);
    }
    return result;
}

ParticleSet make_particles(const Communicator& comm, const std::vector<Body>& bodies,
                           const std::vector<Material>& materials, const ParticleSet& prototype,
                           const sph::Settings& settings, std::uint64_t seed) {
    ParticleSet particles = prototype;
    const int dimension = particles.dimension();
    const std::vector<BodyCensus> census = take_census(bodies, dimension, seed);
    const auto ranks = static_cast<std::uint64_t>(comm.size()),
               rank = static_cast<std::uint64_t>(comm.rank());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const std::uint64_t first_id = census[b].first_id, count = census[b].count;
        const std::uint64_t share_begin = first_id + count * rank / ranks,
                            share_end = first_id + count * (rank + 1) / ranks;
        const auto index = static_cast<std::uint8_t>(b);
        std::size_t next = particles.size();
        particles.resize(next + share_end - share_begin);
        for_each_particle(bodies[b], first_id, dimension, seed, [&](std::uint64_t id, const Point& x) {
            if (share_begin <= id && id < share_end)
                put_particle(particles, next++, {id, index, x}, bodies[b], census[b], settings.eta);
        });
        if (bodies[b].geostatic)
            for (std::size_t i = next - (share_end - share_begin); i < next; ++i)
                put_geostatic(particles, i, *bodies[b].geostatic, materials[b]);
        if (materials[b].fracture)
            draw_flaws(particles, *materials[b].fracture,
                       census[b].particle_volume * static_cast<double>(count), count, seed, index);
    }
    return particles;
}

bool overlap(const Body& a, const Body& b, int dimension) {
    const BoxShape around_a = bounds(a.shape, dimension), around_b = bounds(b.shape, dimension);
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimension); ++axis)
        if (around_a.upper[axis] <= around_b.lower[axis] || around_b.upper[axis] <= around_a.lower[axis])
            return false;
    const auto reaches_into = [dimension](const Body& body, const BodyShape& other) {
        bool found = false;
        for_each_point(body.shape, body.cell, body.spacing, dimension,
                       [&](const Point& point) { found = found || contains(other, point, dimension); });
        return found;
    };
    return reaches_into(a, b.shape) || reaches_into(b, a.shape);
}

double break_up_spin(double density, double gravitational_constant) {
    return std::sqrt(4.0 / 3 * std::numbers::pi * gravitational_constant * density);
}

double rotation_period(double spin) { return 2 * std::numbers::pi / spin; }

}  // namespace talus
