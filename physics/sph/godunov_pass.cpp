#include "physics/sph/godunov_pass.hpp"

namespace talus::sph {

void godunov_pass(ParticleSet& particles, const CellTable& table, Cells which, const Settings& settings,
                  PassCount& count) {
    with_dimension(particles,
                   [&](auto dimension) { run_godunov<dimension>(particles, table, which, settings, count); });
}

}  // namespace talus::sph
