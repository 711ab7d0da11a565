#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "domain/particles.hpp"

namespace talus {

/// A set of its own of the chosen own particles: id, position and those of `fields` that `from` has.
ParticleSet selected(const std::string& name, const ParticleSet& from, std::span<const std::uint32_t> chosen,
                     std::span<const FieldInfo* const> fields);

}  // namespace talus
