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

}  // namespace talus
