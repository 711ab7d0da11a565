#include "comm/sparse_exchange.hpp"

#include <algorithm>

namespace talus {

std::vector<Parcel> SparseExchange::operator()(std::vector<Parcel> outgoing) {
    constexpr int first_tag = 100;
    const int tag = first_tag + round_;
    round_ = 1 - round_;

    std::vector<Parcel> incoming;
    std::vector<MPI_Request> sends;
    for (Parcel& parcel : outgoing) {
        if (parcel.rank == comm_.rank()) {
            incoming.push_back(std::move(parcel));
            continue;
        }
        MPI_Request request;
        MPI_Issend(parcel.bytes.data(), static_cast<int>(parcel.bytes.size()), MPI_BYTE, parcel.rank, tag,
                   comm_.handle(), &request);
        sends.push_back(request);
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
            Parcel parcel{status.MPI_SOURCE, std::vector<std::byte>(static_cast<std::size_t>(bytes))};
            MPI_Recv(parcel.bytes.data(), bytes, MPI_BYTE, status.MPI_SOURCE, tag, comm_.handle(),
                     MPI_STATUS_IGNORE);
            incoming.push_back(std::move(parcel));
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
