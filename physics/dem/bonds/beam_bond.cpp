#include "physics/dem/bonds/beam_bond.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::dem {

namespace {

Vector3<> turned(const Vector3<>& stored, const BondKinematics& k) {
    return turned_into_plane(stored, k.normal, 0.5 * k.time_step * dot(k.summed_angular_velocity, k.normal));
}

}  // namespace

BondKinematics bond_kinematics(const Vector3<>& separation, const Grain<double>& first, double first_inertia,
                               const Grain<double>& second, double second_inertia, double time_step) {
    BondKinematics k;
    k.length = norm(separation);
    k.normal = (1 / k.length) * separation;
    k.summed_angular_velocity = first.angular_velocity + second.angular_velocity;
    k.velocity =
        first.velocity - second.velocity - cross(0.5 * k.length * k.summed_angular_velocity, k.normal);
    k.angular_velocity = first.angular_velocity - second.angular_velocity;
    k.effective_mass = first.mass * second.mass / (first.mass + second.mass);
    k.effective_inertia = first_inertia * second_inertia / (first_inertia + second_inertia);
    k.time_step = time_step;
    return k;
}

BeamBond::BeamBond(const BondMaterial& material, double radius, double length)
    : material_(material), length_(length), radius_(radius) {
    const double nu = material.poisson_ratio, E = material.youngs_modulus, G = E / (2 * (1 + nu));
    const double kappa = 6 * (1 + nu) / (7 + 6 * nu);
    area_ = std::numbers::pi * radius * radius;
    inertia_of_area_ = 0.25 * area_ * radius * radius;
    const double rigidity = E * inertia_of_area_;
    const double phi = material.shear_compliance ? 12 * rigidity / (kappa * G * area_ * length * length) : 0;
    axial_ = E * area_ / length;
    shear_ = 12 * rigidity / (length * length * length * (1 + phi));
    bending_ = rigidity / length;
    torsion_ = G * 2 * inertia_of_area_ / length;
}

BondResponse BeamBond::operator()(const BondKinematics& k, History& history) const {
    const double approach = -dot(k.velocity, k.normal), twisting = dot(k.angular_velocity, k.normal);
    const Vector3<> sliding = tangential_part(k.velocity, k.normal),
                    bending_rate = tangential_part(k.angular_velocity, k.normal);
    const Vector3<> shear = turned({history[0], history[1], history[2]}, k) + k.time_step * sliding;
    const Vector3<> bend = turned({history[3], history[4], history[5]}, k) + k.time_step * bending_rate;
    const double twist = history[6] + k.time_step * twisting;
    history = {shear.x, shear.y, shear.z, bend.x, bend.y, bend.z, twist};

    const double tension = axial_ * (k.length - length_);
    const Vector3<> shear_force = -(shear_ * shear), bending_couple = -(bending_ * bend);
    const double twisting_couple = -torsion_ * twist;

    const auto dashpot = [&](double stiffness, double inertia) {
        return 2 * material_.damping_ratio * std::sqrt(stiffness * inertia);
    };
    BondResponse r;
    const double m = k.effective_mass, I = k.effective_inertia;
    r.load.force =
        (dashpot(axial_, m) * approach - tension) * k.normal + shear_force - dashpot(shear_, m) * sliding;
    r.load.couple = (twisting_couple - dashpot(torsion_, I) * twisting) * k.normal + bending_couple -
                    dashpot(bending_, I) * bending_rate;

    // Moments at the two ends: the couple and what the shear force has over half the length.
    const Vector3<> lever = cross(0.5 * k.length * k.normal, shear_force);
    const double moment = std::max(norm(bending_couple - lever), norm(bending_couple + lever));
    r.tensile_stress = tension / area_ + moment * radius_ / inertia_of_area_;
    r.shear_stress = norm(shear_force) / area_ + std::abs(twisting_couple) * radius_ / (2 * inertia_of_area_);
    return r;
}

double BeamBond::stable_step(double mass, double inertia, int bonds_of_a_grain) const {
    // Row sums of the stiffness over the mass (Gershgorin), with rotations as displacements at the middle of
    // a bond.
    const double arm = 0.5 * length_, n = bonds_of_a_grain;
    const double moving = n * std::max(2 * axial_, 4 * shear_) / mass;
    const double turning = n * std::max(4 * shear_ * arm * arm + 2 * bending_, 2 * torsion_) / inertia;
    const double undamped = 2 / std::sqrt(std::max(moving, turning));
    const double xi = material_.damping_ratio;
    return undamped * (std::sqrt(1 + xi * xi) - xi);
}

}  // namespace talus::dem
