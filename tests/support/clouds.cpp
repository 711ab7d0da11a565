#include "tests/support/clouds.hpp"

#include <algorithm>
#include <cmath>

#include "domain/random.hpp"

namespace talus::test {

namespace {

constexpr RandomStream draws{.seed = 21};

double draw(std::size_t k, std::uint32_t counter) { return draws.uniform(k, counter); }

Box make_box(int dimension, std::array<Boundary, 3> boundary, std::array<double, 3> length = {1, 1, 1}) {
    Box box;
    box.dimension = dimension;
    box.lower = {-0.25, 0.5, 0};
    for (std::size_t a = 0; a < 3; ++a) box.upper[a] = box.lower[a] + length[a];
    box.boundary = boundary;
    return box;
}

Cloud spread(std::string name, const Box& box, double radius, std::size_t count) {
    Cloud cloud{std::move(name), box, radius, {}};
    for (std::size_t k = 0; k < count; ++k) {
        std::array<double, 3> point{};
        for (int axis = 0; axis < box.dimension; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            point[a] = box.lower[a] + box.length(axis) * draw(k, static_cast<std::uint32_t>(a));
        }
        cloud.points.push_back(point);
    }
    return cloud;
}

/// Spacing a quarter of the radius, a power of two: neighbours sit exactly on cell borders and on the radius.
Cloud lattice(std::string name, int dimension, Boundary boundary) {
    Cloud cloud{std::move(name), make_box(dimension, {boundary, boundary, boundary}), 0.25, {}};
    const int n = 16, ny = dimension > 1 ? n : 1, nz = dimension > 2 ? 8 : 1;
    if (dimension > 2) cloud.box.upper[2] = cloud.box.lower[2] + 0.5;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < n; ++x) {
                std::array<double, 3> point = cloud.box.lower;
                // Off the walls, or a particle and its mirror image would coincide.
                const double off = boundary == Boundary::reflecting ? 0.5 : 0;
                const std::array<int, 3> at{x, y, z};
                for (int a = 0; a < 3; ++a)
                    point[static_cast<std::size_t>(a)] =
                        a < dimension ? point[static_cast<std::size_t>(a)] +
                                            (at[static_cast<std::size_t>(a)] + off) / 16.0
                                      : 0;
                cloud.points.push_back(point);
            }
    return cloud;
}

template <class Move>
Cloud moved(std::string name, Cloud cloud, Move&& move) {
    cloud.name = std::move(name);
    for (std::size_t k = 0; k < cloud.points.size(); ++k) move(k, cloud.points[k]);
    return cloud;
}

}  // namespace

std::vector<Cloud> all_clouds() {
    constexpr Boundary open = Boundary::open, periodic = Boundary::periodic,
                       reflecting = Boundary::reflecting;
    std::vector<Cloud> clouds;
    clouds.push_back(spread("spread 1D", make_box(1, {open}), 0.05, 200));
    clouds.push_back(spread("spread 2D", make_box(2, {}), 0.1, 500));
    clouds.push_back(spread("spread 3D", make_box(3, {}), 0.2, 800));
    clouds.push_back(spread("periodic 1D", make_box(1, {periodic}), 0.07, 100));
    clouds.push_back(spread("periodic 2D", make_box(2, {periodic, periodic}), 0.11, 400));
    clouds.push_back(spread("periodic 3D", make_box(3, {periodic, periodic, periodic}), 0.23, 500));
    clouds.push_back(spread("reflecting 1D", make_box(1, {reflecting}), 0.07, 100));
    clouds.push_back(spread("reflecting 2D", make_box(2, {reflecting, reflecting}), 0.11, 400));
    clouds.push_back(spread("reflecting 3D", make_box(3, {reflecting, reflecting, reflecting}), 0.23, 500));
    clouds.push_back(spread("mixed 3D", make_box(3, {reflecting, periodic, open}), 0.23, 500));
    clouds.push_back(spread("narrow periodic 2D", make_box(2, {periodic, open}, {0.125, 1, 1}), 0.125, 100));
    clouds.push_back(
        spread("narrow reflecting 2D", make_box(2, {open, reflecting}, {1, 0.125, 1}), 0.125, 100));
    clouds.push_back(spread("narrow periodic 3D",
                            make_box(3, {periodic, periodic, periodic}, {0.25, 0.25, 0.25}), 0.25, 60));
    clouds.push_back(lattice("lattice 1D", 1, open));
    clouds.push_back(lattice("lattice 2D", 2, periodic));
    clouds.push_back(lattice("lattice 3D", 3, open));
    clouds.push_back(lattice("reflecting lattice 2D", 2, reflecting));
    clouds.push_back(
        moved("crowded 3D", spread("", make_box(3, {}), 0.1, 500), [](std::size_t k, auto& point) {
            const double scale = std::exp2(-12 * draw(k, 9));
            for (double& x : point) x = (x - 0.3) * scale;
        }));
    clouds.push_back(moved("one cell 2D", spread("", make_box(2, {}), 0.5, 60), [](std::size_t, auto& point) {
        for (std::size_t a = 0; a < 2; ++a) point[a] = 10.01 + 0.01 * point[a];
    }));
    clouds.push_back(moved("one cell periodic 3D",
                           spread("", make_box(3, {periodic, periodic, periodic}), 0.5, 40),
                           [](std::size_t, auto& point) {
                               for (std::size_t a = 0; a < 3; ++a) point[a] = 0.6 + 0.01 * point[a];
                           }));
    clouds.push_back(moved("one in the corner 2D", spread("", make_box(2, {reflecting, reflecting}), 0.3, 1),
                           [](std::size_t, auto& point) {
                               point = {-0.249, 0.501, 0};
                           }));
    clouds.push_back(
        moved("fragments far away 3D", spread("", make_box(3, {}), 0.2, 600), [](std::size_t k, auto& point) {
            if (k % 10 != 0) return;
            const double distance = 0.2 * 1e4 * (k % 3 == 0 ? 1e3 : 1);  // the furthest beyond the last cell
            point[k / 10 % 3] += k % 20 == 0 ? distance : -distance;
        }));
    return clouds;
}

