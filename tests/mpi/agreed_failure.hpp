#pragma once
#include <gtest/gtest.h>

#include <string>

#include "comm/communicator.hpp"

namespace talus::testing {

/// The message of the AgreedError (exit code 3) that `action` throws; checks that every rank gets the same.
template <class Action>
std::string agreed_failure(const Communicator& comm, const Action& action) {
    std::string message = "nothing thrown";
    try {
        action();
    } catch (const AgreedError& failure) {
        message = failure.what();
        EXPECT_EQ(failure.exit_code, 3);
    }
    EXPECT_EQ(message, comm.all_broadcast(message));
    return message;
}

}  // namespace talus::testing
