#include "comm/sparse_exchange.hpp"

#include <algorithm>

namespace talus {

namespace {
std::vector<std::byte>& parcel_of(std::vector<Parcel>& parcels, int rank) {
    const auto at = std::find_if(parcels.begin(), parcels.end(),
                                 [rank](const Parcel& parcel) { return parcel.rank == rank; });
    if (at != parcels.end()) return at->bytes;
    parcels.push_back({rank, {}});
    return parcels.back().bytes;
}
}  // namespace

std::vector<Parcel> SparseExchange::operator()(std::vector<Parcel> outgoing) {
    if (comm_.size() == 1) return outgoing;
    const int tag = comm_.next_round_tag();

    std::vector<Parcel> incoming;
    std::vector<MPI_Request> sends;
    for (Parcel& parcel : outgoing) {
        if (parcel.rank == comm_.rank()) {
            incoming.push_back(std::move(parcel));
            continue;
        }
        std::size_t sent = 0;
        do {
            const std::size_t bytes = std::min(parcel.bytes.size() - sent, largest_message_);
            sends.emplace_back();
            MPI_Issend(parcel.bytes.data() + sent, static_cast<int>(bytes), MPI_BYTE, parcel.rank, tag,
                       comm_.handle(), &sends.back());
            sent += bytes;
        } while (sent < parcel.bytes.size());
    }

    MPI_Request barrier = MPI_REQUEST_NULL;
    bool in_barrier = false;
    for (int all_done = 0; !all_done;) {
        int arrived = 0;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, tag, comm_.handle(), &arrived, &status);
        if (arrived) {
            int bytes = 0;
            MPI_Get_count(&status, MPI_BYTE, &bytes);
            std::vector<std::byte>& received = parcel_of(incoming, status.MPI_SOURCE);
            const std::size_t before = received.size();  // pieces of one sender arrive in order
            received.resize(before + static_cast<std::size_t>(bytes));
            MPI_Recv(received.data() + before, bytes, MPI_BYTE, status.MPI_SOURCE, tag, comm_.handle(),
                     MPI_STATUS_IGNORE);
        }
        if (in_barrier) {
            MPI_Test(&barrier, &all_done, MPI_STATUS_IGNORE);
        } else {
            int sent = 0;
            MPI_Testall(static_cast<int>(sends.size()), sends.data(), &sent, MPI_STATUSES_IGNORE);
            if (sent) {
                MPI_Ibarrier(comm_.handle(), &barrier);
                in_barrier = true;
            }
        }
    }
    std::sort(incoming.begin(), incoming.end(),
              [](const Parcel& a, const Parcel& b) { return a.rank < b.rank; });
    return incoming;
}

}  // namespace talus
