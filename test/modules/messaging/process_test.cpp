#include "messaging/process.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "support/sanitizers.hpp"

namespace voqcal {
namespace {

using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
  bool has_run = false;
  ProcessArgs args;
};

/// RunProcess of "detector" with these flags; `cause` is what its body throws, if not empty.
Outcome RunWith(std::vector<const char*> flags, const std::string& cause = "") {
  flags.insert(flags.begin(), "/somewhere/detector");
  Outcome run;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  run.status = RunProcess(static_cast<int>(flags.size()),
                          flags.data(),
                          {"detector", "Finds things."},
                          [&](const ProcessArgs& args) {
                            run.has_run = true;
                            run.args = args;
                            if (!cause.empty()) throw std::runtime_error(cause);
                          });
  run.out = testing::internal::GetCapturedStdout();
  run.err = testing::internal::GetCapturedStderr();
  return run;
}

TEST(RunProcess, HandsOverTheFlags) {
  const Outcome run = RunWith({"--rig", "a.yaml", "--lcm-url", "memq://", "--session", "s"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.args.rig_path, "a.yaml");
  EXPECT_EQ(run.args.lcm_url, "memq://");
  EXPECT_EQ(run.args.session_dir, "s");
  EXPECT_FALSE(run.args.is_verbose);
}

TEST(RunProcess, LeavesOptionalFlagsOut) {
  const Outcome run = RunWith({"--rig", "a.yaml", "--verbose"});
  EXPECT_FALSE(run.args.lcm_url);
  EXPECT_FALSE(run.args.session_dir);
  EXPECT_TRUE(run.args.is_verbose);
}

TEST(RunProcess, AnswersAnExceptionWithStatus1AndItsNameOnEachLine) {
  const Outcome run = RunWith({"--rig", "a.yaml"}, "a.yaml:3: board\r\n\na.yaml:5: camera\n");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.err, "detector: a.yaml:3: board\ndetector: a.yaml:5: camera\n");
}

TEST(RunProcess, SaysThatItFailedEvenWithoutAReason) {
  const Outcome run = RunWith({"--rig", "a.yaml"}, " \n");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.err, "detector: failed, without a reason\n");
}

TEST(RunProcess, AnswersWrongFlagsWithStatus2) {
  for (const auto& flags : std::vector<std::vector<const char*>>{
           {}, {"--rig"}, {"--rig", "a.yaml", "--speed", "9"}, {"--rig", "a.yaml", "b.yaml"}}) {
    const Outcome run = RunWith(flags);
    EXPECT_EQ(run.status, 2);
    EXPECT_FALSE(run.has_run);
    EXPECT_THAT(run.err, HasSubstr("detector: "));
  }
}

TEST(RunProcess, ExplainsItself) {
  const Outcome help = RunWith({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_FALSE(help.has_run);
  EXPECT_THAT(help.out, HasSubstr("Finds things."));
  EXPECT_THAT(help.out, HasSubstr("--rig FILE"));
  const Outcome version = RunWith({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, testing::StartsWith("0."));
}

/// What the kernel has given this process so far.
long NumPages() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

TEST(RunProcess, KeepsFreedMemoryForWhatComesNext) {
  VOQCAL_LEAVE_TO_RELEASE();  // a sanitizer's malloc is its own
  const auto take_and_free = [] {
    const std::vector<std::vector<char>> frames(4, std::vector<char>(8U << 20U, 1));
    EXPECT_EQ(frames.back().back(), 1);
  };
  RunWith({"--rig", "a.yaml"});
  take_and_free();
  const long before = NumPages();
  for (int i = 0; i < 10; ++i) take_and_free();
  EXPECT_LT(NumPages() - before, 2048);  // pages of 4 kB in one frame; there were 40
}

}  // namespace
}  // namespace voqcal
