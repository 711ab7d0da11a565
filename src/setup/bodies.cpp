#include "src/setup/bodies.hpp"

#include <cmath>

#include "domain/random.hpp"

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
};

Point velocity_at(const Body& body, const Point& x, int dimension) {
    Point v = std::visit(VelocityAt{x, dimension}, body.velocity_field);
    const Point middle = centre(body.shape);
    const Point arm{x[0] - middle[0], x[1] - middle[1], x[2] - middle[2]};
    const Point& w = body.spin;
    v[0] += body.velocity[0] + w[1] * arm[2] - w[2] * arm[1];
    v[1] += body.velocity[1] + w[2] * arm[0] - w[0] * arm[2];
    v[2] += body.velocity[2] + w[0] * arm[1] - w[1] * arm[0];
    return v;
}

/// Volume that each particle of a body stands for.
double particle_volume(const Body& body, std::uint64_t count, int dimension) {
    if (std::holds_alternative<BoxShape>(body.shape))
        return volume(body.shape, dimension) / static_cast<double>(count);
    return std::pow(body.spacing, dimension);
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

void add_particle(ParticleSet& particles, std::size_t i, std::uint64_t id, const Body& body,
                  std::uint8_t index, const Point& x, double particle_size, const sph::Settings& settings) {
    const int dimension = particles.dimension();
    const Point v = velocity_at(body, x, dimension);
    particles.data(field::id)[i] = id;
    for (int a = 0; a < dimension; ++a) {
        particles.data(field::position, a)[i] = x[static_cast<std::size_t>(a)];
        particles.data(field::velocity, a)[i] = v[static_cast<std::size_t>(a)];
    }
    particles.data(field::mass)[i] = body.density * particle_size;
    particles.data(field::internal_energy)[i] = body.internal_energy;
    particles.data(field::smoothing_length)[i] = settings.eta * std::pow(particle_size, 1.0 / dimension);
    particles.data(field::body)[i] = index;
    if (particles.has(field::density)) particles.data(field::density)[i] = body.density;
    if (particles.has(field::damage)) particles.data(field::damage)[i] = body.damage;
}

}  // namespace

std::uint64_t count_particles(const Body& body, int dimension) {
    std::uint64_t count = 0;
    for_each_lattice_point(body.shape, body.lattice, body.spacing, dimension,
                           [&count](const Point&) { ++count; });
    return count;
}

ParticleSet make_particles(const Communicator& comm, const std::vector<Body>& bodies,
                           const std::vector<Material>& materials, const ParticleSet& prototype,
                           const sph::Settings& settings, std::uint64_t seed) {
    ParticleSet particles = prototype;
    const int dimension = particles.dimension();
    const auto ranks = static_cast<std::uint64_t>(comm.size()),
               rank = static_cast<std::uint64_t>(comm.rank());
    const RandomStream displacement{seed, RandomPurpose::positions, 0};
    std::uint64_t first_id = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const Body& body = bodies[b];
        const std::uint64_t count = count_particles(body, dimension);
        const double size = particle_volume(body, count, dimension);
        const std::uint64_t share_begin = count * rank / ranks, share_end = count * (rank + 1) / ranks;
        std::size_t next = particles.size();
        particles.resize(next + share_end - share_begin);
        std::uint64_t k = 0;
        for_each_lattice_point(
            body.shape, body.lattice, body.spacing, dimension, [&](const Point& lattice_point) {
                if (k >= share_begin && k < share_end) {
                    Point x = lattice_point;
                    for (int a = 0; a < dimension && body.jitter > 0; ++a)
                        x[static_cast<std::size_t>(a)] +=
                            body.jitter * body.spacing *
                            (2 * displacement.uniform(first_id + k, static_cast<std::uint32_t>(a)) - 1);
                    add_particle(particles, next++, first_id + k, body, static_cast<std::uint8_t>(b), x, size,
                                 settings);
                }
                ++k;
            });
        if (materials[b].fracture)
            draw_flaws(particles, *materials[b].fracture, size * static_cast<double>(count), count, seed,
                       static_cast<std::uint8_t>(b));
        first_id += count;
    }
    return particles;
}

}  // namespace talus
