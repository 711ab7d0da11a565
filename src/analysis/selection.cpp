#include "src/analysis/selection.hpp"

#include <cstring>

namespace talus {

namespace {

void copy_rows(const Column& from, std::span<const std::uint32_t> chosen, Column& to) {
    const std::size_t bytes = from.value_size();
    for (std::size_t c = 0; c < from.components.size(); ++c)
        for (std::size_t k = 0; k < chosen.size(); ++k)
            std::memcpy(to.components[c].data() + k * bytes, from.components[c].data() + chosen[k] * bytes,
                        bytes);
}

}  // namespace

ParticleSet selected(const std::string& name, const ParticleSet& from, std::span<const std::uint32_t> chosen,
                     std::span<const FieldInfo* const> fields) {
    ParticleSet set(name, from.dimension());
    for (const FieldInfo* info : fields)
        if (from.has(*info)) set.add(*info);
    set.resize(chosen.size());
    for (Column& column : set.columns()) copy_rows(from.column(*column.info), chosen, column);
    return set;
}

}  // namespace talus
