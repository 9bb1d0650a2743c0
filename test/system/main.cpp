// Runs the tests in a network namespace of their own, so that two of them side by side do not hear
// each other, nor a user's live LCM traffic.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <unistd.h>

namespace {

constexpr char kIsIsolated[] = "VOQCAL_TEST_IS_ISOLATED";
constexpr char kIsolated[] = VOQCAL_SOURCE_DIR "/tools/isolated";

[[noreturn]] void StartAgainIsolated(char** argv) {
  setenv(kIsIsolated, "1", 1);
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<const char*> args = {kIsolated, self.c_str()};
  while (*++argv != nullptr) args.push_back(*argv);
  args.push_back(nullptr);
  execv(kIsolated, const_cast<char* const*>(args.data()));
  std::perror(kIsolated);
  std::exit(EXIT_FAILURE);
}

}  // namespace

int main(int argc, char** argv) {
  // The build lists the tests, where there may be no right to make a namespace.
  bool is_listing = false;
  for (int i = 1; i < argc; ++i) is_listing |= std::string_view(argv[i]) == "--gtest_list_tests";
  if (!is_listing && std::getenv(kIsIsolated) == nullptr) StartAgainIsolated(argv);
  setenv("VOQCAL_BIN", VOQCAL_TEST_BIN, 1);  // for the launch scripts and tools/run_rig
  ::testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
