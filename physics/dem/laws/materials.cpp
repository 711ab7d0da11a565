#include "physics/dem/laws/materials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus::dem {

namespace {

double least_force(EndOfContact end) {
    return end == EndOfContact::may_attract ? -std::numeric_limits<double>::infinity() : 0;
}

/// gamma_t / sqrt(k_n m*) of a Hertzian contact, whose tangent stiffness is 3/2 k_n.
double mindlin_damping(const PairProperties& pair, double normal_damping) {
    const double stiffness_ratio = 4 * pair.effective_shear_modulus / pair.effective_modulus;
    return normal_damping * std::sqrt(stiffness_ratio);
}

}  // namespace

double shear_modulus(const GrainMaterial& material) {
    return material.youngs_modulus / (2 * (1 + material.poisson_ratio));
}

void MaterialPairs::state(std::size_t a, std::size_t b, const PairOverride& stated) {
    stated_[std::minmax(a, b)] = stated;
}

PairProperties MaterialPairs::operator()(std::size_t a, std::size_t b) const {
    const auto [low, high] = std::minmax(a, b);
    const GrainMaterial &one = materials_[low], &other = materials_[high];
    const auto found = stated_.find({low, high});
    const PairOverride stated = found == stated_.end() ? PairOverride{} : found->second;
    const auto compliance = [](const GrainMaterial& m) {
        return (1 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
    };
    const auto shear_compliance = [](const GrainMaterial& m) {
        return (2 - m.poisson_ratio) / shear_modulus(m);
    };
    const auto mixed = [&](double GrainMaterial::*property, const std::optional<double>& given) {
        return given ? *given : std::sqrt(one.*property * other.*property);
    };
    return {.effective_modulus = 1 / (compliance(one) + compliance(other)),
            .effective_shear_modulus = 1 / (shear_compliance(one) + shear_compliance(other)),
            .restitution = mixed(&GrainMaterial::restitution, stated.restitution),
            .friction = mixed(&GrainMaterial::friction, stated.friction),
            .rolling_friction = mixed(&GrainMaterial::rolling_friction, stated.rolling_friction),
            .rolling_damping = mixed(&GrainMaterial::rolling_damping, stated.rolling_damping),
            .twisting_friction = mixed(&GrainMaterial::twisting_friction, stated.twisting_friction),
            .work_of_adhesion = mixed(&GrainMaterial::work_of_adhesion, stated.work_of_adhesion)};
}

HertzMindlin<double> hertz_mindlin(const PairProperties& pair, EndOfContact end) {
    const double damping = hertz_damping(pair.restitution, end);
    return {.effective_modulus = pair.effective_modulus,
            .effective_shear_modulus = pair.effective_shear_modulus,
            .normal_damping = damping,
            .tangential_damping = mindlin_damping(pair, damping),
            .least_force = least_force(end)};
}

JohnsonKendallRoberts<double> johnson_kendall_roberts(const PairProperties& pair) {
    const double damping = hertz_damping(pair.restitution, EndOfContact::may_attract);
    return {.effective_modulus = pair.effective_modulus,
            .effective_shear_modulus = pair.effective_shear_modulus,
            .normal_damping = damping,
            .tangential_damping = mindlin_damping(pair, damping),
            .work_of_adhesion = pair.work_of_adhesion};
}

LinearSpring<double> linear_spring(const PairProperties& pair, double stiffness, double ratio,
                                   EndOfContact end) {
    const double damping = linear_damping(pair.restitution, end);
    return {.normal_stiffness = stiffness,
            .tangential_stiffness = ratio * stiffness,
            .normal_damping = damping,
            .tangential_damping = damping * std::sqrt(ratio),
            .least_force = least_force(end)};
}

}  // namespace talus::dem
