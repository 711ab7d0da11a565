#pragma once
#include <initializer_list>
#include <span>
#include <vector>

#include "comm/sparse_exchange.hpp"
#include "domain/cell_table.hpp"
#include "domain/particles.hpp"
#include "domain/partition.hpp"

namespace talus {

/// Copies of the particles within reach of a rank's own cells: those of other ranks, and periodic or
/// mirrored images of any rank's. A plan made once per arrangement of particles says which cells go where;
/// after that, fields are refreshed with one message per neighbour rank and phase.
class Halo {
  public:
    struct SentCell {
        std::uint32_t begin, end;
        Image image;
    };
    struct Outgoing {
        int rank;
        std::vector<SentCell> cells;
        std::size_t count = 0;  ///< particles
    };
    struct Incoming {
        int rank;
        std::vector<Run> slots;  ///< where each cell sent is put, in the sender's order
        std::size_t count = 0;   ///< particles
    };

    Halo(const Communicator& comm) : comm_(comm), exchange_(comm) {}

    /// Collective. `own` are the set's own cells in order of key. Makes room in `particles` for the copies
    /// and returns their cells.
    std::vector<CellEntry> plan(const CellGrid& grid, const Partition& partition,
                                std::span<const CellEntry> own, ParticleSet& particles);

    /// Starts refreshing the copies of these fields. The own values must not change until finish().
    void begin(ParticleSet& particles, std::initializer_list<const FieldInfo*> fields);
    /// Waits for the copies and puts them in their places.
    void finish();

    /// The plan: what goes to which rank, and what comes from where.
    std::span<const Outgoing> outgoing() const { return outgoing_; }
    std::span<const Incoming> incoming() const { return incoming_; }

    /// Counts messages that were sent by others along the plan.
    void count_sent(std::uint64_t messages, std::uint64_t bytes) {
        messages_sent_ += messages;
        bytes_sent_ += bytes;
    }
    /// Since construction, this rank: messages sent, bytes sent.
    std::uint64_t messages_sent() const { return messages_sent_; }
    std::uint64_t bytes_sent() const { return bytes_sent_; }

  private:
    /// One for each of them, kept from plan to plan and never shrunk: new memory is dear.
    using Buffers = std::vector<std::vector<std::byte>>;

    void choose_cells(const CellGrid& grid, const Partition& partition, std::span<const CellEntry> own);
    std::vector<CellEntry> place_copies(const std::vector<Parcel>& parcels, ParticleSet& particles);
    void pack(const Outgoing& outgoing, std::byte* to) const;
    void unpack(const Incoming& incoming, const std::byte* from) const;

    const Communicator& comm_;
    SparseExchange exchange_;
    std::vector<Outgoing> outgoing_;
    std::vector<Incoming> incoming_;
    Buffers sent_, received_;
    ParticleSet* particles_ = nullptr;      ///< of the refresh under way
    std::vector<const FieldInfo*> fields_;  ///< of the refresh under way
    std::vector<MPI_Request> requests_;
    std::uint64_t messages_sent_ = 0, bytes_sent_ = 0;
};

}  // namespace talus
