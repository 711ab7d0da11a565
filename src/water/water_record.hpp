#pragma once
#include <string>
#include <vector>

#include "io/csv.hpp"
#include "src/water/gauges.hpp"

namespace talus {

/// What the diagnostics say beyond totals: what came and went, forces on walls and gauges, as far as a scene
/// names them.
class WaterRecord {
  public:
    /// `names`: of the bodies.
    WaterRecord(const WaterSetup& setup, const std::vector<std::string>& names,
                std::vector<WaterGauge> gauges);

    std::vector<CsvColumn> columns() const;
    /// Appends their values. Collective.
    void measure(WaterSimulation& simulation, std::vector<double>& row) const;

  private:
    std::string axes_, turns_;           ///< along which vectors, and about which torques are written
    bool has_level_;                     ///< there is a gravity that water bears
    std::vector<std::string> recorded_;  ///< walls
    OpenPlan open_;
    std::vector<WaterGauge> gauges_;
};

}  // namespace talus
