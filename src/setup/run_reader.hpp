#pragma once
#include "domain/box.hpp"
#include "domain/partition.hpp"
#include "io/scene.hpp"
#include "src/setup/scene_setup.hpp"

namespace talus {

// What scenes of every model say in the same words. Faults are recorded in the scene.

/// The table [box].
Box read_box(const Section& table, int dimension);

/// The tables [[reference]], that tools/report compares a run with: the program only checks them.
void read_references(const Section& root);

/// The tables [run], [output] and [[reference]]: when a run ends and what it writes.
OutputPlan read_output(const Section& root);

/// Of the table [run].
PartitionMethod read_partition(const Section& run);
int read_rebalance_interval(const Section& run);

}  // namespace talus
