#pragma once
#include <cstdint>
#include <initializer_list>

#include "comm/communicator.hpp"
#include "comm/halo.hpp"
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "physics/sph/motion.hpp"
#include "src/phases.hpp"

namespace talus {

/// Refreshes fields of the copies while a pass visits the cells that need none, then lets it visit the
/// others.
template <class Pass>
void overlapped(Phases& phases, Phase phase, Halo& halo, ParticleSet& particles,
                std::initializer_list<const FieldInfo*> fields, Pass&& pass) {
    phases.enter(Phase::halo);
    halo.begin(particles, fields);
    phases.enter(phase);
    pass(Cells::interior);
    phases.enter(Phase::halo);
    halo.finish();
    phases.enter(phase);
    pass(Cells::boundary);
}

/// Where a run stands.
struct StepMoment {
    double time;         ///< [s]
    std::uint64_t step;  ///< done
};

/// The next time step that all ranks agree on, `limit` being this rank's, and that the state is finite: one
/// reduction for both. Throws AgreedError (exit code 1) naming a particle if it is not, or if time would
/// stand still. Collective.
double agreed_time_step(const Communicator& comm, const ParticleSet& particles, const StepMoment& now,
                        const sph::StepLimit& limit);

}  // namespace talus
