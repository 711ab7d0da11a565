#include "comm/communicator.hpp"

namespace talus {

Communicator::Communicator(MPI_Comm parent) {
    MPI_Comm_dup(parent, &handle_);
    MPI_Comm_rank(handle_, &rank_);
    MPI_Comm_size(handle_, &size_);
}

Communicator::~Communicator() { MPI_Comm_free(&handle_); }

std::uint64_t Communicator::all_exclusive_sum(std::uint64_t value) const {
    std::uint64_t before = 0;
    MPI_Exscan(&value, &before, 1, MPI_UINT64_T, MPI_SUM, handle_);
    return rank_ == 0 ? 0 : before;
}

std::string Communicator::all_broadcast(std::string text) const {
    std::uint64_t length = text.size();
    MPI_Bcast(&length, 1, MPI_UINT64_T, 0, handle_);
    text.resize(length);
    MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, 0, handle_);
    return text;
}

void Communicator::all_agree(int exit_code, const std::string& message) const {
    int first = message.empty() ? size_ : rank_;
    first = all_min(first);
    if (first == size_) return;
    std::string agreed = message;
    std::uint64_t length = agreed.size();
    MPI_Bcast(&length, 1, MPI_UINT64_T, first, handle_);
    agreed.resize(length);
    MPI_Bcast(agreed.data(), static_cast<int>(length), MPI_CHAR, first, handle_);
    MPI_Bcast(&exit_code, 1, MPI_INT, first, handle_);
    throw AgreedError(exit_code, agreed);
}

Communicator world() { return Communicator(MPI_COMM_WORLD); }

}  // namespace talus
