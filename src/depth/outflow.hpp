#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "comm/communicator.hpp"
#include "comm/decomposition.hpp"
#include "domain/particles.hpp"
#include "domain/terrain.hpp"

namespace talus {

/// Takes out the particles that have left the terrain, and keeps the ledger of them.
class Outflow {
  public:
    explicit Outflow(const Communicator& comm) : comm_(comm) {}

    /// Removes own particles whose place the terrain does not reach. Throws AgreedError (exit code 1) naming
    /// a particle and the cell if one is over a hole of it. Collective.
    Decomposition::Ledger take(ParticleSet& particles, const Terrain& terrain, double time);

    std::uint64_t count() const { return count_; }
    double volume() const { return volume_; }  ///< [m3]

    /// The first outflow, told once: when, how much and where.
    std::string take_note();

    /// What a checkpoint must know.
    void save(std::map<std::string, double>& numbers) const;
    void restore(const std::map<std::string, double>& numbers);

  private:
    const Communicator& comm_;
    std::uint64_t count_ = 0;
    double volume_ = 0;
    std::string note_;
};

}  // namespace talus
