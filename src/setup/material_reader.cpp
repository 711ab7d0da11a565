#include "src/setup/material_reader.hpp"

#include <fmt/format.h>

#include "src/setup/plasticity_reader.hpp"

namespace talus {

std::string read_shared_text(const Communicator& comm, const std::filesystem::path& file) {
    std::string text, fault;
    if (comm.is_root()) {
        try {
            text = Scene::read_text(file);
        } catch (const SceneError& error) {
            fault = error.what();
        }
    }
    fault = comm.all_broadcast(fault);
    if (!fault.empty()) throw SceneError(fault);
    return comm.all_broadcast(text);
}

namespace {

constexpr Range positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range not_negative{0};
constexpr double never_melts = std::numeric_limits<double>::infinity();

EquationOfState read_equation_of_state(const Section& table, double density) {
    const std::string kind = table.choice("kind", {"tillotson", "ideal_gas", "linear", "stiffened_gas"});
    if (kind == "ideal_gas")
        return IdealGas{.gamma = table.number("gamma", "1", {}, {1, 100, true}),
                        .reference_density = density};
    if (kind == "linear")
        return LinearEquationOfState{.reference_density = density,
                                     .sound_speed = table.number("sound_speed", "m/s", {}, positive)};
    if (kind == "stiffened_gas")
        return StiffenedGas{.gamma = table.number("gamma", "1", {}, {1, 100, true}),
                            .reference_density = density,
                            .sound_speed = table.number("sound_speed", "m/s", {}, positive)};
    return Tillotson{.reference_density = density,
                     .a = table.number("a", "1", {}, not_negative),
                     .b = table.number("b", "1", {}, not_negative),
                     .A = table.number("A", "Pa", {}, positive),
                     .B = table.number("B", "Pa", {}, not_negative),
                     .E0 = table.number("E0", "J/kg", {}, positive),
                     .E_iv = table.number("E_iv", "J/kg", {}, positive),
                     .E_cv = table.number("E_cv", "J/kg", {}, positive),
                     .alpha = table.number("alpha", "1", {}, not_negative),
                     .beta = table.number("beta", "1", {}, not_negative),
                     .cold_cut_ratio = table.number("cold_cut_ratio", "1", 0.0, {0, 1})};
}

double read_melt_energy(const Section& table) {
    return table.has("melt_energy") ? table.number("melt_energy", "J/kg", {}, positive) : never_melts;
}

Strength read_strength(const Section& table, const std::string& kind) {
    if (kind == "von_mises")
        return VonMises{.yield_stress = table.number("yield_stress", "Pa", {}, not_negative),
                        .melt_energy = read_melt_energy(table)};
    if (kind == "lundborg") {
        const double cohesion = table.number("cohesion", "Pa", {}, not_negative);
        const double limit = table.number("limit", "Pa", {}, not_negative);
        if (limit < cohesion) table.error("limit", "is below the cohesion, which it limits");
        return Lundborg{.cohesion = cohesion,
                        .limit = limit,
                        .friction_intact = table.number("friction_intact", "1", {}, not_negative),
                        .friction_damaged = table.number("friction_damaged", "1", {}, not_negative),
                        .melt_energy = read_melt_energy(table)};
    }
    return NoStrengthLimit{};
}

/// Equation of state and shear modulus, or Young's modulus and Poisson's ratio of a linear solid.
void read_elasticity(const Section& table, Material& material) {
    const double density = material.reference_density;
    if (!table.has("youngs_modulus")) {
        material.eos = read_equation_of_state(table.section("equation_of_state"), density);
        material.shear_modulus = table.number("shear_modulus", "Pa", 0.0, not_negative);
        return;
    }
    for (const char* key : {"equation_of_state", "shear_modulus"})
        if (table.has(key)) table.error(key, "follows from youngs_modulus and poisson_ratio: leave it out");
    const double E = table.number("youngs_modulus", "Pa", {}, positive);
    const double nu = table.number("poisson_ratio", "1", {}, {0, 0.499});
    material.eos = LinearEquationOfState{.reference_density = density,
                                         .sound_speed = std::sqrt(E / (3 * (1 - 2 * nu)) / density)};
    material.shear_modulus = E / (2 * (1 + nu));
}

void read_strength_or_plasticity(const Section& table, int dimension, Material& material) {
    const Section strength = table.section("strength");
    if (!strength.exists()) return;
    const std::string kind =
        strength.choice("kind", {"none", "von_mises", "lundborg", "drucker_prager", "mu_i"}, "none");
    if (!is_plasticity(kind)) {
        material.strength = read_strength(strength, kind);
        return;
    }
    material.plasticity = read_plasticity(strength, kind, dimension);
    if (!std::holds_alternative<LinearEquationOfState>(material.eos))
        table.error("strength",
                    "soil needs a linear equation of state: give youngs_modulus and poisson_ratio");
    for (const char* key : {"least_pressure", "fracture"})
        if (table.has(key)) table.error(key, "does not go with soil, which has a tensile_strength");
}

}  // namespace

Material read_material(const Section& table, const std::string& name, int dimension) {
    Material material;
    material.name = name;
    material.reference_density = table.number("density", "kg/m3", {}, positive);
    read_elasticity(table, material);
    material.bulk_modulus = bulk_modulus(material.eos);
    if (table.has("least_pressure"))
        material.least_pressure =
            table.number("least_pressure", "Pa", {}, {-std::numeric_limits<double>::infinity(), 0});
    read_strength_or_plasticity(table, dimension, material);
    const bool limited = !std::holds_alternative<NoStrengthLimit>(material.strength) || material.plasticity;
    if (limited && material.shear_modulus == 0)
        table.error("strength", "needs a shear_modulus: only a solid bears shear");
    const Section fracture = table.section("fracture");
    if (fracture.exists()) {
        material.fracture =
            Fracture{.weibull_k = fracture.number("weibull_k", "m-3", {}, positive),
                     .weibull_m = fracture.number("weibull_m", "1", {}, positive),
                     .crack_speed_fraction = fracture.number("crack_speed_fraction", "1", 0.4, {0, 1, true}),
                     .crack_count_power = fracture.number("crack_count_power", "1", 1.0 / 3, {0, 1})};
        if (material.shear_modulus == 0)
            table.error("fracture", "needs a shear_modulus: only a solid can crack");
    }
    return material;
}

Material find_material(const Communicator& comm, const Scene& scene, const Section& body, int dimension) {
    const std::string name = body.text("material");
    if (name.empty()) return {};
    const Section own = scene.root().section("materials").section(name);
    if (own.exists()) return read_material(own, name, dimension);

    std::filesystem::path folder = std::filesystem::absolute(scene.file()).parent_path(), file;
    int found = 0;
    if (comm.is_root())
        for (;; folder = folder.parent_path()) {
            file = folder / "materials" / (name + ".toml");
            std::error_code unreadable;
            found = std::filesystem::exists(file, unreadable);
            if (found || folder == folder.root_path()) break;
        }
    file = comm.all_broadcast(file.string());
    if (!comm.all_max(found)) {
        body.error("material", fmt::format("there is neither a table [materials.{0}] in the scene nor a file "
                                           "materials/{0}.toml in its folder or above",
                                           name));
        return {};
    }
    const Scene material_file = Scene::parse(read_shared_text(comm, file), file);
    const Material material = read_material(material_file.root(), name, dimension);
    material_file.finish();
    return material;
}

}  // namespace talus
