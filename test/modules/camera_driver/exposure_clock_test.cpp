#include "camera_driver/exposure_clock.hpp"

#include <cstdint>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::StartsWith;

constexpr std::int64_t kNow = 1'700'000'000'000'000;
constexpr std::int64_t kExposureUs = 8000;

/// A frame that came `after_us` after kNow.
ExposureClock::Frame At(std::int64_t camera_us, std::int64_t after_us) {
  return {camera_us, {kNow + after_us, after_us}, kExposureUs};
}

TEST(ExposureClock, AddsHalfTheExposureToAClockThatAgreesWithTheHosts) {
  ExposureClock clock;
  EXPECT_EQ(clock.UtimeOf(At(kNow, 12'000)), kNow + 4000);
  // However late it comes.
  EXPECT_EQ(clock.UtimeOf(At(kNow + 100'000, 5'000'000)), kNow + 104'000);
  EXPECT_THAT(clock.Words(), StartsWith("the camera's clock"));
}

TEST(ExposureClock, TakesArrivalsWhereTheCameraCountsFromItsOwnStart) {
  ExposureClock clock;
  // Exposed from 0 to 8 ms, here at 8 ms.
  EXPECT_EQ(clock.UtimeOf(At(5'000'000, 8000)), kNow + 4000);
  // 100 ms later, 30 ms late on its way: but for 100 us a second, by which clocks may drift.
  EXPECT_EQ(clock.UtimeOf(At(5'100'000, 138'000)), kNow + 104'000 + 13);
  EXPECT_THAT(clock.Words(), StartsWith("this host's at a frame's arrival"));
}

TEST(ExposureClock, TakesTheArrivalItselfWhereTheCameraHasNoClock) {
  ExposureClock clock;
  EXPECT_EQ(clock.UtimeOf(At(0, 8000)), kNow + 4000);
  EXPECT_EQ(clock.UtimeOf(At(0, 138'000)), kNow + 134'000);
}

}  // namespace
}  // namespace voqcal
