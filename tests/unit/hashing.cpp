#include "io/hashing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "io/id_order.hpp"
#include "io/particle_file.hpp"
#include "io/progress.hpp"

namespace talus {
namespace {

TEST(Hashing, IsXxh64) {
    EXPECT_EQ(hash64(std::string_view()), 0xef46db3751d8e999U);  // published test value
    EXPECT_NE(hash64("a"), hash64("a", 1));
    Hasher64 pieces(7);
    pieces.add(std::as_bytes(std::span<const char>("ab", 2)));
    pieces.add(std::as_bytes(std::span<const char>("c", 1)));
    EXPECT_EQ(pieces.value(), hash64("abc", 7));
}

TEST(Hashing, SignedZerosAndOrderOfValuesDiffer) {
    Hasher64 a, b, c, d;
    a.add(0.0);
    b.add(-0.0);
    EXPECT_NE(a.value(), b.value());
    c.add(std::string_view("ab"));
    c.add(std::string_view("c"));
    d.add(std::string_view("a"));
    d.add(std::string_view("bc"));
    EXPECT_NE(c.value(), d.value());
}

TEST(Hashing, BlocksDoNotDependOnTheShares) {
    const std::uint64_t total = 5 * rows_per_block + 100;
    std::vector<std::uint64_t> values(total);
    for (std::uint64_t k = 0; k < total; ++k) values[k] = k * k;
    const std::uint64_t expected = combined_hash(block_hashes(std::as_bytes(std::span(values)), 8));
    for (const int ranks : {1, 2, 3, 5, 9}) {
        std::vector<std::uint64_t> hashes;
        std::uint64_t next = 0;
        for (int rank = 0; rank < ranks; ++rank) {
            const RowRange rows = rows_of_rank(total, rank, ranks);
            EXPECT_EQ(rows.begin, next);
            next = rows.end;
            const auto mine =
                block_hashes(std::as_bytes(std::span(values).subspan(rows.begin, rows.count())), 8);
            hashes.insert(hashes.end(), mine.begin(), mine.end());
        }
        EXPECT_EQ(next, total);
        EXPECT_EQ(combined_hash(hashes), expected) << ranks;
    }
}

TEST(Progress, WritesTimes) {
    EXPECT_EQ(hours_minutes_seconds(3723.4), "1:02:03");
    EXPECT_EQ(hours_minutes_seconds(59.6), "0:01:00");
    EXPECT_GT(peak_memory(), 1000000U);
}

TEST(Progress, PrintsLinesToAFile) {
    std::FILE* out = std::tmpfile();
    ASSERT_NE(out, nullptr);
    {
        Progress progress(true, {.end_time = 1e-3, .last_step = 1000}, 0, out);
        for (std::uint64_t step = 0; step <= 2; ++step)
            progress.update(step, 1e-5 * static_cast<double>(step), 1e-5, 500);
    }
    std::rewind(out);
    char text[1000] = {};
    const std::size_t size = std::fread(text, 1, sizeof text - 1, out);
    std::fclose(out);
    const std::string lines(text, size);
    EXPECT_TRUE(lines.starts_with("step 1  time 1e-05 s  dt 1e-05 s  ")) << lines;
    EXPECT_NE(lines.find("\nstep 2  time 2e-05 s"), std::string::npos) << lines;
    EXPECT_NE(lines.find(" left\n"), std::string::npos) << lines;
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 2);
}

}  // namespace
}  // namespace talus
