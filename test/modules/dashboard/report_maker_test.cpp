#include "dashboard/report_maker.hpp"

#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

class ReportMakerTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(mkfifo(pipe_.c_str(), 0600), 0); }

  /// Runs `script`, which opens the pipe, and ends it; waits for ever if a process keeps the pipe.
  void StartAndEnd(const std::string& script) {
    const std::string text = folder_.Write("make_report.sh", script);
    auto maker = std::make_unique<ReportMaker>(
        std::vector<std::string>{"/bin/sh", text, pipe_}, folder_.path() / "said.txt", kPatience);
    ASSERT_TRUE(maker->Start());
    std::ifstream pipe(pipe_);
    std::string line;
    std::getline(pipe, line);
    EXPECT_EQ(line, "at work");
    EXPECT_TRUE(maker->IsAtWork());
    maker.reset();
    EXPECT_FALSE(std::getline(pipe, line));
  }

  static constexpr std::chrono::milliseconds kPatience{100};
  test::TemporaryFolder folder_;
  std::string pipe_ = folder_.path() / "pipe";
};

TEST_F(ReportMakerTest, EndsWhatItsProgramStarted) {
  StartAndEnd("(trap '' TERM; echo 'at work'; exec sleep 1000) > \"$1\" & wait");
}

TEST_F(ReportMakerTest, KillsWhatDoesNotEnd) {
  StartAndEnd("trap '' TERM; exec > \"$1\"; echo 'at work'; sleep 1000; sleep 1000");
}

TEST_F(ReportMakerTest, SaysThatThereIsNoSuchProgram) {
  ReportMaker maker({folder_.path() / "missing"}, folder_.path() / "said.txt");
  EXPECT_FALSE(maker.Start());
  EXPECT_FALSE(maker.IsAtWork());
}

}  // namespace
}  // namespace voqcal
