#include "comm/halo.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <unordered_map>

#include "domain/boundary.hpp"

namespace talus {

namespace {

struct CellHeader {  // what the plan sends of a cell
    CellKey key;
    std::uint64_t count;
};

/// Ranks that own cells within reach of a cell (which may lie beyond the box). Neighbouring cells mostly
/// reach the same blocks, whose owners are then known already.
class OwnersWithinReach {
  public:
    OwnersWithinReach(const CellGrid& grid, const Partition& partition)
        : grid_(grid), partition_(partition) {}

    std::span<const int> operator()(const Cell& cell) {
        Cell lowest{}, highest{};
        for (int axis = 0; axis < grid_.box().dimension; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            lowest[a] = cell[a] - grid_.reach();
            highest[a] = cell[a] + grid_.reach();
            if (const int count = grid_.cell_count(axis); count > 0) {
                lowest[a] = std::clamp(lowest[a], 0, count - 1);
                highest[a] = std::clamp(highest[a], 0, count - 1);
            }
            lowest[a] >>= partition_.block_shift();
            highest[a] >>= partition_.block_shift();
        }
        if (!owners_.empty() && lowest == lowest_ && highest == highest_) return owners_;
        lowest_ = lowest;
        highest_ = highest;
        owners_.clear();
        for (int z = lowest[2]; z <= highest[2]; ++z)
            for (int y = lowest[1]; y <= highest[1]; ++y)
                for (int x = lowest[0]; x <= highest[0]; ++x) add(block_key_of({x, y, z}, 0));
        return owners_;
    }

  private:
    void add(std::uint64_t block_key) {
        const auto [at, is_new] = owner_of_block_.try_emplace(block_key, 0);
        if (is_new) at->second = partition_.owner_of_block(block_key);
        if (std::find(owners_.begin(), owners_.end(), at->second) == owners_.end())
            owners_.push_back(at->second);
    }

