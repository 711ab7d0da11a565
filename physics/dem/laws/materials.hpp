#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "physics/dem/laws/contact_law.hpp"
#include "physics/dem/laws/damping.hpp"
#include "physics/dem/laws/pair_table.hpp"

namespace talus::dem {

/// What a surface brings into a contact. What no law of the run asks for stays at its default.
struct GrainMaterial {
    std::string name;
    double density = 0;            ///< [kg/m3]; not needed of walls
    double youngs_modulus = 0;     ///< E [Pa]
    double poisson_ratio = 0;      ///< nu [1], within (-1, 0.5]
    double restitution = 1;        ///< e [1], within [0, 1]
    double friction = 0;           ///< mu [1]
    double rolling_friction = 0;   ///< mu_r [1]
    double rolling_damping = 0;    ///< eta of ElasticPlasticRolling [1]
    double twisting_friction = 0;  ///< mu of ContactAreaTwisting [1]
    double work_of_adhesion = 0;   ///< w [J/m2]
};

/// The properties that belong to a pair.
struct PairProperties {
    double effective_modulus;                                                            ///< E* [Pa]
    double effective_shear_modulus;                                                      ///< G* [Pa]
    double restitution, friction, rolling_friction, rolling_damping, twisting_friction;  ///< [1]
    double work_of_adhesion;                                                             ///< [J/m2]
};

/// What a scene states of a pair itself.
struct PairOverride {
    std::optional<double> restitution, friction, rolling_friction, rolling_damping, twisting_friction,
        work_of_adhesion;
};

/// Properties of all pairs of materials: stated ones, else mixed from both. E* and G* follow from elasticity;
/// of the others the geometric mean is taken, so that a surface without friction has none on any other.
class MaterialPairs {
  public:
    explicit MaterialPairs(std::vector<GrainMaterial> materials) : materials_(std::move(materials)) {}

    /// States properties of the pair of materials `a` and `b`, in either order.
    void state(std::size_t a, std::size_t b, const PairOverride& stated);

    PairProperties operator()(std::size_t a, std::size_t b) const;
    std::size_t count() const { return materials_.size(); }
    const std::vector<GrainMaterial>& materials() const { return materials_; }

  private:
    std::vector<GrainMaterial> materials_;
    std::map<std::pair<std::size_t, std::size_t>, PairOverride> stated_;
};

/// E / (2 (1 + nu)) [Pa].
double shear_modulus(const GrainMaterial& material);

/// The coefficients of a pair. Tangential damping has the normal one's share of critical damping:
/// gamma_t/gamma_n = sqrt(k_t/k_n) of the tangent stiffnesses.
HertzMindlin<double> hertz_mindlin(const PairProperties& pair, EndOfContact end);
JohnsonKendallRoberts<double> johnson_kendall_roberts(const PairProperties& pair);
/// `stiffness` k_n [N/m], k_t = `ratio` k_n.
LinearSpring<double> linear_spring(const PairProperties& pair, double stiffness, double ratio,
                                   EndOfContact end);

}  // namespace talus::dem