std::vector<std::size_t> all_points(const Cloud& cloud) {
    std::vector<std::size_t> all(cloud.points.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
    return all;
}

ParticleSet make_particles(const Cloud& cloud, const std::vector<std::size_t>& keep) {
    ParticleSet particles("cloud", cloud.box.dimension);
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::mass, &field::body, &field::velocity, &field::deviatoric_stress, &field::flaw_threshold,
             &field::flaw_count, &field::velocity_gradient, &field::predicted_velocity, &field::pressure,
             &field::predicted_stress})
        particles.add(*info);
    particles.resize(keep.size());
    for (std::size_t i = 0; i < keep.size(); ++i) {
        const std::uint64_t id = keep[i] * 7919 % 100003 + 1;
        particles.data(field::id)[i] = id;
        particles.data(field::mass)[i] = static_cast<double>(id);
        for (int axis = 0; axis < cloud.box.dimension; ++axis)
            particles.data(field::position, axis)[i] = cloud.points[keep[i]][static_cast<std::size_t>(axis)];
    }
    fill_values(particles, Role::state);
    return particles;
}

double value_of(const FieldInfo& field, int component, std::uint64_t id) {
    const auto counter =
        static_cast<std::uint32_t>(field.name.size() * 16) + static_cast<std::uint32_t>(component);
    const double value = draws.uniform(id, 100 + counter) - 0.5;
    switch (field.type) {
        case ValueType::f64:
            return value;
        case ValueType::f32:
            return static_cast<float>(value);
        default:
            return std::floor(100 * std::abs(value));
    }
}

void fill_values(ParticleSet& particles, Role role) {
    const auto fill = [&](const auto& field) {
        using T = typename std::decay_t<decltype(field)>::value_type;
        if (field.role != role || !particles.has(field)) return;
        for (int c = 0; c < component_count(field.shape, particles.dimension()); ++c)
            for (std::size_t i = 0; i < particles.size(); ++i)
                particles.data(field, c)[i] =
                    static_cast<T>(value_of(field, c, particles.data(field::id)[i]));
    };
    fill(field::body);
    fill(field::velocity);
    fill(field::deviatoric_stress);
    fill(field::flaw_threshold);
    fill(field::flaw_count);
    fill(field::velocity_gradient);
    fill(field::predicted_velocity);
    fill(field::pressure);
    fill(field::predicted_stress);
}

std::vector<Sighting> brute_force(const Cloud& cloud, const std::vector<Point>& points, const Point& centre) {
    struct AxisImage {
        double shift;
        bool flip;
    };
    std::array<std::vector<AxisImage>, 3> along{};
    for (std::size_t a = 0; a < 3; ++a) {
        along[a] = {{0, false}};
        if (static_cast<int>(a) >= cloud.box.dimension) continue;
        if (cloud.box.boundary[a] == Boundary::periodic)
            for (const double turns : {-2., -1., 1., 2.})
                along[a].push_back({turns * cloud.box.length(static_cast<int>(a)), false});
        if (cloud.box.boundary[a] == Boundary::reflecting) {
            along[a].push_back({2 * cloud.box.lower[a], true});
            along[a].push_back({2 * cloud.box.upper[a], true});
        }
    }
    std::vector<Sighting> found;
    for (const Point& point : points)
        for (const AxisImage& x : along[0])
            for (const AxisImage& y : along[1])
                for (const AxisImage& z : along[2]) {
                    const std::array<AxisImage, 3> image{x, y, z};
                    Sighting sighting{point.id, {}, {x.flip, y.flip, z.flip}};
                    bool original = true;
                    double r2 = 0;
                    for (std::size_t a = 0; a < static_cast<std::size_t>(cloud.box.dimension); ++a) {
                        original = original && image[a].shift == 0 && !image[a].flip;
                        const double p = point.position[a];
                        sighting.position[a] = (image[a].flip ? -p : p) + image[a].shift;
                        const double d = centre.position[a] - sighting.position[a];
                        r2 += d * d;
                    }
                    if (original && point.id == centre.id) continue;
                    if (r2 < cloud.radius * cloud.radius) found.push_back(sighting);
                }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace talus::test
