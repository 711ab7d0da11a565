#include "src/setup/handed_grains.hpp"

#include <fmt/format.h>

#include <cstring>

#include "comm/exact_sum.hpp"
#include "domain/fields.hpp"
#include "io/checkpoint.hpp"
#include "src/analysis/selection.hpp"
#include "src/setup/point.hpp"
#include "src/setup/shape_reader.hpp"

namespace talus {

namespace {

constexpr std::array<const FieldInfo*, 5> kept_fields = {&field::velocity, &field::mass, &field::radius,
                                                         &field::angular_velocity, &field::body};

Point place_of(const ParticleSet& grains, std::size_t i) {
    return {grains.data(field::position, 0)[i], grains.data(field::position, 1)[i],
            grains.data(field::position, 2)[i]};
}

/// Throws std::runtime_error if a grain is none.
void check_grains(const std::filesystem::path& file, const ParticleSet& grains) {
    for (std::size_t i = 0; i < grains.size(); ++i)
        if (!(grains.data(field::mass)[i] > 0) || !(grains.data(field::radius)[i] > 0))
            throw std::runtime_error(fmt::format(
                "{}: grain {} has mass {} kg and radius {} m; allowed: above 0", file.string(),
                grains.data(field::id)[i], grains.data(field::mass)[i], grains.data(field::radius)[i]));
}

}  // namespace

std::optional<std::filesystem::path> file_of_grains(const Communicator& comm, const Scene& scene,
                                                    const Section& table) {
    if (!table.has("file")) return {};
    const std::filesystem::path file = find_file(comm, scene, table.text("file"));
    int is_folder = 0;
    std::error_code unreadable;
    if (comm.is_root()) is_folder = std::filesystem::is_directory(file, unreadable) ? 1 : 0;
    if (comm.all_max(is_folder) == 0 && file.extension() != ".h5") return {};
    return file;
}

ParticleSet read_grains(const Communicator& comm, const std::filesystem::path& file, const Section& table) {
    ParticleSet grains("grains", 3);
    for (const FieldInfo* info : kept_fields) grains.add(*info);
    const std::int64_t of_body = table.has("of_body") ? table.integer("of_body", {}, 0, 254) : -1;
    try {
        const std::filesystem::path found = find_checkpoint(comm, file, {});
        if (read_particle_set(comm, found, grains).numbers.contains("clumps"))
            throw AgreedError(
                exit_input_output,
                fmt::format("{}: its grains are spheres of clumps, which are not read", found.string()));
        agree_on(comm, [&] { check_grains(found, grains); });
    } catch (const AgreedError& error) {
        table.error("file", error.what());
        grains.resize(0);
        return grains;
    }
    if (of_body >= 0) {
        std::vector<std::uint32_t> chosen;
        for (std::uint32_t i = 0; i < grains.size(); ++i)
            if (grains.data(field::body)[i] == of_body) chosen.push_back(i);
        grains = selected(grains.name(), grains, chosen, kept_fields);
    }
    if (comm.all_sum(static_cast<std::uint64_t>(grains.size())) == 0)
        table.error(of_body >= 0 ? "of_body" : "file", fmt::format("{}: no such grains", file.string()));
    return grains;
}

void append_grains(const ParticleSet& from, std::uint64_t first_id, std::uint8_t body, ParticleSet& grains) {
    const std::size_t before = grains.size();
    grains.resize(before + from.size());
    for (const Column& column : from.columns()) {
        Column& to = grains.column(*column.info);
        const std::size_t bytes = to.value_size();
        for (std::size_t c = 0; c < to.components.size() && from.size() > 0; ++c)
            std::memcpy(to.components[c].data() + before * bytes, column.components[c].data(),
                        from.size() * bytes);
    }
    for (std::size_t i = before; i < grains.size(); ++i) {
        grains.data(field::id)[i] += first_id;
        grains.data(field::body)[i] = body;
    }
}

void turn_grains(const Communicator& comm, const Point& spin, std::size_t begin, ParticleSet& grains) {
    std::vector<ExactSum> sums(4);
    for (std::size_t i = begin; i < grains.size(); ++i) {
        const double mass = grains.data(field::mass)[i];
        const Point x = place_of(grains, i);
        for (std::size_t a = 0; a < 3; ++a) sums[a].add(mass * x[a]);
        sums[3].add(mass);
    }
    ExactSum::all_reduce(comm, sums);
    const double all = sums[3].value();
    const Point centre = times(1 / all, {sums[0].value(), sums[1].value(), sums[2].value()});
    for (std::size_t i = begin; i < grains.size(); ++i) {
        const Point added = cross(spin, minus(place_of(grains, i), centre));
        for (int axis = 0; axis < 3; ++axis) {
            grains.data(field::velocity, axis)[i] += added[static_cast<std::size_t>(axis)];
            grains.data(field::angular_velocity, axis)[i] += spin[static_cast<std::size_t>(axis)];
        }
    }
}

}  // namespace talus
