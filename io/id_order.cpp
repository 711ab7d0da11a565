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
    find_sources(sorted, set_name);
    count_slabs();
}

/// Where each of this rank's rows comes from.
void IdOrder::find_sources(std::span<const std::uint64_t> sorted, std::string_view set_name) {
    const auto ranks = static_cast<std::size_t>(comm_.size());
    std::vector<int> send_counts(ranks), receive_counts(ranks), receive_starts(ranks + 1, 0);
    for (std::size_t r = 0; r < ranks; ++r)
        send_counts[r] =
            (r + 1 < ranks ? send_starts_[r + 1] : static_cast<int>(sorted.size())) - send_starts_[r];
    MPI_Alltoall(send_counts.data(), 1, MPI_INT, receive_counts.data(), 1, MPI_INT, comm_.handle());
    for (std::size_t r = 0; r < ranks; ++r) receive_starts[r + 1] = receive_starts[r] + receive_counts[r];
    std::vector<std::uint64_t> arrived(static_cast<std::size_t>(receive_starts.back()));
    MPI_Alltoallv(sorted.data(), send_counts.data(), send_starts_.data(), MPI_UINT64_T, arrived.data(),
                  receive_counts.data(), receive_starts.data(), MPI_UINT64_T, comm_.handle());
    std::vector<std::uint32_t> order(arrived.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return arrived[a] < arrived[b]; });
    agree_on(comm_, [&] {
        for (std::size_t k = 1; k < arrived.size(); ++k)
            if (arrived[order[k]] == arrived[order[k - 1]])
                throw std::runtime_error(
                    fmt::format("particle set {}: id {} occurs twice", set_name, arrived[order[k]]));
    });
    agree_on(comm_, [&] {
        if (arrived.size() != rows_.count())
            throw std::runtime_error(fmt::format("particle set {}: an id occurs twice", set_name));
    });
    source_of_row_.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const auto after = std::upper_bound(receive_starts.begin(), receive_starts.end(), order[k]);
        source_of_row_[k] = static_cast<int>(after - receive_starts.begin()) - 1;
    }
}

/// How many rows of each slab go from whom to whom.
void IdOrder::count_slabs() {
    slabs_ = comm_.all_max(slabs_in(rows_));
    receive_counts_.assign(static_cast<std::size_t>(comm_.size()) * slabs_, 0);
    send_counts_.resize(receive_counts_.size());
    for (std::size_t k = 0; k < source_of_row_.size(); ++k)
        ++receive_counts_[static_cast<std::size_t>(source_of_row_[k]) * slabs_ + k / rows_per_slab];
    const int slabs = static_cast<int>(slabs_);
    MPI_Alltoall(receive_counts_.data(), slabs, MPI_INT, send_counts_.data(), slabs, MPI_INT, comm_.handle());
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

std::vector<std::byte> IdOrder::exchange(std::uint64_t slab, std::size_t row_bytes, const Pack& pack) const {
    const auto ranks = static_cast<std::size_t>(comm_.size());
    std::vector<int> send_counts(ranks), receive_counts(ranks), send_starts(ranks, 0),
        receive_starts(ranks, 0);
    std::vector<std::uint32_t> leaving;
    for (std::size_t r = 0; r < ranks; ++r) {
        const auto counts = send_counts_.begin() + static_cast<std::ptrdiff_t>(r * slabs_);
        const auto here = counts + static_cast<std::ptrdiff_t>(slab);
        const auto first = send_order_.begin() + std::accumulate(counts, here, send_starts_[r]);
        send_counts[r] = *here;
        receive_counts[r] = receive_counts_[r * slabs_ + slab];
        send_starts[r] = static_cast<int>(leaving.size());
        if (r > 0) receive_starts[r] = receive_starts[r - 1] + receive_counts[r - 1];
        leaving.insert(leaving.end(), first, first + *here);
    }
    const std::vector<std::byte> packed = pack(leaving);
    const RowRange range = slab_of(rows_, slab);
    std::vector<std::byte> received(range.count() * row_bytes), rows(received.size());
    MPI_Datatype row = MPI_DATATYPE_NULL;
    MPI_Type_contiguous(static_cast<int>(row_bytes), MPI_BYTE, &row);
    MPI_Type_commit(&row);
    MPI_Alltoallv(packed.data(), send_counts.data(), send_starts.data(), row, received.data(),
                  receive_counts.data(), receive_starts.data(), row, comm_.handle());
    MPI_Type_free(&row);
    std::vector<int>& next = receive_starts;  // each source's rows arrive in order of id
    for (std::size_t k = 0; k < range.count(); ++k) {
        const int source = source_of_row_[static_cast<std::size_t>(range.begin - rows_.begin) + k];
        const auto from = static_cast<std::size_t>(next[static_cast<std::size_t>(source)]++);
        std::memcpy(rows.data() + k * row_bytes, received.data() + from * row_bytes, row_bytes);
    }
    return rows;
}

}  // namespace talus