    const CellGrid& grid_;
    const Partition& partition_;
    std::unordered_map<std::uint64_t, int> owner_of_block_;
    Cell lowest_{}, highest_{};
    std::vector<int> owners_;  ///< of the blocks from lowest_ to highest_
};

}  // namespace

void Halo::choose_cells(const CellGrid& grid, const Partition& partition, std::span<const CellEntry> own) {
    outgoing_.clear();
    std::map<int, std::size_t> outgoing_of_rank;
    OwnersWithinReach owners_within_reach(grid, partition);
    const auto send = [&](int rank, const CellEntry& entry, const Image& image) {
        const auto [at, is_new] = outgoing_of_rank.try_emplace(rank, outgoing_.size());
        if (is_new) outgoing_.push_back({rank, {}, 0});
        outgoing_[at->second].cells.push_back({entry.begin, entry.end, image});
        outgoing_[at->second].count += entry.end - entry.begin;
    };
    for (const CellEntry& entry : own) {
        const Cell cell = cell_of(entry.key);
        if (comm_.size() > 1) {
            for (const int rank : owners_within_reach(cell))
                if (rank != comm_.rank()) send(rank, entry, Image{cell, {}, {}});
        }
        if (!grid.has_copies(cell)) continue;
        const std::vector<Image> images = grid.images(cell);
        for (std::size_t k = 1; k < images.size(); ++k) {
            for (const int rank : owners_within_reach(images[k].cell)) send(rank, entry, images[k]);
        }
    }
}

std::vector<CellEntry> Halo::plan(const CellGrid& grid, const Partition& partition,
                                  std::span<const CellEntry> own, ParticleSet& particles) {
    choose_cells(grid, partition, own);
    std::vector<Parcel> parcels;
    for (const Outgoing& outgoing : outgoing_) {
        Parcel parcel{outgoing.rank, std::vector<std::byte>(outgoing.cells.size() * sizeof(CellHeader))};
        auto* header = reinterpret_cast<CellHeader*>(parcel.bytes.data());
        for (const SentCell& cell : outgoing.cells)
            *header++ = {key_of(cell.image.cell), cell.end - cell.begin};
        if (outgoing.rank != comm_.rank()) {
            ++messages_sent_;
            bytes_sent_ += parcel.bytes.size();
        }
        parcels.push_back(std::move(parcel));
    }
    return place_copies(exchange_(std::move(parcels)), particles);
}

std::vector<CellEntry> Halo::place_copies(const std::vector<Parcel>& parcels, ParticleSet& particles) {
    struct Arrival {
        CellHeader header;
        std::size_t source, order;
    };
    incoming_.clear();
    std::vector<Arrival> arrivals;
    for (const Parcel& parcel : parcels) {
        const std::size_t cells = parcel.bytes.size() / sizeof(CellHeader);
        const auto* header = reinterpret_cast<const CellHeader*>(parcel.bytes.data());
        for (std::size_t k = 0; k < cells; ++k) arrivals.push_back({header[k], incoming_.size(), k});
        incoming_.push_back({parcel.rank, std::vector<Run>(cells), 0});
    }
    std::sort(arrivals.begin(), arrivals.end(),
              [](const Arrival& a, const Arrival& b) { return a.header.key < b.header.key; });
    std::vector<CellEntry> copies;
    copies.reserve(arrivals.size());
    auto next = static_cast<std::uint32_t>(particles.size());
    for (const Arrival& arrival : arrivals) {
        const std::uint32_t end = next + static_cast<std::uint32_t>(arrival.header.count);
        incoming_[arrival.source].slots[arrival.order] = {next, end};
        incoming_[arrival.source].count += arrival.header.count;
        copies.push_back({arrival.header.key, next, end, true, false});
        next = end;
    }
    particles.set_halo_size(next - particles.size());
    return copies;
}

namespace {
template <class Real>
void place_image(Real* values, std::size_t count, bool flips, Real shift) {
    if (flips)
        for (std::size_t k = 0; k < count; ++k) values[k] = -values[k];
    if (shift != 0)
        for (std::size_t k = 0; k < count; ++k) values[k] += shift;
}
}  // namespace

void Halo::pack(const Outgoing& outgoing, std::byte* to) const {
    for (const FieldInfo* info : fields_) {
        const Column& column = particles_->column(*info);
        for (std::size_t c = 0; c < column.components.size(); ++c) {
            const std::byte* from = column.components[c].data();
            for (const SentCell& cell : outgoing.cells) {
                const std::size_t size = column.value_size(), n = cell.end - cell.begin;
                std::memcpy(to, from + cell.begin * size, n * size);
                if (!cell.image.is_original()) {
                    const bool flips = mirror_sign(info->shape, static_cast<int>(c), particles_->dimension(),
                                                   cell.image.flip) < 0;
                    if (info->type == ValueType::f64)
                        place_image(reinterpret_cast<double*>(to), n, flips,
                                    info->shape == Shape::point ? cell.image.shift[c] : 0.0);
                    if (info->type == ValueType::f32)
                        place_image(reinterpret_cast<float*>(to), n, flips, 0.0F);
                }
                to += n * size;
            }
        }
    }
}

void Halo::unpack(const Incoming& incoming, const std::byte* from) const {
    for (const FieldInfo* info : fields_) {
        Column& column = particles_->column(*info);
        for (auto& component : column.components)
            for (const Run& slot : incoming.slots) {
                const std::size_t bytes = (slot.end - slot.begin) * column.value_size();
                std::memcpy(component.data() + slot.begin * column.value_size(), from, bytes);
                from += bytes;
            }
    }
}

void Halo::begin(ParticleSet& particles, std::initializer_list<const FieldInfo*> fields) {
    constexpr int tag = 10;
    particles_ = &particles;
    fields_.clear();
    for (const FieldInfo* info : fields)
        if (particles.has(*info)) fields_.push_back(info);
    // Widest values first, so that every value in a message is aligned.
    std::stable_sort(fields_.begin(), fields_.end(), [](const FieldInfo* a, const FieldInfo* b) {
        return size_of(a->type) > size_of(b->type);
    });
    requests_.clear();
    std::size_t particle_bytes = 0;
    for (const FieldInfo* info : fields_)
        particle_bytes += particles.column(*info).components.size() * size_of(info->type);
    const auto grow = [&](Buffers& buffers, std::size_t k, std::size_t count) {
        if (buffers.size() <= k) buffers.resize(k + 1);
        if (buffers[k].size() < count * particle_bytes) buffers[k].resize(count * particle_bytes);
        return buffers[k].data();
    };
    for (std::size_t k = 0; k < incoming_.size(); ++k) {
        const Incoming& incoming = incoming_[k];
        std::byte* buffer = grow(received_, k, incoming.count);
        if (incoming.rank == comm_.rank()) continue;
        MPI_Irecv(buffer, static_cast<int>(incoming.count * particle_bytes), MPI_BYTE, incoming.rank, tag,
                  comm_.handle(), &requests_.emplace_back());
    }
    for (std::size_t k = 0; k < outgoing_.size(); ++k) {
        const Outgoing& outgoing = outgoing_[k];
        const std::size_t bytes = outgoing.count * particle_bytes;
        std::byte* buffer = grow(sent_, k, outgoing.count);
        pack(outgoing, buffer);
        if (outgoing.rank == comm_.rank()) continue;
        MPI_Isend(buffer, static_cast<int>(bytes), MPI_BYTE, outgoing.rank, tag, comm_.handle(),
                  &requests_.emplace_back());
        ++messages_sent_;
        bytes_sent_ += bytes;
    }
}

void Halo::finish() {
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
    for (std::size_t k = 0; k < incoming_.size(); ++k) {
        if (incoming_[k].rank == comm_.rank())
            for (std::size_t own = 0; own < outgoing_.size(); ++own)
                if (outgoing_[own].rank == comm_.rank()) std::swap(received_[k], sent_[own]);
        unpack(incoming_[k], received_[k].data());
    }
}

}  // namespace talus
