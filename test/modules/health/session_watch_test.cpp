#include "health/session_watch.hpp"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;

constexpr char kLog[] =
    "2026-11-29 12:00:00,101 INFO supervisord started with pid 7\n"
    "2026-11-29 12:00:01,103 INFO spawned: 'assessor' with pid 8\n"
    "2026-11-29 12:00:01,104 INFO spawned: 'lidar_driver' with pid 9\n"
    "2026-11-29 12:00:02,103 INFO success: assessor entered RUNNING state, process has stayed up\n"
    "2026-11-29 12:00:03,103 INFO exited: assessor (terminated by SIGKILL; not expected)\n"
    "2026-11-29 12:00:04,103 INFO spawned: 'assessor' with pid 10\n"
    "2026-11-29 12:00:05,103 INFO exited: lidar_driver (exit status 0; expected)\n"
    "2026-11-29 12:00:06,103 INFO spawned: 'lcm-logger' with pid 11\n"
    "2026-11-29 12:00:06,203 INFO exited: lcm-logger (exit status 1; not expected)\n"
    "2026-11-29 12:00:07,203 INFO gave up: lcm-logger entered FATAL state, too many start "
    "retries\n";

TEST(SupervisorLog, TellsWhatBecameOfEachProgram) {
  const auto programs = ReadSupervisorLog(kLog);
  ASSERT_EQ(programs.size(), 3u);
  const ProgramHistory& assessor = programs.at("assessor");
  EXPECT_TRUE(assessor.is_running);
  EXPECT_EQ(assessor.how_ended, "terminated by SIGKILL");
  EXPECT_EQ(assessor.unexpected_ends.size(), 1u);
  EXPECT_TRUE(programs.at("lidar_driver").has_ended_well);
  EXPECT_FALSE(programs.at("lidar_driver").is_running);
  EXPECT_TRUE(programs.at("lcm-logger").has_given_up);
  EXPECT_EQ(programs.at("lcm-logger").how_ended, "exit status 1");
}

TEST(SupervisorLog, NamesWhatIsToRun) {
  EXPECT_THAT(ProgramsOf("[supervisord]\nuser = x\n[program:assessor]\ncommand = a\n[program:b]\n"),
              ElementsAre("assessor", "b"));
}

TEST(ReadSession, TellsOfASessionThatRuns) {
  const test::TemporaryFolder folder;
  folder.Write("supervisor.conf", "[program:lcm-logger]\n[program:pose_guide]\n");
  folder.Write("supervisord.log", kLog);
  folder.Write("supervisord.pid", std::to_string(getpid()) + "\n");
  folder.Write("lcm-logger.txt", "first\nraw.lcm: No space left on device\n\n");
  folder.Write("raw.lcm", "12345");
  const std::time_t end = ReadSupervisorLog(kLog).at("assessor").unexpected_ends.at(0);
  const SessionFacts facts = ReadSession(folder.path(), end + 5);
  EXPECT_TRUE(facts.is_supervised);
  EXPECT_EQ(facts.supervisor, SupervisorState::kRuns);
  EXPECT_EQ(facts.programs.at("lcm-logger").last_words, "raw.lcm: No space left on device");
  EXPECT_EQ(facts.programs.at("assessor").num_ends_lately, 1);
  EXPECT_EQ(facts.programs.at("assessor").running_s, 4);  // it was started a second later
  EXPECT_EQ(ReadSession(folder.path(), end + 60).programs.at("assessor").num_ends_lately, 0);
  EXPECT_FALSE(facts.programs.at("pose_guide").history.is_running);
  EXPECT_EQ(facts.num_recorded_bytes, 5);
  EXPECT_GT(facts.num_free_bytes, 0);
}

TEST(ReadSession, ASupervisorThatWasKilledLeavesItsNumberBehind) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(ReadSession(folder.path(), 0).is_supervised);
  folder.Write("supervisord.pid", "999999999\n");
  EXPECT_EQ(ReadSession(folder.path(), 0).supervisor, SupervisorState::kDead);
}

TEST(ReadSession, ASupervisorThatIsHaltedOrAZombieDoesNotRun) {
  const test::TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    raise(SIGSTOP);
    _exit(0);
  }
  folder.Write("supervisord.pid", std::to_string(child) + "\n");
  int status = 0;
  waitpid(child, &status, WUNTRACED);
  EXPECT_EQ(ReadSession(folder.path(), 0).supervisor, SupervisorState::kHalted);
  kill(child, SIGKILL);
  siginfo_t ended{};
  waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT);
  EXPECT_EQ(ReadSession(folder.path(), 0).supervisor, SupervisorState::kDead);
  waitpid(child, &status, 0);
}

}  // namespace
}  // namespace voqcal
