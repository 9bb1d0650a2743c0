#include "messaging/session_scenes.hpp"

#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/encode.hpp"
#include "support/temporary_folder.hpp"
#include "support/with_helpers.hpp"
#include "voqcal/sample_t.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StrEq;
using ::testing::UnorderedElementsAre;
using ::testing::UnorderedElementsAreArray;

template <typename Message>
void WriteEvent(const char* channel, const Message& message, LogWriter* log) {
  log->Write({0, message.utime, channel, EncodeMessage(message)});
}

class SessionSceneReaderTest : public ::testing::Test {
 protected:
  void WriteSample(std::int64_t id, bool has_sweep, bool has_image, const char* frame_id = "") {
    LogWriter log(log_);
    if (has_sweep) {
      pointcloud2_t sweep{};
      sweep.utime = 10 * id;
      sweep.frame_id = frame_id;
      WriteEvent(kSceneSweepChannel, sweep, &log);
    }
    if (has_image) {
      image_t image{};
      image.utime = 10 * id + 1;
      WriteEvent(kSceneImageChannel, image, &log);
    }
    sample_t sample{};
    sample.id = id;
    WriteEvent(kSampleChannel, sample, &log);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / kSamplesLogName;
};

TEST_F(SessionSceneReaderTest, ReadsEachScenesMessagesAndPassesOverSamplesWithoutOne) {
  WriteSample(1, true, true);
  WriteSample(2, false, false);
  WriteSample(3, true, false);
  WriteSample(5, true, true);
  SessionSceneReader reader(log_);
  for (const std::int64_t id : {1, 5}) {
    const auto scene = reader.Next();
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->sample_id, id);
    EXPECT_EQ(scene->sweep.utime, 10 * id);
    EXPECT_EQ(scene->image.utime, 10 * id + 1);
  }
  EXPECT_FALSE(reader.Next());
}

TEST_F(SessionSceneReaderTest, EndsBeforeAnEventThatIsBeingWritten) {
  WriteSample(1, true, true);
  WriteSample(2, true, true);
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) - 3);
  SessionSceneReader reader(log_);
  EXPECT_TRUE(reader.Next());
  EXPECT_FALSE(reader.Next());
}

TEST_F(SessionSceneReaderTest, NamesFileAndEventOfADamagedMessage) {
  LogWriter(log_).Write({7, 0, kSceneSweepChannel, {1, 2, 3}});
  WriteSample(1, false, true);
  SessionSceneReader reader(log_);
  EXPECT_THAT(test::ErrorOf([&] { reader.Next(); }),
              AllOf(HasSubstr(log_.string()), HasSubstr("event 7 (CALIB_SWEEP)")));
}

class ForEachSceneTest : public SessionSceneReaderTest {
 protected:
  /// Ids of the scenes that were worked on, in whatever order.
  template <typename IsWanted>
  std::vector<std::int64_t> IdsOf(const IsWanted& is_wanted) {
    std::mutex adding;
    ForEachScene(log_, is_wanted, [&](const SessionScene& scene) {
      const std::lock_guard<std::mutex> lock(adding);
      ids_.push_back(scene.sample_id);
    });
    return ids_;
  }
  static bool IsAnyWanted(const SessionScene& /*scene*/) { return true; }

  std::vector<std::int64_t> ids_;
};

TEST_F(ForEachSceneTest, WorksOnceOnEachThatIsWanted) {
  const test::WithHelpers helpers(3);
  constexpr std::int64_t kNumSamples = 20;
  std::vector<std::int64_t> wanted;
  for (std::int64_t id = 1; id <= kNumSamples; ++id) {
    WriteSample(id, true, true);
    if (id % 3 != 0) wanted.push_back(id);
  }
  EXPECT_THAT(IdsOf([](const SessionScene& scene) { return scene.sample_id % 3 != 0; }),
              UnorderedElementsAreArray(wanted));
}

TEST_F(ForEachSceneTest, TakesTheFirstOfScenesOfTheSameSampleAndTime) {
  for (const char* frame_id : {"first", "second", "third"}) {
    for (const std::int64_t id : {1, 2}) WriteSample(id, true, true, frame_id);
  }
  std::mutex adding;
  std::vector<std::string> worked_on;
  ForEachScene(log_, IsAnyWanted, [&](const SessionScene& scene) {
    const std::lock_guard<std::mutex> lock(adding);
    worked_on.push_back(scene.sweep.frame_id);
  });
  EXPECT_THAT(worked_on, ElementsAre("first", "first"));
}

TEST_F(ForEachSceneTest, DoesWhatIsBeforeDamageAndThenThrows) {
  for (const std::int64_t id : {1, 2, 3}) WriteSample(id, true, true);
  LogWriter(log_).Write({7, 0, kSceneSweepChannel, {1, 2, 3}});
  WriteSample(4, false, true);
  EXPECT_THAT(test::ErrorOf([&] { IdsOf(IsAnyWanted); }), HasSubstr("event 7 (CALIB_SWEEP)"));
  EXPECT_THAT(ids_, UnorderedElementsAre(1, 2, 3));
}

TEST_F(ForEachSceneTest, ThrowsWhatTheWorkThrows) {
  for (const std::int64_t id : {1, 2, 3}) WriteSample(id, true, true);
  const auto fail = [](const SessionScene& scene) {
    if (scene.sample_id == 2) throw std::runtime_error("scene 2");
  };
  EXPECT_THAT(test::ErrorOf([&] { ForEachScene(log_, IsAnyWanted, fail); }), StrEq("scene 2"));
}

}  // namespace
}  // namespace voqcal
