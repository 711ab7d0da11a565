#include "src/water/open_boundaries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "comm/exact_sum.hpp"
#include "domain/water_fields.hpp"
#include "io/agree.hpp"

namespace talus {

using Kind = water::Buffer::Kind;

OpenBoundaries::OpenBoundaries(const Communicator& comm, OpenPlan plan)
    : comm_(comm), plan_(std::move(plan)), passed_(plan_.buffers.size()), returned_(plan_.buffers.size()) {}

void OpenBoundaries::begin(const ParticleSet& particles) {
    first_count_ = comm_.all_sum(static_cast<std::uint64_t>(particles.size()));
}

void OpenBoundaries::save(std::map<std::string, double>& numbers) const {
    numbers["open.first_count"] = static_cast<double>(first_count_);
    numbers["open.created"] = static_cast<double>(created_);
    numbers["open.deleted"] = static_cast<double>(deleted_);
    for (std::size_t b = 0; b < plan_.buffers.size(); ++b) {
        if (!plan_.buffers[b].is_open()) continue;
        const std::string prefix = "open." + plan_.names[b];
        numbers[prefix + ".count"] = static_cast<double>(passed_[b].count);
        numbers[prefix + ".mass"] = passed_[b].mass;
        numbers[prefix + ".returned_count"] = static_cast<double>(returned_[b].count);
        numbers[prefix + ".returned_mass"] = returned_[b].mass;
    }
}

void OpenBoundaries::restore(const std::map<std::string, double>& numbers, const ParticleSet& particles) {
    begin(particles);
    const std::uint64_t there = first_count_;
    const auto stored = [&](const std::string& name) {
        const auto found = numbers.find("open." + name);
        return found == numbers.end() ? 0.0 : found->second;
    };
    const auto count = [&](const std::string& name) { return static_cast<std::uint64_t>(stored(name)); };
    first_count_ = count("first_count");
    created_ = count("created");
    deleted_ = count("deleted");
    for (std::size_t b = 0; b < plan_.buffers.size(); ++b) {
        passed_[b] = {count(plan_.names[b] + ".count"), stored(plan_.names[b] + ".mass")};
        returned_[b] = {count(plan_.names[b] + ".returned_count"), stored(plan_.names[b] + ".returned_mass")};
    }
    if (first_count_ + created_ - deleted_ != there)
        throw AgreedError(1,
                          fmt::format("the checkpoint holds {} particles; those that the run began with, {}, "
                                      "those created, {}, and those deleted, {}, do not come to that",
                                      there, first_count_, created_, deleted_));
}

OpenBoundaries::Fate OpenBoundaries::fate_of(std::size_t body, const Point& x, int dimension) const {
    const water::Buffer& own = plan_.buffers[body];
    switch (own.kind) {
        case Kind::wall:
            return {};
        case Kind::inflow:
            return own.behind_face(x) > 0 ? Fate{} : Fate{Fate::enters, body};
        case Kind::outflow:
            return own.behind_face(x) > own.depth() ? Fate{Fate::ends, body} : Fate{};
        case Kind::water:
            break;
    }
    for (std::size_t b = 0; b < plan_.buffers.size(); ++b) {
        const water::Buffer& buffer = plan_.buffers[b];
        if (!buffer.is_open() || !buffer.is_beside(x, dimension)) continue;
        const double behind = buffer.behind_face(x);
        if (behind <= 0 || behind > buffer.depth()) continue;
        if (buffer.kind == Kind::outflow) return {Fate::leaves, b};
        if (behind > 0.5 * plan_.spacing) return {Fate::returns, b};
    }
    return {};
}

OpenBoundaries::Change OpenBoundaries::apply(ParticleSet& particles, const water::Settings& settings,
                                             double time) {
    refuse_full(particles, settings, time);
    const std::size_t bodies = plan_.buffers.size(), created = 2 * bodies, deleted = created + 2;
    std::vector<std::uint64_t> counts(2 * bodies +
                                      4);  // passed, returned; created and deleted with sums of ids
    std::vector<ExactSum> masses(2 * bodies);
    std::vector<std::uint32_t> kept, followed;
    const std::uint64_t* id = particles.data(field::id);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        std::uint8_t& body = particles.data(field::body)[i];
        const Fate fate = fate_of(body, place(particles, i), particles.dimension());
        const auto index = static_cast<std::uint32_t>(i);
        if (fate.what != Fate::returns && fate.what != Fate::ends) kept.push_back(index);
        if (fate.what == Fate::stays) continue;
        if (fate.what != Fate::ends) {
            const std::size_t entry = fate.what == Fate::returns ? bodies + fate.buffer : fate.buffer;
            ++counts[entry];
            masses[entry].add(particles.data(field::mass)[i]);
        }
        if (fate.what == Fate::enters) {
            followed.push_back(index);
            ++counts[created];
            counts[created + 1] += id[i] + first_count_;
        } else if (fate.what == Fate::leaves) {
            body = static_cast<std::uint8_t>(fate.buffer);
            stop_rates(particles, i);
            for (int a = 0; a < particles.dimension(); ++a)
                if (a != plan_.buffers[fate.buffer].axis) particles.data(field::velocity, a)[i] = 0;
        } else {
            ++counts[deleted];
            counts[deleted + 1] += id[i];
        }
    }
    const bool rearranged = !followed.empty() || kept.size() < particles.size();
    comm_.all_sum(std::span<std::uint64_t>(counts));
    if (std::ranges::all_of(counts, [](std::uint64_t count) { return count == 0; })) return {};
    ExactSum::all_reduce(comm_, masses);
    for (std::size_t b = 0; b < bodies; ++b) {
        passed_[b].count += counts[b];
        passed_[b].mass += masses[b].value();
        returned_[b].count += counts[bodies + b];
        returned_[b].mass += masses[bodies + b].value();
    }
    created_ += counts[created];
    deleted_ += counts[deleted];
    if (rearranged) follow(particles, kept, followed);
    return {{{counts[created], counts[created + 1]}}, {{counts[deleted], counts[deleted + 1]}}};
}

