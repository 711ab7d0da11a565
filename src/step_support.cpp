#include "src/step_support.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

namespace talus {

double agreed_time_step(const Communicator& comm, const ParticleSet& particles, const StepMoment& now,
                        const sph::StepLimit& limit) {
    const NotFinite found = find_not_finite(particles);
    std::array<double, 2> least = {found.field ? 0.0 : 1.0, limit.time_step};
    comm.all_min(std::span<double>(least));
    std::string message;
    if (least[0] == 0) {
        if (found.field)
            message = fmt::format("step {}, time {} s: {} of particle {} in set '{}' is not finite", now.step,
                                  now.time, found.field->name, found.id, particles.name());
        comm.all_agree(1, message);
    }
    if (now.time + least[1] > now.time) return least[1];
    if (limit.time_step == least[1])  // the time would stand still for ever
        message =
            fmt::format("step {}, time {} s: the time step has fallen to {} s, limited by {} at particle {}",
                        now.step, now.time, least[1], limit.reason, limit.id);
    comm.all_agree(1, message);
    return least[1];
}

}  // namespace talus
