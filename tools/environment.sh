# shellcheck shell=bash
# Sourced by the other tools: goes to the top folder and sets what Open MPI and the build need.
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
processors=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc)  # else nproc says what OpenMP may use
export OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}"
if [ "$(id -u)" -eq 0 ]; then  # mpirun refuses root unless told twice
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

# Configures the preset $1 and builds the targets that follow (all of them if none follows).
build() {
    local preset=$1
    shift
    cmake --preset "$preset"
    cmake --build --preset "$preset" ${1:+--target "$@"}
}
