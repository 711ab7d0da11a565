#pragma once
#include <mpi.h>

#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace talus {

/// A failure that every rank knows of and throws together; `exit_code` is what the program returns.
class AgreedError : public std::runtime_error {
  public:
    AgreedError(int exit_code_, const std::string& message)
        : std::runtime_error(message), exit_code(exit_code_) {}
    int exit_code;
};

template <class T>
MPI_Datatype mpi_type() {
    if constexpr (std::is_same_v<T, double>) return MPI_DOUBLE;
    if constexpr (std::is_same_v<T, float>) return MPI_FLOAT;
    if constexpr (std::is_same_v<T, std::int32_t>) return MPI_INT32_T;
    if constexpr (std::is_same_v<T, std::int64_t>) return MPI_INT64_T;
    if constexpr (std::is_same_v<T, std::uint32_t>) return MPI_UINT32_T;
    if constexpr (std::is_same_v<T, std::uint64_t>) return MPI_UINT64_T;
    if constexpr (std::is_same_v<T, std::uint8_t>) return MPI_UINT8_T;
    if constexpr (std::is_same_v<T, std::byte>) return MPI_BYTE;
    if constexpr (std::is_same_v<T, char>) return MPI_CHAR;
}

/// Owns a duplicate of an MPI communicator. Every method with an `all_` name is collective.
class Communicator {
  public:
    explicit Communicator(MPI_Comm parent);  ///< duplicates `parent`
    ~Communicator();
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;

    MPI_Comm handle() const { return handle_; }
    int rank() const { return rank_; }
    int size() const { return size_; }
    bool is_root() const { return rank_ == 0; }

    /// Element-wise reductions over ranks, in place. Sums are offered for integers only: floating-point
    /// sums that must not depend on the number of ranks go through ExactSum.
    template <class T>
    void all_min(std::span<T> values) const {
        reduce(values, MPI_MIN);
    }
    template <class T>
    void all_max(std::span<T> values) const {
        reduce(values, MPI_MAX);
    }
    template <class T>
    void all_sum(std::span<T> values) const {
        static_assert(std::is_integral_v<T>, "floating-point sums go through ExactSum");
        reduce(values, MPI_SUM);
    }
    template <class T>
    T all_min(T value) const {
        all_min(std::span<T>(&value, 1));
        return value;
    }
    template <class T>
    T all_max(T value) const {
        all_max(std::span<T>(&value, 1));
        return value;
    }
    template <class T>
    T all_sum(T value) const {
        all_sum(std::span<T>(&value, 1));
        return value;
    }

    /// A sum over ranks under way. `values` hold it once finish() has returned.
    class PendingSum {
      public:
        explicit PendingSum(MPI_Request request) : request_(request) {}
        PendingSum(const PendingSum&) = delete;
        PendingSum& operator=(const PendingSum&) = delete;
        ~PendingSum() { finish(); }
        void finish() { MPI_Wait(&request_, MPI_STATUS_IGNORE); }

      private:
        MPI_Request request_;
    };
    /// Starts an element-wise sum in place; `values` must outlive what it returns. Other messages may pass
    /// meanwhile.
    [[nodiscard]] PendingSum all_sum_later(std::span<std::uint64_t> values) const {
        MPI_Request request;
        MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_UINT64_T, MPI_SUM,
                       handle_, &request);
        return PendingSum(request);
    }

    /// Sum over the ranks before this one (0 on rank 0).
    std::uint64_t all_exclusive_sum(std::uint64_t value) const;

    /// Concatenation of every rank's values, in order of rank, on every rank.
    template <class T>
    std::vector<T> all_gather(std::span<const T> values) const {
        const auto bytes = static_cast<std::int64_t>(values.size_bytes());
        const auto ranks = static_cast<std::size_t>(size_);
        std::vector<std::int64_t> all_bytes(ranks);
        MPI_Allgather(&bytes, 1, MPI_INT64_T, all_bytes.data(), 1, MPI_INT64_T, handle_);
        std::vector<int> counts(ranks), starts(ranks);
        std::int64_t total = 0;
        for (std::size_t r = 0; r < ranks; ++r) {
            starts[r] = static_cast<int>(total);
            counts[r] = static_cast<int>(all_bytes[r]);
            total += all_bytes[r];
        }
        if (total > std::numeric_limits<int>::max())  // the same on every rank
            throw std::length_error("more than 2 GiB gathered on every rank");
        std::vector<T> all(static_cast<std::size_t>(total) / sizeof(T));
        MPI_Allgatherv(values.data(), static_cast<int>(bytes), MPI_BYTE, all.data(), counts.data(),
                       starts.data(), MPI_BYTE, handle_);
        return all;
    }

    /// The root's string on every rank.
    std::string all_broadcast(std::string text) const;

    /// Throws the same AgreedError on every rank if any rank passes a message: that of the lowest such rank.
    void all_agree(int exit_code, const std::string& message) const;

    void all_barrier() const { MPI_Barrier(handle_); }

    /// A tag for one round of messages whose receivers do not know who will send. Two rounds in a row never
    /// share it, whoever asks: a fast rank may be in the next one already. Every rank asks in the same order.
    int next_round_tag() const {
        constexpr int first_tag = 100;
        round_ = 1 - round_;
        return first_tag + round_;
    }

  private:
    template <class T>
    void reduce(std::span<T> values, MPI_Op op) const {
        MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), mpi_type<T>(), op,
                      handle_);
    }

    MPI_Comm handle_ = MPI_COMM_NULL;
    int rank_ = 0;
    int size_ = 1;
    mutable int round_ = 0;
};

/// All ranks of the program.
Communicator world();

}  // namespace talus
