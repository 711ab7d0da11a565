#include "io/scene.hpp"

#include <mpi.h>

#include <cstdint>
#include <string>

#include "io/agree.hpp"
#include "src/run/families.hpp"
#include "tests/fuzz/alone.hpp"

/// Any text is a scene that is understood or one that is refused; nothing else may come of reading it.

extern "C" int LLVMFuzzerInitialize(int* count, char*** values) {
    return talus::test::start_alone(count, values);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace talus;
    static const Communicator alone(MPI_COMM_SELF);
    std::string text(reinterpret_cast<const char*>(data), size);
    for (std::size_t glass; (glass = text.find("\"glass\"")) != std::string::npos;)
        text.replace(glass, 7, "\"cubic\"");  // a glass takes seconds to relax
    try {
        const Scene scene = Scene::parse(text, "scene.toml");
        read_evolution(alone, scene, {});
    } catch (const SceneError&) {
    } catch (const AgreedError&) {
    }
    return 0;
}
