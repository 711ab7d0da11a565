#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "comm/communicator.hpp"
#include "src/simulation.hpp"

namespace talus::test {

/// sum |error(k)| V_k / sum V_k over the particles k with low < x < high.
double mean_error(const std::vector<double>& x, const std::vector<double>& volume,
                  const std::function<double(std::size_t)>& error, double low, double high);

/// All particles of a gas in order of id, on every rank, and what became of the energy.
struct GasResult {
    double time;                 ///< [s]
    double energy_drift;         ///< greatest change of the total energy, relative to its start [1]
    double least_energy;         ///< least internal energy met at the end of any step [J/kg]
    std::uint64_t steps;         ///< taken
    std::vector<double> x;       ///< first coordinate [m]
    std::vector<double> v;       ///< velocity along it [m/s]
    std::vector<double> across;  ///< speed in the other directions [m/s]
    std::vector<double> density, pressure, volume;

    /// sum |error(k)| V_k / sum V_k over the particles with low < x < high: the L1 error of a quantity.
    double mean_error(const std::function<double(std::size_t)>& error, double low, double high) const;
};

/// Runs a scene to its end as the program does, without writing files. Collective.
GasResult run_gas(const Communicator& comm, const std::filesystem::path& scene,
                  const std::vector<std::string>& overrides);

/// Order of convergence between two errors at resolutions that differ by a factor of two.
double order_of(double coarse, double fine);

}  // namespace talus::test
