#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "comm/halo.hpp"

namespace talus {

/// Refreshes some of the copies of a halo where particles are kept as records, their values side by side:
/// own ones in order, then the copies. Far fewer than all copies may be needed from step to step.
class RecordHalo {
  public:
    /// `width`: doubles a record, of which the first `refreshed` are sent; the first three are a position,
    /// which images have elsewhere.
    RecordHalo(const Communicator& comm, std::size_t width, std::size_t refreshed)
        : comm_(comm), width_(width), refreshed_(refreshed) {}

    /// The copies of the halo's last plan that are to be refreshed: `wanted` is 1 for each of these, in order
    /// of copies; `own`: number of own particles. The halo must have no mirror images. Collective.
    void choose(Halo& halo, std::size_t own, std::span<const std::uint8_t> wanted);

    /// The own records that other ranks are sent, each once, in order.
    std::span<const std::uint32_t> sent_records() const { return sent_records_; }

    /// Starts refreshing. The own records that others are sent must not change until finish().
    void begin(std::span<double> records);
    /// Waits for the copies and puts them in their places.
    void finish(std::span<double> records);

    /// Memory of lists and buffers.
    std::size_t bytes() const;

  private:
    struct Sent {
        std::uint32_t record, shift;  ///< own particle, and which of shifts_
    };
    struct Outgoing {
        int rank;
        std::vector<Sent> sent;
        std::vector<double> buffer;
    };
    struct Incoming {
        int rank;
        std::vector<std::uint32_t> records;
        std::vector<double> buffer;
    };
    void copy(const double* record, const Sent& sent, double* to) const;

    const Communicator& comm_;
    std::size_t width_, refreshed_;
    Halo* halo_ = nullptr;
    std::vector<std::array<double, 3>> shifts_;
    std::vector<std::uint32_t> sent_records_;
    std::vector<Outgoing> outgoing_;
    std::vector<Incoming> incoming_;
    std::vector<MPI_Request> requests_;
};

}  // namespace talus
