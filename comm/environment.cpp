#include "comm/environment.hpp"

#include <mpi.h>

#include <cstdio>
#include <cstdlib>

namespace talus {

Environment::Environment(int& argc, char**& argv) { MPI_Init(&argc, &argv); }

Environment::~Environment() { MPI_Finalize(); }

void Environment::leave(int exit_code) {
    std::fflush(nullptr);
    std::_Exit(exit_code);
}

void Environment::abort(int exit_code) {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::exit(exit_code);
}

}  // namespace talus
