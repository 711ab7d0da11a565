#pragma once
#include <cstddef>
#include <vector>

#include "comm/communicator.hpp"

namespace talus {

/// Bytes for, or from, one rank.
struct Parcel {
    int rank;
    std::vector<std::byte> bytes;
};

/// Exchange in which receivers do not know who will send: a rank posts one message to each destination and
/// learns of the end by a non-blocking barrier, so the number of messages does not grow with the number of
/// ranks. T. Hoefler, C. Siebert, A. Lumsdaine, PPoPP 2010 ("NBX").
class SparseExchange {
  public:
    /// Parcels above `largest_message` bytes travel in pieces, for MPI counts are ints.
    explicit SparseExchange(const Communicator& comm, std::size_t largest_message = std::size_t{1} << 30)
        : comm_(comm), largest_message_(largest_message) {}

    /// Collective. At most one parcel a rank; those to the own rank are handed back without MPI. The result
    /// is sorted by rank.
    std::vector<Parcel> operator()(std::vector<Parcel> outgoing);

  private:
    const Communicator& comm_;
    std::size_t largest_message_;
};

}  // namespace talus
