#include "core/selection/offset_sign.hpp"

#include <cmath>

#include "core/board/what_was_measured.hpp"
#include "core/format.hpp"
#include "core/median.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kLeastSamples = 4;
constexpr double kLeastOffsetM = 0.005;       // smaller ones drown in the lidar's errors
constexpr double kLeastDisagreementM = 0.01;  // less needs no explanation
constexpr double kMaxShare = 0.5;             // of the disagreement, that the other sign may leave

// Where the camera would see the board's centre if the offsets' signs were other ones.
Eigen::Vector3d CentreWithSigns(const BoardPose& pose_camera,
                                const BoardSpec& board,
                                bool is_x_wrong,
                                bool is_y_wrong) {
  const Eigen::Isometry3d T_camera_board = TransformFromPose(pose_camera);
  const Eigen::Vector3d centre_board_m(is_x_wrong ? 2 * board.pattern_offset_x_m : 0.0,
                                       is_y_wrong ? 2 * board.pattern_offset_y_m : 0.0,
                                       0.0);
  return T_camera_board * centre_board_m;
}

// By how much the distances of two boards differ between the sensors, median of all pairs.
double DisagreementM(const std::vector<const BoardSample*>& samples,
                     const BoardSpec& board,
                     bool is_x_wrong,
                     bool is_y_wrong) {
  std::vector<Eigen::Vector3d> centres_camera_m;
  for (const BoardSample* sample : samples) {
    centres_camera_m.push_back(CentreWithSigns(sample->camera.pose, board, is_x_wrong, is_y_wrong));
  }
  std::vector<double> differences_m;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size(); ++j) {
      const double by_lidar_m =
          (samples[i]->lidar.pose.centre_m - samples[j]->lidar.pose.centre_m).norm();
      const double by_camera_m = (centres_camera_m[i] - centres_camera_m[j]).norm();
      differences_m.push_back(std::abs(by_lidar_m - by_camera_m));
    }
  }
  return Median(std::move(differences_m));
}

std::string ShouldBe(const char* key, double offset_m) {
  return Format("board.%s %g should be %g", key, offset_m, -offset_m);
}

}  // namespace

std::string WrongOffsetSign(const std::vector<BoardSample>& samples, const BoardSpec& board) {
  std::vector<const BoardSample*> measured;
  for (const BoardSample& sample : samples) {
    if (IsCentreMeasured(sample.lidar)) measured.push_back(&sample);
  }
  if (measured.size() < kLeastSamples) return {};
  const bool has_x = std::abs(board.pattern_offset_x_m) >= kLeastOffsetM;
  const bool has_y = std::abs(board.pattern_offset_y_m) >= kLeastOffsetM;
  const double as_is_m = DisagreementM(measured, board, false, false);
  double least_m = kMaxShare * as_is_m;
  std::string text;
  const auto consider = [&](bool is_x_wrong, bool is_y_wrong, const std::string& should_be) {
    const double other_m = DisagreementM(measured, board, is_x_wrong, is_y_wrong);
    if (as_is_m < kLeastDisagreementM || !(other_m < least_m)) return;
    least_m = other_m;
    text = should_be + Format(
                           ": the distances between two boards then agree between the sensors "
                           "within %.0f mm (median), as it is within %.0f mm",
                           1e3 * other_m,
                           1e3 * as_is_m);
  };
  const std::string x = ShouldBe("pattern_offset_x_m", board.pattern_offset_x_m);
  const std::string y = ShouldBe("pattern_offset_y_m", board.pattern_offset_y_m);
  if (has_x) consider(true, false, x);
  if (has_y) consider(false, true, y);
  if (has_x && has_y) consider(true, true, x + ", and " + y);
  return text;
}

}  // namespace voqcal
