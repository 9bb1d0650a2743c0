#include "common/tool_main.hpp"

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace voqcal {
namespace {

/// Ends the program with the status of a tool, given `flags`, whose standard output is on a full
/// disk.
[[noreturn]] void RunOnAFullDisk(std::vector<const char*> flags,
                                 const std::function<void()>& body) {
  if (std::freopen("/dev/full", "w", stdout) == nullptr) std::abort();
  flags.insert(flags.begin(), "printer");
  CLI::App app("Prints.", "printer");
  std::_Exit(RunTool(&app, static_cast<int>(flags.size()), flags.data(), body));
}

const testing::ExitedWithCode kFailed(EXIT_FAILURE);

// glibc writes when its buffer is full, and drops what it could not write: at the end nothing of it
// is left. Its buffers have 4096 bytes, BUFSIZ is 8192.
TEST(RunToolDeathTest, TellsThatOutputWasLostBeforeTheEnd) {
  const std::string line(3 * BUFSIZ, 'x');
  const char error[] = "printer: standard output: cannot be written";
  EXPECT_EXIT(RunOnAFullDisk({}, [&] { std::puts(line.c_str()); }), kFailed, error);
  EXPECT_EXIT(RunOnAFullDisk({}, [&] { std::cout << line << '\n'; }), kFailed, error);
  EXPECT_EXIT(RunOnAFullDisk({"--help"}, [] {}), kFailed, error);
  EXPECT_EXIT(RunOnAFullDisk({"--version"}, [] {}), kFailed, error);
}

TEST(RunTool, TellsAnUnmetDemandFromAFailure) {
  const char* flags[] = {"tool"};
  const auto status_of = [&flags](const std::function<void()>& body) {
    CLI::App app("Does.", "tool");
    return RunTool(&app, 1, flags, body);
  };
  EXPECT_EQ(status_of([] {}), 0);
  EXPECT_EQ(status_of([] { throw std::runtime_error("broken"); }), 1);
  EXPECT_EQ(status_of([] { throw UsageError("no such module"); }), 2);
  EXPECT_EQ(status_of([] { throw DemandNotMet("not good"); }), 3);
}

TEST(RunToolDeathTest, TellsWhyOutputCannotBeWritten) {
  const char error[] = "printer: standard output: cannot be written: No space left on device";
  EXPECT_EXIT(RunOnAFullDisk({}, [] { std::puts("x"); }), kFailed, error);
  EXPECT_EXIT(RunOnAFullDisk({}, [] { std::cout << "x"; }), kFailed, error);
}

}  // namespace
}  // namespace voqcal
