#pragma once
#include <exception>
#include <string>

#include "comm/communicator.hpp"

namespace talus {

/// Exit code of the program when input or output failed.
inline constexpr int exit_input_output = 3;

/// Runs `action` on every rank; if it throws on any, throws the same AgreedError on all. Collective, but
/// `action` must not be. Follow every local step that can fail by this before the next collective one.
template <class Action>
void agree_on(const Communicator& comm, const Action& action) {
    std::string failure;
    try {
        action();
    } catch (const std::exception& caught) {
        failure = caught.what();
        if (failure.empty()) failure = "unknown failure";
    }
    comm.all_agree(exit_input_output, failure);
}

/// Runs `action` on the root alone; if it throws there, throws the same AgreedError on all ranks. Collective.
template <class Action>
void agree_on_root(const Communicator& comm, const Action& action) {
    agree_on(comm, [&] {
        if (comm.is_root()) action();
    });
}

}  // namespace talus
