#include "sample_collector/session_log.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/board/board_sample.hpp"
#include "files/atomic_file.hpp"
#include "files/sha256.hpp"
#include "support/synthetic_samples.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::int64_t> Ids(const SessionLog& session) {
  return IdsOf(SamplesWithout(session.samples(), {}));
}

class SessionLogTest : public ::testing::Test {
 protected:
  /// A session with samples 1, 2, ... `n`.
  void Accept(SessionLog* session, int n) {
    for (int i = 0; i < n; ++i) session->Accept(samples_[static_cast<std::size_t>(i)]);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / kSamplesLogName;
  std::vector<BoardSample> samples_ = test::SynthesizeSamples({});
};

TEST_F(SessionLogTest, ReadsBackExactlyWhatItAccepted) {
  {
    SessionLog session(folder_.path());
    Accept(&session, 3);
  }
  const SessionLog again(folder_.path());
  ASSERT_THAT(Ids(again), ElementsAre(1, 2, 3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.samples()[i].utime, samples_[i].utime);
    EXPECT_EQ(again.samples()[i].lidar.pose.centre_m, samples_[i].lidar.pose.centre_m);
    EXPECT_EQ(again.samples()[i].camera.pose.normal, samples_[i].camera.pose.normal);
    EXPECT_EQ(again.samples()[i].lidar.edge_lengths_m, samples_[i].lidar.edge_lengths_m);
  }
}

TEST_F(SessionLogTest, NeverUsesAnIdAgain) {
  {
    SessionLog session(folder_.path());
    Accept(&session, 2);
    EXPECT_EQ(session.Discard(0), 2);  // the newest
    EXPECT_EQ(session.Accept(samples_[2]), 3);
    EXPECT_EQ(session.Discard(3), 3);
  }
  SessionLog again(folder_.path());
  EXPECT_EQ(again.Accept(samples_[3]), 4);
  again.Reset();
  EXPECT_EQ(again.Accept(samples_[4]), 5);
  EXPECT_THAT(Ids(again), ElementsAre(5));
}

TEST_F(SessionLogTest, CountsEachChangeAsARevision) {
  SessionLog session(folder_.path());
  EXPECT_EQ(session.revision(), 0);
  Accept(&session, 2);
  EXPECT_EQ(session.revision(), 2);
  EXPECT_EQ(session.Discard(7), std::nullopt);
  EXPECT_EQ(session.revision(), 2);  // nothing changed
  session.Discard(1);
  session.Reset();
  EXPECT_EQ(session.revision(), 4);
  EXPECT_EQ(session.Discard(0), std::nullopt);  // there is no newest
}

TEST_F(SessionLogTest, HashIsOfTheFileAndTheSameForTheSameSamples) {
  SessionLog session(folder_.path());
  Accept(&session, 3);
  EXPECT_EQ(session.Sha256(), Sha256OfFile(log_));
  const test::TemporaryFolder other_folder;
  SessionLog other(other_folder.path());
  Accept(&other, 3);
  EXPECT_EQ(other.Sha256(), session.Sha256());
}

TEST_F(SessionLogTest, CutsAHalfWrittenLastEventAndGoesOn) {
  std::string whole;
  std::uintmax_t two_samples = 0;
  {
    SessionLog session(folder_.path());
    Accept(&session, 2);
    two_samples = std::filesystem::file_size(log_);
    session.Accept(samples_[2]);
    whole = ReadWholeFile(log_);
  }
  // Within the sync word, the header, the channel and the data.
  for (const std::size_t num_left : {2, 20, 30, 100}) {
    folder_.Write(kSamplesLogName, whole.substr(0, two_samples + num_left));
    {
      SessionLog session(folder_.path());
      EXPECT_THAT(Ids(session), ElementsAre(1, 2)) << num_left;
      session.Accept(samples_[2]);
    }
    EXPECT_EQ(ReadWholeFile(log_), whole) << num_left;
  }
}

TEST_F(SessionLogTest, KeepsASamplesSceneBeforeIt) {
  const SensorFrame sweep = {11, {1, 2, 3}};
  const SensorFrame image = {12, {4, 5}};
  SessionLog session(folder_.path());
  session.Accept(samples_[0], {&sweep, &image});
  session.Accept(samples_[1], {&sweep, nullptr});  // half a scene is none
  EXPECT_EQ(session.revision(), 2);
  EXPECT_EQ(session.Sha256(), Sha256OfFile(log_));
  LogReader reader(log_);
  std::vector<std::string> events;
  while (const auto event = reader.Next()) {
    events.push_back(std::to_string(event->number) + " " + event->channel);
  }
  EXPECT_THAT(events,
              ElementsAre("0 CALIB_SWEEP", "0 CALIB_IMAGE", "0 CALIB_SAMPLE", "1 CALIB_SAMPLE"));
}

TEST_F(SessionLogTest, CutsASceneWhoseSampleIsMissingAndGoesOn) {
  const SensorFrame sweep = {11, {1, 2, 3}};
  const SensorFrame image = {12, {4, 5}};
  std::uintmax_t one_sample = 0;
  std::string hash;
  std::string whole;
  {
    SessionLog session(folder_.path());
    session.Accept(samples_[0], {&sweep, &image});
    one_sample = std::filesystem::file_size(log_);
    session.Accept(samples_[1], {&sweep, &image});
    hash = session.Sha256();
    whole = ReadWholeFile(log_);
  }
  const std::size_t sweep_bytes = 28 + std::string(kSceneSweepChannel).size() + 3;
  for (const std::size_t num_left : {sweep_bytes, sweep_bytes + 5}) {
    folder_.Write(kSamplesLogName, whole.substr(0, one_sample + num_left));
    SessionLog session(folder_.path());
    EXPECT_THAT(Ids(session), ElementsAre(1)) << num_left;
    EXPECT_EQ(std::filesystem::file_size(log_), one_sample) << num_left;
    session.Accept(samples_[1], {&sweep, &image});
    EXPECT_EQ(ReadWholeFile(log_), whole) << num_left;
    EXPECT_EQ(session.Sha256(), hash) << num_left;
  }
}

TEST_F(SessionLogTest, RefusesAForeignFileAndLeavesItAsItIs) {
  const std::string foreign = "not an LCM log, but somebody's notes of the day";
  folder_.Write(kSamplesLogName, foreign);
  EXPECT_THAT(test::ErrorOf([&] { SessionLog session(folder_.path()); }), HasSubstr(log_.string()));
  EXPECT_EQ(ReadWholeFile(log_), foreign);
}

TEST_F(SessionLogTest, RefusesALogOfOtherChannels) {
  {
    LogWriter writer(log_);
    writer.Write({0, 0, "LIDAR_POINTS", {1, 2, 3}});
  }
  EXPECT_THAT(test::ErrorOf([&] { SessionLog session(folder_.path()); }),
              AllOf(HasSubstr(log_.string()), HasSubstr("channel LIDAR_POINTS")));
}

TEST_F(SessionLogTest, RefusesALogThatAnotherOneWrites) {
  const SessionLog session(folder_.path());
  EXPECT_THAT(test::ErrorOf([&] { SessionLog other(folder_.path()); }),
              AllOf(HasSubstr(log_.string()), HasSubstr("another process")));
}

TEST_F(SessionLogTest, NamesAFolderThatCannotBeMade) {
  const auto in_the_way = folder_.Write("file", "");
  EXPECT_THAT(test::ErrorOf([&] { SessionLog session(in_the_way / "session"); }),
              HasSubstr((in_the_way / "session").string()));
}

}  // namespace
}  // namespace voqcal
