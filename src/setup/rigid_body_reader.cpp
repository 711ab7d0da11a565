#include "src/setup/rigid_body_reader.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "physics/dem/clumps/principal_axes.hpp"
#include "src/setup/body_reader.hpp"
#include "src/setup/shape_reader.hpp"
#include "src/setup/wall_reader.hpp"

namespace talus {

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};

dem::Vector3<> vector_of(const Point& p) { return {p[0], p[1], p[2]}; }

/// Whether a step away, along any axis or diagonal, lies outside.
bool is_at_surface(const BodyShape& shape, const Point& place, double step, int dimension) {
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = dimension > 2 ? -1 : 0; z <= (dimension > 2 ? 1 : 0); ++z) {
                const double length = std::sqrt(x * x + y * y + z * z);
                if (length == 0) continue;
                if (!contains(shape, plus(place, times(step / length, Point{1.0 * x, 1.0 * y, 1.0 * z})),
                              dimension))
                    return true;
            }
    return false;
}

/// Mean of x_a x_b over a shape, about its centre [m2].
struct SecondMoments {
    int dimension;

    Eigen::Matrix3d operator()(const BoxShape& box) const {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        for (int a = 0; a < dimension; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            sum(a, a) = std::pow(box.upper[axis] - box.lower[axis], 2) / 12;
        }
        return sum;
    }
    Eigen::Matrix3d operator()(const SphereShape& sphere) const {
        const auto power = [&](int n) {
            return std::pow(sphere.radius, n) - std::pow(sphere.inner_radius, n);
        };
        return power(dimension + 2) / power(dimension) / (dimension + 2) * Eigen::Matrix3d::Identity();
    }
    Eigen::Matrix3d operator()(const EllipsoidShape& ellipsoid) const {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
            const auto& rows = ellipsoid.orientation.rows;
            const Eigen::Vector3d axis(rows[0][k], rows[1][k], rows[2][k]);
            sum += std::pow(ellipsoid.semi_axes[k], 2) / (dimension + 2) * axis * axis.transpose();
        }
        return sum;
    }
    Eigen::Matrix3d operator()(const MeshShape& mesh) const {
        const VolumeIntegrals& integrals = mesh.surface->integrals();
        Eigen::Matrix3d sum;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                sum(a, b) =
                    integrals.second_moments[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] /
                    integrals.volume;
        return sum;
    }
};

}  // namespace

bool RigidBodyReader::any() const {
    return std::ranges::any_of(tables_, [](const auto& table) { return table.has_value(); });
}

void RigidBodyReader::read(const Section& body, bool is_wall) {
    const Section table = body.section("rigid");
    sections_.push_back(table);
    tables_.emplace_back();
    if (!table.exists()) return;
    if (!is_wall) body.error("rigid", "is of bodies with wall = \"no_slip\" or \"free_slip\"");
    if (body.has("motion")) body.error("motion", "does not go with [body.rigid]: the water moves the body");
    RigidTable& found = tables_.back().emplace();
    if (table.has("material")) {
        if (!laws_) laws_.emplace(root_);
        found.material = laws_->material(table);
        found.density = laws_->materials()[*found.material].density;
    }
    if (table.has("density") && table.has("mass")) table.error("mass", "give density or mass, not both");
    if (table.has("mass"))
        found.mass = table.number("mass", dimension_ == 2 ? "kg/m" : "kg", {}, positive);
    else if (table.has("density") || !found.material)
        found.density = table.number("density", "kg/m3", {}, positive);
    found.velocity = vector_of(origin_default(table, "velocity", "m/s", dimension_));
    found.spin = vector_of(read_spin(table, dimension_));
    found.force = vector_of(origin_default(table, "force", dimension_ == 2 ? "N/m" : "N", dimension_));
}

