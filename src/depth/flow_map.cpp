#include "src/depth/flow_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comm/exact_sum.hpp"
#include "domain/depth_fields.hpp"
#include "io/agree.hpp"
#include "io/raster.hpp"
#include "physics/depth/kernel.hpp"
#include "physics/depth/motion.hpp"

namespace talus {

namespace {

/// The columns of a rank as the map sees them.
class Columns {
  public:
    explicit Columns(const DepthSimulation& simulation)
        : simulation_(simulation), particles_(simulation.particles()) {
        fitted_ = simulation.setup().settings.form == depth::Form::bed_fitted;
        eta_ = simulation.setup().settings.eta;
        volume_ = particles_.data(field::volume);
        for (int a = 0; a < 2; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            x_[axis] = particles_.data(field::position, a);
            v_[axis] = particles_.data(field::velocity, a);
            if (fitted_) slope_[axis] = particles_.data(field::bed_slope, a);
        }
    }

    std::size_t size() const { return particles_.size(); }
    std::array<double, 2> place(std::size_t i) const { return {x_[0][i], x_[1][i]}; }
    double vertical_depth(std::size_t i) const { return simulation_.whole_depth(i) / cosine(i); }
    /// In plan: of a square whose side is the distance of columns.
    double area(std::size_t i) const {
        const double side = smoothing_length(i) / eta_;
        return side * side;
    }
    double volume(std::size_t i) const { return volume_[i]; }
    double smoothing_length(std::size_t i) const { return particles_.data(field::smoothing_length)[i]; }
    MapColumn column(std::size_t i) const {
        const double rise = fitted_ ? slope_[0][i] * v_[0][i] + slope_[1][i] * v_[1][i] : 0;
        return {place(i), area(i), simulation_.whole_depth(i),
                std::sqrt(v_[0][i] * v_[0][i] + v_[1][i] * v_[1][i] + rise * rise)};
    }

  private:
    double cosine(std::size_t i) const {
        return fitted_ ? depth::Tilt(std::array<double, 2>{slope_[0][i], slope_[1][i]}).cosine : 1;
    }

    const DepthSimulation& simulation_;
    const ParticleSet& particles_;
    bool fitted_;
    double eta_;
    const double* volume_;
    std::array<const double*, 2> x_{}, v_{}, slope_{};
};

}  // namespace

void add_columns(FlowRecord& record, const DepthSimulation& simulation) {
    const Columns columns(simulation);
    for (std::size_t i = 0; i < columns.size(); ++i) record.add(columns.column(i), simulation.time());
}

std::string write_results(const DepthSimulation& simulation, const FlowRecord& record,
                          const ResultsPlan& plan, const std::filesystem::path& folder) {
    const Communicator& comm = simulation.comm();
    const std::filesystem::path results = folder / "results";
    agree_on_root(comm, [&] { std::filesystem::create_directories(results); });
    const auto write = [&](const char* name, TerrainGrid grid) {
        write_raster(comm, results / fmt::format("{}.{}", name, plan.is_geotiff ? "tif" : "asc"),
                     {std::move(grid), plan.reference});
    };
    const TerrainGrid& frame = record.frame();
    TerrainGrid ground = frame;
    for (std::size_t row = 0; row < frame.rows; ++row)
        for (std::size_t column = 0; column < frame.columns; ++column)
            ground.elevations.push_back(simulation.setup().terrain->elevation(
                frame.origin[0] + frame.spacing[0] * static_cast<double>(column),
                frame.origin[1] + frame.spacing[1] * static_cast<double>(row)));
    write("ground", std::move(ground));
    write("greatest_depth", record.depths());
    TerrainGrid speeds = record.speeds();
    write("greatest_speed", speeds);
    for (double& value : speeds.elevations) value *= value * simulation.setup().settings.density;
    write("greatest_pressure", std::move(speeds));
    write("arrival_time", record.arrivals());

    const Columns columns(simulation);
    std::vector<SpreadColumn> spread;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const MapColumn column = columns.column(i);
        const double normal_to_vertical = column.depth / columns.vertical_depth(i);
        spread.push_back({column.place, columns.volume(i) * normal_to_vertical, columns.smoothing_length(i)});
    }
    write("last_depth", spread_depths(comm, record.frame(), spread));
    return fmt::format(
        "rasters of the greatest depth, speed and pressure, the arrival and the last depth in {}",
        results.string());
}

std::vector<GaugeReading> read_gauges(const DepthSimulation& simulation, const std::vector<Gauge>& gauges) {
    constexpr double least_cover = 0.1;
    const Columns columns(simulation);
    const Terrain& terrain = *simulation.setup().terrain;
    const depth::Kernel<2> kernel;
    constexpr std::size_t kinds = 3;  // cover, weights, weighted levels
    std::vector<ExactSum> sums(kinds * gauges.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::array<double, 2> place = columns.place(i);
        const double s = columns.smoothing_length(i), range = depth::Settings::support() * s;
        for (std::size_t k = 0; k < gauges.size(); ++k) {
            const double x = place[0] - gauges[k].place[0], y = place[1] - gauges[k].place[1];
            const double distance2 = x * x + y * y;
            if (distance2 >= range * range) continue;
            const double value = kernel.value(distance2, 1 / s), weight = columns.volume(i) * value;
            sums[kinds * k].add(columns.area(i) * value);
            sums[kinds * k + 1].add(weight);
            sums[kinds * k + 2].add(weight *
                                    (terrain.elevation(place[0], place[1]) + columns.vertical_depth(i)));
        }
    }
    ExactSum::all_reduce(simulation.comm(), sums);
    std::vector<GaugeReading> readings;
    for (std::size_t k = 0; k < gauges.size(); ++k) {
        const double ground = terrain.elevation(gauges[k].place[0], gauges[k].place[1]);
        const bool is_wet = sums[kinds * k].value() > least_cover;
        const double level = is_wet ? sums[kinds * k + 2].value() / sums[kinds * k + 1].value() : ground;
        readings.push_back({std::max(level - ground, 0.0), std::max(level, ground)});
    }
    return readings;
}

}  // namespace talus
