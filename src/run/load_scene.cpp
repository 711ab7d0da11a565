#include "io/scene.hpp"
#include "src/run/commands.hpp"
#include "src/setup/material_reader.hpp"

namespace talus {

Scene load_scene(const Communicator& comm, const RunOptions& options) {
    // Only the root looks at the file system, so that ranks cannot disagree about it.
    std::string file, fault;
    if (comm.is_root()) {
        try {
            file = Scene::file_of(options.scene).string();
        } catch (const SceneError& error) {
            fault = error.what();
        }
    }
    fault = comm.all_broadcast(fault);
    if (!fault.empty()) throw SceneError(fault);
    file = comm.all_broadcast(file);
    return Scene::parse(read_shared_text(comm, file), file, options.quick, options.overrides);
}

std::filesystem::path output_folder(const Scene& scene, const RunOptions& options) {
    if (!options.out.empty()) {
        const std::filesystem::path out = options.out.lexically_normal();
        return out.has_filename() ? out : out.parent_path();  // without the separator at its end
    }
    const std::filesystem::path file = std::filesystem::absolute(scene.file());
    const bool in_folder = file.filename() == "scene.toml";
    return std::filesystem::path("out") / (in_folder ? file.parent_path().filename() : file.stem());
}

}  // namespace talus
