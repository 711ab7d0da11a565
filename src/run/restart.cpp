#include "src/run/restart.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "io/agree.hpp"
#include "io/checkpoint.hpp"

namespace talus {

namespace {

std::string listed(const std::vector<std::string>& materials) {
    return fmt::format("{} ({})",
                       materials.size() == 1 ? "1 body" : fmt::format("{} bodies", materials.size()),
                       fmt::join(materials, ", "));
}

/// Throws std::runtime_error if particles of the checkpoint do not belong to the bodies of the scene.
void check_bodies(const Restart& restart, const SceneSetup& setup) {
    std::vector<std::string> wanted;
    for (const Material& material : setup.simulation.materials) wanted.push_back(material.name);
    const std::vector<std::string>& stored = restart.state.materials;
    if (!stored.empty() && stored != wanted)
        throw std::runtime_error(fmt::format("{}: is of a scene of {}, this one has {}",
                                             restart.file.string(), listed(stored), listed(wanted)));
    for (const std::uint8_t body : restart.particles.own(field::body))
        if (body >= wanted.size())
            throw std::runtime_error(fmt::format("{}: holds particles of body {}, the scene has {}",
                                                 restart.file.string(), body, listed(wanted)));
}

/// Throws std::runtime_error if the particles were softened by another stiffness than the scene's.
void check_late_phase(const Restart& restart, const SceneSetup& setup) {
    const auto stored = restart.state.numbers.find("late_phase");
    if (stored == restart.state.numbers.end()) return;
    const std::optional<LatePhase>& wanted = setup.simulation.late_phase;
    if (!wanted || wanted->stiffness != stored->second)
        throw std::runtime_error(fmt::format(
            "{}: is of the late phase of a scene with late_phase.stiffness = {}, this one has {}",
            restart.file.string(), stored->second, wanted ? fmt::to_string(wanted->stiffness) : "none"));
}

}  // namespace

Restart read_restart(const Communicator& comm, const std::filesystem::path& what,
                     const std::filesystem::path& output_folder, const SceneSetup& setup) {
    const auto began = std::chrono::steady_clock::now();
    Restart restart{find_checkpoint(comm, what, output_folder), {}, empty_particles(setup)};
    restart.state = read_checkpoint(comm, restart.file, {&restart.particles});
    agree_on(comm, [&] {
        check_bodies(restart, setup);
        check_late_phase(restart, setup);
    });
    restart.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    return restart;
}

}  // namespace talus
