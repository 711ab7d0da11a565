#include "comm/sparse_exchange.hpp"

#include <gtest/gtest.h>

#include "domain/random.hpp"

namespace talus {
namespace {

constexpr RandomStream draws{.seed = 3};

/// Bytes that only this sender, receiver and round would send.
std::vector<std::byte> letter(int from, int to, int round, std::size_t length) {
    std::vector<std::byte> bytes(length);
    for (std::size_t k = 0; k < length; ++k)
        bytes[k] = static_cast<std::byte>(from * 101 + to * 37 + round * 11 + static_cast<int>(k));
    return bytes;
}

/// Whether `from` sends to `to` in this round, and how much: the same answer on every rank.
bool sends(int from, int to, int round) {
    return draws.uniform(static_cast<std::uint64_t>(from * 1000 + to), static_cast<std::uint32_t>(round)) <
           0.5;
}
std::size_t length_of(int from, int to, int round) {
    return static_cast<std::size_t>(draws.uniform(static_cast<std::uint64_t>(to * 1000 + from),
                                                  static_cast<std::uint32_t>(round + 5000)) *
                                    300);
}

void one_round(const Communicator& comm, SparseExchange& exchange, int round) {
    std::vector<Parcel> outgoing;
    for (int to = comm.size() - 1; to >= 0; --to)
        if (sends(comm.rank(), to, round))
            outgoing.push_back({to, letter(comm.rank(), to, round, length_of(comm.rank(), to, round))});
    const std::vector<Parcel> incoming = exchange(std::move(outgoing));
    std::size_t next = 0;
    for (int from = 0; from < comm.size(); ++from) {
        if (!sends(from, comm.rank(), round)) continue;
        ASSERT_LT(next, incoming.size()) << "round " << round;
        EXPECT_EQ(incoming[next].rank, from);
        EXPECT_EQ(incoming[next].bytes, letter(from, comm.rank(), round, length_of(from, comm.rank(), round)))
            << "round " << round;
        ++next;
    }
    EXPECT_EQ(next, incoming.size()) << "round " << round;
}

TEST(SparseExchange, DeliversRandomPatternsRoundAfterRound) {
    const Communicator comm(MPI_COMM_WORLD);
    SparseExchange exchange(comm);
    for (int round = 0; round < 200; ++round) one_round(comm, exchange, round);
}

TEST(SparseExchange, RoundsOfDifferentExchangesDoNotMix) {
    const Communicator comm(MPI_COMM_WORLD);
    SparseExchange first(comm), second(comm);
    for (int round = 0; round < 200; ++round) one_round(comm, round % 3 == 0 ? first : second, round);
}

TEST(SparseExchange, RanksThatAreLateGetOnlyTheirRound) {
    const Communicator comm(MPI_COMM_WORLD);
    SparseExchange first(comm), second(comm);
    for (int round = 0; round < 20; ++round) {
        if (round % comm.size() == comm.rank()) {
            const double until = MPI_Wtime() + 0.002;
            while (MPI_Wtime() < until) {
            }
        }
        one_round(comm, round % 2 == 0 ? first : second, round);
    }
}

TEST(SparseExchange, NothingToSend) {
    const Communicator comm(MPI_COMM_WORLD);
    SparseExchange exchange(comm);
    for (int round = 0; round < 10; ++round) EXPECT_TRUE(exchange({}).empty());
}

TEST(SparseExchange, EmptyParcelArrives) {
    const Communicator comm(MPI_COMM_WORLD);
    SparseExchange exchange(comm);
    const int to = (comm.rank() + 1) % comm.size(), from = (comm.rank() + comm.size() - 1) % comm.size();
    std::vector<Parcel> outgoing;
    outgoing.push_back({to, {}});
    const auto incoming = exchange(std::move(outgoing));
    ASSERT_EQ(incoming.size(), 1u);
    EXPECT_EQ(incoming[0].rank, from);
    EXPECT_TRUE(incoming[0].bytes.empty());
}

TEST(SparseExchange, LargeParcelsTravelInPieces) {
    const Communicator comm(MPI_COMM_WORLD);
    SparseExchange exchange(comm, 64);  // bytes
    for (int round = 0; round < 50; ++round) one_round(comm, exchange, round);
}

TEST(Communicator, GathersInOrderOfRank) {
    const Communicator comm(MPI_COMM_WORLD);
    const auto rank = static_cast<std::size_t>(comm.rank());
    const std::vector<std::uint64_t> mine(rank, 10 * rank);  // none on rank 0
    const auto all = comm.all_gather(std::span<const std::uint64_t>(mine));
    std::vector<std::uint64_t> expected;
    for (std::size_t r = 0; r < static_cast<std::size_t>(comm.size()); ++r)
        expected.insert(expected.end(), r, 10 * r);
    EXPECT_EQ(all, expected);
}

TEST(Communicator, Reductions) {
    const Communicator comm(MPI_COMM_WORLD);
    EXPECT_EQ(comm.all_min(5.0 + comm.rank()), 5.0);
    EXPECT_EQ(comm.all_max(5.0 + comm.rank()), 4.0 + comm.size());
    EXPECT_EQ(comm.all_sum(std::int64_t{2}), 2 * comm.size());
    EXPECT_EQ(comm.all_exclusive_sum(3), 3u * static_cast<unsigned>(comm.rank()));
    EXPECT_EQ(comm.all_broadcast(comm.is_root() ? "of the root" : "other"), "of the root");
    EXPECT_EQ(comm.all_broadcast(comm.is_root() ? "" : "other"), "");
}

TEST(Communicator, AgreesOnTheMessageOfTheLowestRank) {
    const Communicator comm(MPI_COMM_WORLD);
    EXPECT_NO_THROW(comm.all_agree(1, ""));
    for (int failing = 0; failing < comm.size(); ++failing) {
        const bool fails = comm.rank() >= failing && (comm.rank() - failing) % 2 == 0;
        const std::string message = fails ? "failure of rank " + std::to_string(comm.rank()) : "";
        try {
            comm.all_agree(40 + comm.rank(), message);
            ADD_FAILURE() << "no error";
        } catch (const AgreedError& error) {
            EXPECT_EQ(error.what(), "failure of rank " + std::to_string(failing));
            EXPECT_EQ(error.exit_code, 40 + failing);
        }
    }
}

}  // namespace
}  // namespace talus
