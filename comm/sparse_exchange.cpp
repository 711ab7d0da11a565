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
    std::vector<Parcel> incoming;
    const auto to_itself = std::find_if(outgoing.begin(), outgoing.end(),
                                        [this](const Parcel& parcel) { return parcel.rank == comm_.rank(); });
    if (to_itself != outgoing.end()) {
        incoming.push_back(std::move(*to_itself));
        outgoing.erase(to_itself);
    }
    if (comm_.size() == 1) return incoming;
    const int tag = comm_.next_round_tag();
    if (comm_.size() <= few_)
        exchange_announced(outgoing, tag, incoming);
    else
        exchange_unannounced(outgoing, tag, incoming);
    std::sort(incoming.begin(), incoming.end(),
              [](const Parcel& a, const Parcel& b) { return a.rank < b.rank; });
    return incoming;
}

/// Starts sending all parcels, in pieces; an empty one is a message too.
std::vector<MPI_Request> SparseExchange::send(const std::vector<Parcel>& outgoing, int tag, Send how) const {
    std::vector<MPI_Request> sends;
    for (const Parcel& parcel : outgoing) {
        std::size_t sent = 0;
        do {
            const std::size_t bytes = std::min(parcel.bytes.size() - sent, largest_message_);
            how(parcel.bytes.data() + sent, static_cast<int>(bytes), MPI_BYTE, parcel.rank, tag,
                comm_.handle(), &sends.emplace_back());
            sent += bytes;
        } while (sent < parcel.bytes.size());
    }
    return sends;
}

void SparseExchange::exchange_announced(const std::vector<Parcel>& outgoing, int tag,
                                        std::vector<Parcel>& incoming) const {
    std::vector<std::int64_t> to_come(static_cast<std::size_t>(comm_.size()), -1), announced = to_come;
    for (const Parcel& parcel : outgoing)
        announced[static_cast<std::size_t>(parcel.rank)] = static_cast<std::int64_t>(parcel.bytes.size());
    MPI_Alltoall(announced.data(), 1, MPI_INT64_T, to_come.data(), 1, MPI_INT64_T, comm_.handle());
    std::vector<MPI_Request> requests = send(outgoing, tag, MPI_Isend);
    for (int rank = 0; rank < comm_.size(); ++rank) {
        if (to_come[static_cast<std::size_t>(rank)] < 0) continue;
        const auto size = static_cast<std::size_t>(to_come[static_cast<std::size_t>(rank)]);
        std::vector<std::byte>& bytes =
            incoming.emplace_back(Parcel{rank, std::vector<std::byte>(size)}).bytes;
        std::size_t received = 0;
        do {
            const std::size_t piece = std::min(size - received, largest_message_);
            MPI_Irecv(bytes.data() + received, static_cast<int>(piece), MPI_BYTE, rank, tag, comm_.handle(),
                      &requests.emplace_back());
            received += piece;
        } while (received < size);
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

void SparseExchange::exchange_unannounced(const std::vector<Parcel>& outgoing, int tag,
                                          std::vector<Parcel>& incoming) const {
    std::vector<MPI_Request> sends = send(outgoing, tag, MPI_Issend);
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
}

}  // namespace talus