Point OpenBoundaries::place(const ParticleSet& particles, std::size_t i) {
    Point x{};
    for (int a = 0; a < particles.dimension(); ++a)
        x[static_cast<std::size_t>(a)] = particles.data(field::position, a)[i];
    return x;
}

/// Of a particle that moves on as its buffer tells.
void OpenBoundaries::stop_rates(ParticleSet& particles, std::size_t i) {
    particles.data(water_field::density_rate)[i] = 0;
    for (int a = 0; a < particles.dimension(); ++a) {
        particles.data(field::acceleration, a)[i] = 0;
        if (particles.has(water_field::shift_velocity)) particles.data(water_field::shift_velocity, a)[i] = 0;
    }
}

/// Keeps some particles; those that are followed become water, and another one like each is a buffer's depth
/// behind it.
void OpenBoundaries::follow(ParticleSet& particles, std::vector<std::uint32_t> kept,
                            const std::vector<std::uint32_t>& followed) const {
    const std::size_t first = kept.size();
    for (const std::uint32_t i : followed) particles.data(field::id)[i] += first_count_;
    kept.insert(kept.end(), followed.begin(), followed.end());
    particles.reorder(kept);
    for (std::size_t k = first; k < particles.size(); ++k) {
        const water::Buffer& buffer = plan_.buffers[particles.data(field::body)[k]];
        particles.data(field::position, buffer.axis)[k] -= buffer.sign * buffer.depth();
    }
    // those kept have the ids of those that follow them
    std::size_t next = first;
    for (std::size_t k = 0; k < first && next < particles.size(); ++k) {
        if (particles.data(field::id)[k] != particles.data(field::id)[next]) continue;
        particles.data(field::id)[k] -= first_count_;
        particles.data(field::body)[k] = plan_.water;
        ++next;
    }
}

void OpenBoundaries::refuse_full(const ParticleSet& particles, const water::Settings& settings,
                                 double time) const {
    constexpr double most = 1.1;  // of the density at rest
    double greatest = 0;
    std::size_t where = 0;
    for (std::size_t i = 0; i < particles.size(); ++i)
        if (const std::uint8_t b = particles.data(field::body)[i];
            plan_.buffers[b].kind == Kind::inflow && particles.data(field::density)[i] > greatest) {
            greatest = particles.data(field::density)[i];
            where = b;
        }
    const bool is_full = greatest > most * settings.state.reference_density;
    comm_.all_agree(
        1, is_full
               ? fmt::format(
                     "time {} s: '{}' pushes water into a region that is full: the density in front of it is "
                     "{:.4g} kg/m3, more than {} times that at rest",
                     time, plan_.names[where], greatest, most)
               : std::string());
}

void OpenBoundaries::look(std::vector<std::uint64_t> seeing) {
    comm_.all_sum(std::span<std::uint64_t>(seeing));
    for (std::size_t b = 0; b < plan_.buffers.size(); ++b)
        if (plan_.buffers[b].is_open() && seeing[b] == 0)
            notes_.push_back(fmt::format(
                "there is no water at the face of '{}' at the start: is it where the water is, and "
                "does it face it?",
                plan_.names[b]));
}

std::vector<std::string> OpenBoundaries::take_notes() { return std::exchange(notes_, {}); }

}  // namespace talus