rigid::Body RigidBodyReader::make_body(std::size_t b, const Body& form, const BodyCensus& census,
                                       rigid::State& state) const {
    const RigidTable& table = *tables_[b];
    const double spacing = std::pow(census.particle_volume, 1.0 / dimension_);
    const auto count = static_cast<double>(census.count);
    rigid::Body body;
    body.name = form.name;
    body.index = static_cast<std::uint8_t>(b);
    body.mass = table.mass > 0 ? table.mass : table.density * census.particle_volume * count;
    body.force = table.force;
    body.first_id = census.first_id;
    Eigen::Matrix3d second = body.mass * std::visit(SecondMoments{dimension_}, form.shape);
    std::vector<std::pair<Point, std::uint64_t>> surface;
    std::uint64_t id = census.first_id;
    for_each_point(form.shape, form.cell, form.spacing, dimension_, [&](const Point& place) {
        if (is_at_surface(form.shape, place, spacing, dimension_)) surface.emplace_back(place, id);
        ++id;
    });
    body.area = static_cast<double>(surface.size()) * std::pow(spacing, dimension_ - 1);
    state.centre = vector_of(census.centre_of_mass);
    state.velocity = table.velocity;
    if (dimension_ == 2) {
        state.centre.z = 0;
        const double moment = second(0, 0) + second(1, 1);
        body.inertia = {moment, moment, moment};
    } else {
        constexpr double rounding = 1e-9;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                if (row != column && std::abs(second(row, column)) < rounding * second.trace())
                    second(row, column) = 0;
        const dem::PrincipalAxes principal = dem::principal_axes(second);
        body.inertia = {principal.moments[0], principal.moments[1], principal.moments[2]};
        const Eigen::Quaterniond turn(principal.axes);
        state.orientation = {turn.w(), {turn.x(), turn.y(), turn.z()}};
    }
    const dem::RotationMatrix axes(state.orientation);
    state.angular_momentum = dem::angular_momentum(table.spin, body.inertia, axes);
    if (!table.material) return body;
    body.material = *table.material;
    if (const auto* sphere = std::get_if<SphereShape>(&form.shape)) {
        body.spheres.push_back({{}, sphere->radius, census.first_id});
    } else {
        for (const auto& [place, of] : surface)
            body.spheres.push_back({axes.turned_back(vector_of(place) - state.centre), spacing / 2, of});
    }
    if (dimension_ == 2)
        for (rigid::ContactSphere& sphere : body.spheres) sphere.place.z = 0;
    for (const rigid::ContactSphere& sphere : body.spheres) {
        const dem::Vector3<>& p = sphere.place;
        body.bounding_radius = std::max(body.bounding_radius, norm(p) + sphere.radius);
        body.lower = {std::min(body.lower.x, p.x), std::min(body.lower.y, p.y), std::min(body.lower.z, p.z)};
        body.upper = {std::max(body.upper.x, p.x), std::max(body.upper.y, p.y), std::max(body.upper.z, p.z)};
    }
    return body;
}

RigidSetup RigidBodyReader::make(const Communicator& comm, const Scene& scene, const Box& box,
                                 const std::vector<Body>& bodies, const std::vector<BodyCensus>& census,
                                 double kernel_radius, std::vector<std::string>& warnings) {
    RigidSetup setup;
    double largest_radius = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (!is_rigid(b)) continue;
        constexpr double rounding = 1e-9;
        const double least = thickness(bodies[b].shape, dimension_);
        if (least < kernel_radius * (1 - rounding))
            sections_[b].error("",
                               fmt::format("body '{}' is {:.4g} m thick, and the kernel of the water reaches "
                                           "{:.4g} m: water would feel water through it; allowed: at least "
                                           "that",
                                           bodies[b].name, least, kernel_radius));
        constexpr double enough = 8;
        const double spacing = std::pow(census[b].particle_volume, 1.0 / dimension_);
        if (least < enough * spacing * (1 - rounding))
            warnings.push_back(
                fmt::format("rigid body '{}' is {:.3g} particles across; forces of the water on it "
                            "are resolved from 8 to 10 on",
                            bodies[b].name, least / spacing));
        if (!tables_[b]->material)
            warnings.push_back(fmt::format(
                "rigid body '{}' names no material: it touches no other body and no wall", bodies[b].name));
        rigid::State state;
        setup.bodies.push_back(make_body(b, bodies[b], census[b], state));
        setup.states.push_back(state);
        for (const rigid::ContactSphere& sphere : setup.bodies.back().spheres)
            largest_radius = std::max(largest_radius, sphere.radius);
    }
    if (std::ranges::find(box.boundary, Boundary::reflecting) != box.boundary.end())
        root_.section("box").error("boundaries",
                                   "\"reflecting\" does not go with rigid bodies: nothing would hold them "
                                   "there; allowed: open, periodic");
    if (!laws_) return setup;
    setup.walls = read_walls({.comm = comm, .scene = scene, .box = box, .largest_radius = largest_radius},
                             *laws_, warnings);
    laws_->read_pairs();
    if (setup.walls.empty())
        warnings.emplace_back(
            "there is no [[wall]]: rigid bodies meet walls of particles only by the water "
            "between them");
    if (!scene.faulty()) setup.laws = laws_->table();
    return setup;
}

void put_places_in_bodies(const RigidSetup& setup, ParticleSet& particles) {
    for (std::size_t k = 0; k < setup.bodies.size(); ++k) {
        const dem::RotationMatrix axes(setup.states[k].orientation);
        for (std::size_t i = 0; i < particles.size(); ++i) {
            if (particles.data(field::body)[i] != setup.bodies[k].index) continue;
            std::array<double, 3> at{};
            for (int a = 0; a < particles.dimension(); ++a)
                at[static_cast<std::size_t>(a)] = particles.data(field::position, a)[i];
            const dem::Vector3<> place = axes.turned_back(vector_of(at) - setup.states[k].centre);
            const std::array<double, 3> along{place.x, place.y, place.z};
            for (int a = 0; a < particles.dimension(); ++a)
                particles.data(field::place_in_body, a)[i] = along[static_cast<std::size_t>(a)];
        }
    }
}

}  // namespace talus
