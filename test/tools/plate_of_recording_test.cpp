#include "calibrate/plate_of_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/matchers.hpp"
#include "support/sanitizers.hpp"
#include "support/simulated_log.hpp"
#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// Which edge is the width is told by the samples: the board's longer one is its height.
TEST(MeasurePlate, PutsWhatItMeasuresIntoTheRig) {
  VOQCAL_LEAVE_TO_RELEASE();
  const test::TemporaryFolder folder;
  Rig rig = test::TinySimulatedRig();
  rig.simulation.num_poses = 6;
  const std::filesystem::path log = folder.path() / "stops.lcm";
  test::WriteStopsLog(rig, log);
  Rig measured = rig;
  measured.board.width_m = rig.board.LeastPlateM().x();
  measured.board.height_m = rig.board.LeastPlateM().y();
  MeasurePlate({log, {}, RecordingTimes::kAuto}, folder.path(), &measured);
  // Three sigma: beams spill past each of two sides by what is known to 4 mm.
  EXPECT_NEAR(measured.board.width_m, rig.board.width_m, 0.024);
  EXPECT_NEAR(measured.board.height_m, rig.board.height_m, 0.024);
}

TEST(MeasurePlate, SaysWhatToDoWhereItCannot) {
  const test::TemporaryFolder folder;
  Rig rig = test::TinySimulatedRig();
  rig.path = "rig.yaml";
  const std::filesystem::path log = folder.path() / "empty.lcm";
  { LogWriter writer(log); }
  EXPECT_THAT(test::ErrorOf([&] {
                MeasurePlate({log, {}, RecordingTimes::kAuto}, folder.path(), &rig);
              }),
              AllOf(HasSubstr("rig.yaml: board.width_m and board.height_m are missing"),
                    HasSubstr(log.string()),
                    HasSubstr("ruler")));
  EXPECT_THAT(test::ErrorOf([&] {
                MeasurePlate({{}, "poses.csv", RecordingTimes::kAuto}, folder.path(), &rig);
              }),
              HasSubstr("poses.csv has no sweeps"));
}

}  // namespace
}  // namespace voqcal
