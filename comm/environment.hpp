#pragma once

namespace talus {

/// Starts MPI on construction and ends it on destruction; one in a program, in main(). abort() ends all
/// ranks at once, for failures that the other ranks cannot know of.
class Environment {
  public:
    Environment(int& argc, char**& argv);
    ~Environment();
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

    [[noreturn]] static void abort(int exit_code);
    /// Ends this rank without a word to MPI, whose end would call libraries that are broken by now.
    [[noreturn]] static void leave(int exit_code);
};

}  // namespace talus
