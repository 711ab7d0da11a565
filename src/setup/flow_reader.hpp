#pragma once
#include <cstdint>
#include <vector>

#include "src/flow/grain_flow.hpp"
#include "src/setup/grain_law_reader.hpp"
#include "src/setup/grain_scene.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

/// The tables [[sink]] and [[source]]. A source's grains are a body of their own, appended to `bodies` with
/// its material's index in `materials`. Faults are recorded in the scene. Collective.
GrainFlowPlan read_flow(const Section& root, const BodyContext& context, GrainLawReader& laws,
                        std::vector<GrainBody>& bodies, std::vector<std::uint8_t>& materials);

/// A region of space: a shape as of a body, or a `plane`, behind which lies the region; with
/// `outside = true` all but that. Collective.
GrainRegion read_region(const Section& table, const BodyContext& context);

}  // namespace talus
