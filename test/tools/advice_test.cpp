#include "calibrate/advice.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/camera_detection/camera_board_fault.hpp"
#include "core/lidar_detection/lidar_board_miss.hpp"
#include "core/sampling/sample_picker.hpp"
#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// The reasons of all enumerators, of which `Fault::kAmbiguous` is the last, that have no advice.
template <typename Fault>
std::vector<std::string> ReasonsWithoutAdvice(const std::string& module) {
  std::vector<std::string> reasons;
  for (int i = 0; i <= static_cast<int>(Fault::kAmbiguous); ++i) {
    const std::string reason = ToString(static_cast<Fault>(i));
    if (AdviceOn(module, reason).empty()) reasons.push_back(reason);
  }
  return reasons;
}

TEST(AdviceOn, KnowsEachReasonOfTheDetectors) {
  // Warnings, never the reason of a miss.
  EXPECT_THAT(ReasonsWithoutAdvice<CameraBoardFault>("camera_board_detector"),
              UnorderedElementsAre("too small", "ambiguous"));
  EXPECT_THAT(ReasonsWithoutAdvice<LidarBoardMiss>("lidar_board_detector"), IsEmpty());
}

TEST(AdviceOn, HasNoneForWhatIsNoFailureOrAnothersOne) {
  EXPECT_EQ(AdviceOn("camera_board_detector", "boards"), "");
  EXPECT_EQ(AdviceOn("camera_board_detector", "boards: blurred"), "");
  EXPECT_EQ(AdviceOn("lidar_board_detector", "blurred"), "");
}

// Reasons as the picker gives them: the board is elsewhere in the second frame, and the third has
// no camera frame.
TEST(AdviceOn, KnowsReasonsOfTheSampleCollector) {
  const std::vector<BoardSample> samples = test::SynthesizeSamples({});
  SamplePicker picker(test::TestBoard(), {});
  std::vector<std::string> reasons;
  const auto take = [&reasons](const std::vector<PickerDecision>& decisions) {
    for (const PickerDecision& decision : decisions) reasons.push_back(decision.reason);
  };
  for (int frame = 0; frame < 3; ++frame) {
    const std::int64_t utime = 100000 * frame;
    take(picker.Add(LidarSighting{utime, samples[frame].lidar, {}}));
    if (frame < 2) take(picker.Add(CameraSighting{utime, samples[frame].camera, {}}));
  }
  take(picker.Flush());
  EXPECT_THAT(
      reasons,
      ElementsAre(
          "not yet still for long enough", "board is moving", "no camera frame at that time"));
  EXPECT_EQ(AdviceOn("sample_collector", reasons[0]), "");
  EXPECT_NE(AdviceOn("sample_collector", reasons[1]), "");
  EXPECT_NE(AdviceOn("sample_collector", "sweeps between two images"), "");
}

}  // namespace
}  // namespace voqcal
