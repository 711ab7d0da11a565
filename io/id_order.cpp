#include "io/id_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include "io/agree.hpp"

namespace talus {

RowRange rows_of_rank(std::uint64_t total, int rank, int size) {
    const std::uint64_t blocks = (total + rows_per_block - 1) / rows_per_block;
    const auto first_row = [&](int r) {
        const auto parts = static_cast<std::uint64_t>(size);
        const auto part = static_cast<std::uint64_t>(r);
        const std::uint64_t block = blocks / parts * part + std::min(part, blocks % parts);
        return std::min(total, block * rows_per_block);
    };
    return {first_row(rank), first_row(rank + 1)};
}

IdOrder::IdOrder(const Communicator& comm, std::span<const std::uint64_t> ids, std::string_view set_name)
    : comm_(comm) {
    total_ = comm.all_sum(static_cast<std::uint64_t>(ids.size()));
    rows_ = rows_of_rank(total_, comm.rank(), comm.size());
    send_order_.resize(ids.size());
    std::iota(send_order_.begin(), send_order_.end(), 0U);
    std::sort(send_order_.begin(), send_order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
    std::vector<std::uint64_t> sorted(ids.size());
    for (std::size_t k = 0; k < ids.size(); ++k) sorted[k] = ids[send_order_[k]];

    const auto ranks = static_cast<std::size_t>(comm.size());
    std::vector<std::uint64_t> positions;  // where the shares of ranks 1, 2, ... begin
    for (int r = 1; r < comm.size(); ++r) positions.push_back(rows_of_rank(total_, r, comm.size()).begin);
    const std::vector<std::uint64_t> first_ids = ids_at(sorted, positions);
    send_starts_.assign(ranks, 0);
    for (std::size_t r = 1; r < ranks; ++r) {
        const auto first = std::lower_bound(sorted.begin(), sorted.end(), first_ids[r - 1]);
        send_starts_[r] = static_cast<int>(positions[r - 1] == total_ ? sorted.end() - sorted.begin()
                                                                      : first - sorted.begin());
    }
    send_counts_.resize(ranks);
    for (std::size_t r = 0; r < ranks; ++r)
        send_counts_[r] =
            (r + 1 < ranks ? send_starts_[r + 1] : static_cast<int>(sorted.size())) - send_starts_[r];
    receive_counts_.resize(ranks);
    MPI_Alltoall(send_counts_.data(), 1, MPI_INT, receive_counts_.data(), 1, MPI_INT, comm.handle());
    receive_starts_.assign(ranks, 0);
    for (std::size_t r = 1; r < ranks; ++r)
        receive_starts_[r] = receive_starts_[r - 1] + receive_counts_[r - 1];

    const std::vector<std::byte> received = send(std::as_bytes(std::span(sorted)), sizeof(std::uint64_t));
    std::vector<std::uint64_t> arrived(received.size() / sizeof(std::uint64_t));
    if (!received.empty()) std::memcpy(arrived.data(), received.data(), received.size());
    receive_order_.resize(arrived.size());
    std::iota(receive_order_.begin(), receive_order_.end(), 0U);
    std::sort(receive_order_.begin(), receive_order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return arrived[a] < arrived[b]; });
    agree_on(comm, [&] {
        for (std::size_t k = 1; k < arrived.size(); ++k)
            if (arrived[receive_order_[k]] == arrived[receive_order_[k - 1]])
                throw std::runtime_error(
                    fmt::format("particle set {}: id {} occurs twice", set_name, arrived[receive_order_[k]]));
    });
    agree_on(comm, [&] {
        if (arrived.size() != rows_.count())
            throw std::runtime_error(fmt::format("particle set {}: an id occurs twice", set_name));
    });
}

/// The ids at `positions` of the order over all ranks, by bisection of all of them at once.
std::vector<std::uint64_t> IdOrder::ids_at(std::span<const std::uint64_t> sorted,
                                           std::span<const std::uint64_t> positions) const {
    const std::uint64_t least =
        comm_.all_min(sorted.empty() ? std::numeric_limits<std::uint64_t>::max() : sorted.front());
    const std::uint64_t greatest = comm_.all_max(sorted.empty() ? std::uint64_t{0} : sorted.back());
    std::vector<std::uint64_t> low(positions.size(), least), high(positions.size(), greatest),
        counts(positions.size());
    if (total_ == 0) return low;
    const auto unsettled = [&](std::size_t k) { return low[k] < high[k]; };
    while (true) {
        bool settled = true;
        for (std::size_t k = 0; k < positions.size(); ++k) {
            const std::uint64_t middle = low[k] + (high[k] - low[k]) / 2;
            counts[k] = static_cast<std::uint64_t>(std::upper_bound(sorted.begin(), sorted.end(), middle) -
                                                   sorted.begin());
            settled = settled && !unsettled(k);
        }
        if (settled) return low;  // low and high are the same on every rank
        comm_.all_sum(std::span(counts));
        for (std::size_t k = 0; k < positions.size(); ++k) {
            if (!unsettled(k)) continue;
            const std::uint64_t middle = low[k] + (high[k] - low[k]) / 2;
            if (counts[k] > positions[k])
                high[k] = middle;
            else
                low[k] = middle + 1;
        }
    }
}

std::vector<std::byte> IdOrder::send(std::span<const std::byte> packed, std::size_t row_bytes) const {
    const auto arriving =
        static_cast<std::size_t>(receive_starts_.back()) + static_cast<std::size_t>(receive_counts_.back());
    std::vector<std::byte> received(arriving * row_bytes);
    MPI_Datatype row = MPI_DATATYPE_NULL;  // counts in rows, since bytes may not fit an int
    MPI_Type_contiguous(static_cast<int>(row_bytes), MPI_BYTE, &row);
    MPI_Type_commit(&row);
    MPI_Alltoallv(packed.data(), send_counts_.data(), send_starts_.data(), row, received.data(),
                  receive_counts_.data(), receive_starts_.data(), row, comm_.handle());
    MPI_Type_free(&row);
    return received;
}

std::vector<std::byte> IdOrder::exchange(std::span<const std::byte> packed, std::size_t row_bytes) const {
    const std::vector<std::byte> received = send(packed, row_bytes);
    std::vector<std::byte> rows(received.size());
    for (std::size_t k = 0; k < receive_order_.size(); ++k)
        std::memcpy(rows.data() + k * row_bytes, received.data() + receive_order_[k] * row_bytes, row_bytes);
    return rows;
}

}  // namespace talus
