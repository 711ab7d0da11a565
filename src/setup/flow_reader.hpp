#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "src/flow/grain_flow.hpp"
#include "src/flow/grain_settling.hpp"
#include "src/flow/region_statistics.hpp"
#include "src/setup/grain_law_reader.hpp"
#include "src/setup/grain_scene.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

/// The tables [[sink]] and [[source]]. A source's grains are a body of their own, appended to `bodies` with
/// its material's index in `materials`. Faults are recorded in the scene. Collective.
GrainFlowPlan read_flow(const Section& root, const BodyContext& context, GrainLawReader& laws,
                        std::vector<GrainBody>& bodies, std::vector<std::uint8_t>& materials);

/// The table [settle] of a scene of grains; none if there is none. Sources that begin before time 0 must come
/// to an end, walls must not move before it.
std::optional<GrainSettling> read_settling(const Section& root, double time_step, const GrainFlowPlan& flow,
                                           const std::vector<dem::Wall>& walls);

/// The tables [[region]]. Collective.
std::vector<WatchedRegion> read_regions(const Section& root, const BodyContext& context);

/// A region of space: a shape as of a body, or a `plane`, behind which lies the region; with
/// `outside = true` all but that. Collective.
GrainRegion read_region(const Section& table, const BodyContext& context);

}  // namespace talus
