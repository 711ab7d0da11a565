#pragma once
#include <ctime>

namespace talus {

/// Processor time of this thread [s], which other programs on the machine disturb less than wall time.
inline double processor_time() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace talus
