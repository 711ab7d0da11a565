#pragma once
#include <mpi.h>

#include <cstdlib>

namespace talus::test {

/// Starts MPI for a fuzzer, which is one process and leaves by exit().
inline int start_alone(int* count, char*** values) {
    MPI_Init(count, values);
    return std::atexit([] { MPI_Finalize(); });
}

}  // namespace talus::test
