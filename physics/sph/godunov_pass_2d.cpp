#include "physics/sph/godunov_pass.ipp"

namespace talus::sph {
template void run_godunov<2>(ParticleSet&, const CellTable&, Cells, const Settings&, PassCount&);
}  // namespace talus::sph
