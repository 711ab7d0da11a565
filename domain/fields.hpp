#pragma once
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace talus {

/// How many components a field has and how they change under a reflection: a vector's component along
/// the mirror's normal flips, a tensor's flips once per index along the normal. A profile holds any number of
/// scalars, which a scene chooses (ParticleSet::add).
enum class Shape : std::uint8_t { scalar, vector, symmetric_tensor, tensor, point, profile };

/// state: moves with its particle, is saved in checkpoints and hashed. work: recomputed every step.
enum class Role : std::uint8_t { state, work };

/// owner: known for a rank's own particles only. halo: also kept for copies of neighbours' particles.
enum class Reach : std::uint8_t { owner, halo };

enum class ValueType : std::uint8_t { f64, f32, u64, u32, u8 };

template <class T>
constexpr ValueType value_type_of() {
    if constexpr (std::is_same_v<T, double>) return ValueType::f64;
    if constexpr (std::is_same_v<T, float>) return ValueType::f32;
    if constexpr (std::is_same_v<T, std::uint64_t>) return ValueType::u64;
    if constexpr (std::is_same_v<T, std::uint32_t>) return ValueType::u32;
    if constexpr (std::is_same_v<T, std::uint8_t>) return ValueType::u8;
}

/// Everything the generic code (storage, migration, halo, checkpoint, snapshot, hash) knows of a field.
struct FieldInfo {
    std::string_view name;  ///< in checkpoints, snapshots and messages
    std::string_view unit;  ///< UDUNITS string, "1" if none
    ValueType type;
    Shape shape;
    Role role;
    Reach reach;
    std::string_view description;
};

/// Typed handle of a field; its address identifies it.
template <class T>
struct Field : FieldInfo {
    using value_type = T;
    constexpr Field(std::string_view name_, std::string_view unit_, Shape shape_, Role role_, Reach reach_,
                    std::string_view description_)
        : FieldInfo{name_, unit_, value_type_of<T>(), shape_, role_, reach_, description_} {}
};

/// Number of stored components in `dimension` space dimensions (1, 2, 3). Symmetric tensors are stored
/// xx | xx yy xy | xx yy zz xy xz yz; full tensors row by row. 0 for a profile.
constexpr int component_count(Shape shape, int dimension) {
    switch (shape) {
        case Shape::scalar:
            return 1;
        case Shape::vector:
        case Shape::point:
            return dimension;
        case Shape::symmetric_tensor:
            return dimension * (dimension + 1) / 2;
        case Shape::tensor:
            return dimension * dimension;
        case Shape::profile:
            return 0;
    }
    return 0;
}

/// The two space axes that component `component` of a symmetric tensor belongs to.
struct AxisPair {
    int first, second;
};
constexpr AxisPair symmetric_axes(int component, int dimension) {
    if (component < dimension) return {component, component};
    if (dimension == 2) return {0, 1};
    constexpr AxisPair off_diagonal[3] = {{0, 1}, {0, 2}, {1, 2}};
    return off_diagonal[component - 3];
}

constexpr std::size_t size_of(ValueType type) {
    switch (type) {
        case ValueType::f64:
        case ValueType::u64:
            return 8;
        case ValueType::f32:
        case ValueType::u32:
            return 4;
        case ValueType::u8:
            return 1;
    }
    return 0;
}

/// The fields. A field exists in a particle set only if a model asked for it (ParticleSet::add).
namespace field {
using enum Shape;
using enum Role;
using enum Reach;

inline constexpr Field<std::uint64_t> id{
    "id", "1", scalar, state, owner, "identity of the particle, unique in its set, never reused"};
inline constexpr Field<double> position{"position", "m", Shape::point, state, halo, "position of the centre"};
inline constexpr Field<double> velocity{"velocity", "m s-1", vector, state, owner, "velocity"};
inline constexpr Field<double> mass{"mass", "kg", scalar, state, halo, "mass"};
inline constexpr Field<double> density{"density", "kg m-3", scalar, state, owner, "mass density"};
inline constexpr Field<double> internal_energy{
    "internal_energy", "J kg-1", scalar, state, owner, "specific internal energy, elastic energy included"};
inline constexpr Field<double> smoothing_length{
    "smoothing_length", "m", scalar, state, halo, "smoothing length h of the kernel"};
inline constexpr Field<double> deviatoric_stress{
    "deviatoric_stress",
    "Pa",
    symmetric_tensor,
    state,
    owner,
    "deviatoric stress of the uncracked part; in 1D and 2D the missing diagonal makes it traceless "
    "(uniaxial, plane strain)"};
inline constexpr Field<double> damage{"damage", "1",   scalar,
                                      state,    owner, "Grady-Kipp damage D: 0 intact, 1 fully cracked"};
inline constexpr Field<std::uint8_t> body{
    "body", "1", scalar, state, halo, "index of the body in the scene, in order of appearance"};
inline constexpr Field<float> flaw_threshold{
    "flaw_threshold", "1", scalar, state, owner, "strain at which the weakest flaw of the particle opens"};
inline constexpr Field<float> flaw_exponent{
    "flaw_exponent", "1", scalar, state, owner, "exponent of the number of open flaws against strain"};
inline constexpr Field<std::uint32_t> flaw_count{"flaw_count", "1",   scalar,
                                                 state,        owner, "number of flaws of the particle"};

inline constexpr Field<double> plastic_volume_strain{
    "plastic_volume_strain", "1", scalar, state, owner, "volume strain that soil keeps when unloaded"};
inline constexpr Field<double> plastic_shear_strain{
    "plastic_shear_strain", "1", scalar, state, owner, "accumulated plastic shear strain of soil"};

inline constexpr Field<double> acceleration{"acceleration", "m s-2", vector,
                                            state,          owner,   "acceleration at the last evaluation"};
inline constexpr Field<double> specific_power{
    "specific_power",
    "W kg-1",
    scalar,
    state,
    owner,
    "work of the pair forces on the particle per mass and time, kinetic and internal together"};
inline constexpr Field<double> gravity_acceleration{
    "gravity_acceleration", "m s-2", vector, state, owner, "acceleration of gravity at the last evaluation"};
inline constexpr Field<double> gravity_potential{
    "gravity_potential", "J kg-1", scalar, work, owner, "potential of the other particles' gravity"};
inline constexpr Field<double> viscous_speed{
    "viscous_speed",
    "m s-1",
    scalar,
    work,
    owner,
    "greatest sensitivity of the artificial viscosity to the velocity difference over all partners"};
inline constexpr Field<double> velocity_gradient{
    "velocity_gradient",
    "s-1",
    tensor,
    state,
    halo,
    "corrected velocity gradient dv_a/dx_b at the last evaluation"};

inline constexpr Field<double> next_smoothing_length{
    "next_smoothing_length", "m", scalar, work, owner, "smoothing length for the next step"};
inline constexpr Field<double> predicted_velocity{
    "predicted_velocity", "m s-1", vector, work, halo, "velocity predicted to the time of evaluation"};
inline constexpr Field<double> predicted_energy{
    "predicted_energy",
    "J kg-1",
    scalar,
    work,
    owner,
    "specific internal energy predicted to the time of evaluation"};
inline constexpr Field<double> predicted_density{
    "predicted_density", "kg m-3", scalar, work, halo, "density predicted to the time of evaluation"};
inline constexpr Field<double> pressure{
    "pressure", "Pa", scalar, work, halo, "pressure at the time of evaluation, reduced by damage in tension"};
inline constexpr Field<double> sound_speed{
    "sound_speed", "m s-1", scalar, work, halo, "bulk sound speed at the time of evaluation"};
inline constexpr Field<double> predicted_stress{
    "predicted_stress",
    "Pa",
    symmetric_tensor,
    work,
    halo,
    "deviatoric stress predicted to the time of evaluation, within the strength, reduced by damage"};
inline constexpr Field<double> pressure_gradient{"pressure_gradient",       "Pa m-1", vector, work, halo,
                                                 "gradient of the pressure"};
inline constexpr Field<double> volume_gradient{
    "volume_gradient", "m2 kg-1", vector, work, halo, "gradient of the specific volume, raw kernel sum"};
inline constexpr Field<double> volume_curvature{
    "volume_curvature", "m kg-1", symmetric_tensor, work, halo, "second derivatives of the specific volume"};
inline constexpr Field<double> radius{"radius", "m", scalar, state, halo, "radius of the grain"};
inline constexpr Field<double> angular_velocity{"angular_velocity", "rad s-1", vector, state, owner,
                                                "angular velocity"};
inline constexpr Field<double> moment_of_inertia{
    "moment_of_inertia", "kg m2", scalar, state, owner, "of the grain about its centre, as an even sphere"};
inline constexpr Field<std::uint64_t> particle_count{
    "particle_count", "1", scalar, state, owner, "number of particles that the grain was made of"};
inline constexpr Field<std::uint64_t> fragment{
    "fragment", "1", scalar, work, halo, "smallest id of the particles that hold together with this one"};
inline constexpr Field<std::uint8_t> remnant{
    "remnant", "1", scalar, work, owner, "which remnant binds the particle: 1 is the largest, 0 none"};
}  // namespace field

}  // namespace talus
