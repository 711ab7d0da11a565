#include "comm/record_halo.hpp"

#include <algorithm>
#include <stdexcept>

namespace talus {

namespace {
constexpr int tag_of_wishes = 11, tag_of_records = 12;
}

void RecordHalo::choose(Halo& halo, std::size_t own, std::span<const std::uint8_t> wanted) {
    halo_ = &halo;
    const auto& from = halo.incoming();
    const auto& to = halo.outgoing();
    std::vector<std::vector<std::uint8_t>> wishes(from.size()), wishes_of_others(to.size());
    incoming_.resize(from.size());
    requests_.clear();
    for (std::size_t k = 0; k < from.size(); ++k) {
        incoming_[k].rank = from[k].rank;
        incoming_[k].records.clear();
        for (const Run& slot : from[k].slots)
            for (std::uint32_t i = slot.begin; i < slot.end; ++i) {
                wishes[k].push_back(wanted[i - own]);
                if (wanted[i - own]) incoming_[k].records.push_back(i);
            }
        if (from[k].rank == comm_.rank()) continue;
        incoming_[k].buffer.resize(incoming_[k].records.size() * refreshed_);
        MPI_Isend(wishes[k].data(), static_cast<int>(wishes[k].size()), MPI_BYTE, from[k].rank, tag_of_wishes,
                  comm_.handle(), &requests_.emplace_back());
        halo.count_sent(1, wishes[k].size());
    }
    for (std::size_t k = 0; k < to.size(); ++k) {
        wishes_of_others[k].resize(to[k].count);
        if (to[k].rank != comm_.rank())
            MPI_Irecv(wishes_of_others[k].data(), static_cast<int>(to[k].count), MPI_BYTE, to[k].rank,
                      tag_of_wishes, comm_.handle(), &requests_.emplace_back());
    }
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);

    shifts_.clear();
    sent_records_.clear();
    outgoing_.resize(to.size());
    for (std::size_t k = 0; k < to.size(); ++k) {
        Outgoing& outgoing = outgoing_[k];
        outgoing.rank = to[k].rank;
        outgoing.sent.clear();
        if (to[k].rank == comm_.rank())
            for (std::size_t other = 0; other < from.size(); ++other)
                if (from[other].rank == comm_.rank()) wishes_of_others[k] = wishes[other];
        auto wish = wishes_of_others[k].begin();
        for (const Halo::SentCell& cell : to[k].cells) {
            if (cell.image.flip != std::array<bool, 3>{})
                throw std::logic_error("mirror images of records are not known");
            const auto known = std::find(shifts_.begin(), shifts_.end(), cell.image.shift);
            const auto shift = static_cast<std::uint32_t>(known - shifts_.begin());
            if (known == shifts_.end()) shifts_.push_back(cell.image.shift);
            for (std::uint32_t i = cell.begin; i < cell.end; ++i)
                if (*wish++) outgoing.sent.push_back({i, shift});
        }
        if (outgoing.rank == comm_.rank()) continue;
        outgoing.buffer.resize(outgoing.sent.size() * refreshed_);
        for (const Sent& sent : outgoing.sent) sent_records_.push_back(sent.record);
    }
    std::ranges::sort(sent_records_);
    sent_records_.erase(std::unique(sent_records_.begin(), sent_records_.end()), sent_records_.end());
}

void RecordHalo::copy(const double* record, const Sent& sent, double* to) const {
    std::copy_n(record, refreshed_, to);
    for (std::size_t a = 0; a < 3; ++a) to[a] += shifts_[sent.shift][a];
}

void RecordHalo::begin(std::span<double> records) {
    requests_.clear();
    for (Incoming& incoming : incoming_)
        if (incoming.rank != comm_.rank() && !incoming.buffer.empty())
            MPI_Irecv(incoming.buffer.data(), static_cast<int>(incoming.buffer.size()), MPI_DOUBLE,
                      incoming.rank, tag_of_records, comm_.handle(), &requests_.emplace_back());
    for (Outgoing& outgoing : outgoing_) {
        if (outgoing.rank == comm_.rank() || outgoing.buffer.empty()) continue;
        double* to = outgoing.buffer.data();
        for (const Sent& sent : outgoing.sent) {
            copy(records.data() + sent.record * width_, sent, to);
            to += refreshed_;
        }
        MPI_Isend(outgoing.buffer.data(), static_cast<int>(outgoing.buffer.size()), MPI_DOUBLE, outgoing.rank,
                  tag_of_records, comm_.handle(), &requests_.emplace_back());
        halo_->count_sent(1, outgoing.buffer.size() * sizeof(double));
    }
}

void RecordHalo::finish(std::span<double> records) {
    for (const Outgoing& outgoing : outgoing_) {
        if (outgoing.rank != comm_.rank()) continue;
        for (const Incoming& incoming : incoming_)
            if (incoming.rank == comm_.rank())
                for (std::size_t k = 0; k < incoming.records.size(); ++k)
                    copy(records.data() + outgoing.sent[k].record * width_, outgoing.sent[k],
                         records.data() + incoming.records[k] * width_);
    }
    MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
    for (const Incoming& incoming : incoming_) {
        if (incoming.rank == comm_.rank()) continue;
        const double* from = incoming.buffer.data();
        for (const std::uint32_t record : incoming.records) {
            std::copy_n(from, refreshed_, records.data() + record * width_);
            from += refreshed_;
        }
    }
}

std::size_t RecordHalo::bytes() const {
    std::size_t bytes = sent_records_.capacity() * sizeof(std::uint32_t);
    for (const Outgoing& outgoing : outgoing_)
        bytes += outgoing.sent.capacity() * sizeof(Sent) + outgoing.buffer.capacity() * sizeof(double);
    for (const Incoming& incoming : incoming_)
        bytes +=
            incoming.records.capacity() * sizeof(std::uint32_t) + incoming.buffer.capacity() * sizeof(double);
    return bytes;
}

}  // namespace talus
