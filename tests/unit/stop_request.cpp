#include "src/run/stop_request.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

// An hour of wall time, of which the test takes none: what is kept for the last steps and the last checkpoint
// follows from what they are known to take, without a limit.
TEST(StopRequest, KeepsTimeForThreeStepsAndTwiceACheckpoint) {
    const Communicator comm = world();
    StopRequest stop(comm, "no such folder", 3600);
    EXPECT_EQ(stop.reason(0, 0), "");
    EXPECT_EQ(stop.reason(100, 1500), "");
    EXPECT_EQ(stop.reason(100, 1651), "the wall time is running out");
    EXPECT_EQ(stop.reason(1201, 0), "the wall time is running out");
}

}  // namespace
}  // namespace talus
