#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/scene.hpp"
#include "physics/dem/law_table.hpp"
#include "physics/dem/laws/materials.hpp"

namespace talus {

struct GrainBody;

/// Time steps for grains under a law.
struct GrainTimeStep {
    double greatest;     ///< that is stable [s]
    double usual;        ///< where none is asked for [s]
    std::string reason;  ///< of the greatest
    /// Above which the densest packing of damped grains shakes; looser ones bear more [s].
    double packed = std::numeric_limits<double>::infinity();
};

/// Reads the law of [dem], the materials that grains and walls name and the pairs of [[contact]]. Faults are
/// recorded in the scene.
class GrainLawReader {
  public:
    explicit GrainLawReader(const Section& root);

    /// Index of the material that a table's key `material` names, from [materials.NAME].
    std::uint8_t material(const Section& table);
    const std::vector<dem::GrainMaterial>& materials() const { return materials_; }
    /// Once all materials are known.
    void read_pairs();
    GrainTimeStep time_step(const std::vector<GrainBody>& bodies) const;
    /// Of a scene without faults.
    dem::AnyLawTable table() const;

  private:
    enum class Elasticity : std::uint8_t { hertz, linear, johnson_kendall_roberts };
    enum class Rolling : std::uint8_t { free, constant_torque, elastic_plastic };
    enum class SurfaceForce : std::uint8_t { none, pull_off, lubrication };

    void read_adhesion();
    void read_film();
    Range restitutions() const;
    dem::GrainMaterial read_material(const Section& table, const std::string& name) const;
    std::optional<double> work_of_adhesion(const Section& table) const;
    GrainTimeStep time_step_of(const GrainBody& body) const;
    struct Parts;
    template <class Law>
    bool is_chosen() const;
    template <std::size_t first>
    dem::AnyLawTable table_from() const;

    Section root_, dem_;
    Elasticity elasticity_ = Elasticity::hertz;
    Rolling rolling_ = Rolling::free;
    SurfaceForce surface_force_ = SurfaceForce::none;
    bool twists_freely_ = true, van_der_waals_ = false;
    dem::EndOfContact end_;
    double stiffness_ = 0, stiffness_ratio_ = 0;  ///< of the linear law
    dem::PullOff<double> pull_{0, 1, 0};          ///< but for the force, which belongs to pairs
    dem::Lubrication<double> film_{};
    std::vector<dem::GrainMaterial> materials_;
    std::optional<dem::MaterialPairs> pairs_;
};

}  // namespace talus
