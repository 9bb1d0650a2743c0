#include "messaging/session_scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/encode.hpp"
#include "support/temporary_folder.hpp"
#include "voqcal/sample_t.hpp"

namespace voqcal {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

template <typename Message>
void WriteEvent(const char* channel, const Message& message, LogWriter* log) {
  log->Write({0, message.utime, channel, EncodeMessage(message)});
}

class SessionSceneReaderTest : public ::testing::Test {
 protected:
  void WriteSample(std::int64_t id, bool has_sweep, bool has_image) {
    LogWriter log(log_);
    if (has_sweep) {
      pointcloud2_t sweep{};
      sweep.utime = 10 * id;
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

}  // namespace
}  // namespace voqcal
