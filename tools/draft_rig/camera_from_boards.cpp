#include "draft_rig/camera_from_boards.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <opencv2/calib3d.hpp>

#include "core/camera_detection/calibration_target.hpp"
#include "core/format.hpp"

namespace voqcal {
namespace {

// Corners of each board, on it and in its image.
struct Views {
  std::vector<std::vector<cv::Point3f>> corners_board_m;
  std::vector<std::vector<cv::Point2f>> corners_px;
};

struct Fit {
  CameraModel camera;
  double rms_px = 0.0;
  double sigma_fx_px = 0.0;
  std::vector<double> view_rms_px;  // by view
};

CameraModel CameraOf(LensModel lens, const cv::Size& size, const cv::Mat& K, const cv::Mat& D) {
  CameraModel camera;
  camera.lens = lens;
  camera.width_px = size.width;
  camera.height_px = size.height;
  camera.fx_px = K.at<double>(0, 0);
  camera.fy_px = K.at<double>(1, 1);
  camera.cx_px = K.at<double>(0, 2);
  camera.cy_px = K.at<double>(1, 2);
  for (int i = 0; i < NumDistortion(lens); ++i) {
    camera.distortion[static_cast<std::size_t>(i)] = D.at<double>(i);
  }
  return camera;
}

// Two radial coefficients: tangential ones and a third are worth less than they cost a dozen views.
Fit FitPlumbBob(const Views& views, const cv::Size& size) {
  cv::Mat K;
  cv::Mat D;
  cv::Mat sigmas;
  cv::Mat view_rms;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  Fit fit;
  fit.rms_px = cv::calibrateCamera(views.corners_board_m,
                                   views.corners_px,
                                   size,
                                   K,
                                   D,
                                   rotations,
                                   translations,
                                   sigmas,
                                   cv::noArray(),
                                   view_rms,
                                   cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K3);
  fit.camera = CameraOf(LensModel::kPlumbBob, size, K, D);
  fit.sigma_fx_px = sigmas.at<double>(0);
  fit.view_rms_px.assign(view_rms.begin<double>(), view_rms.end<double>());
  return fit;
}

// From the other fit's focal length on.
std::optional<Fit> FitEquidistant(const Views& views, const cv::Size& size, const Fit& start) try {
  cv::Mat K = (cv::Mat_<double>(3, 3) << start.camera.fx_px,
               0,
               start.camera.cx_px,
               0,
               start.camera.fy_px,
               start.camera.cy_px,
               0,
               0,
               1);
  cv::Mat D = cv::Mat::zeros(4, 1, CV_64F);
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  Fit fit;  // OpenCV does not say how well it knows the focal length
  fit.rms_px = cv::fisheye::calibrate(views.corners_board_m,
                                      views.corners_px,
                                      size,
                                      K,
                                      D,
                                      rotations,
                                      translations,
                                      cv::fisheye::CALIB_USE_INTRINSIC_GUESS |
                                          cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC |
                                          cv::fisheye::CALIB_FIX_SKEW);
  fit.camera = CameraOf(LensModel::kEquidistant, size, K, D);
  return fit;
} catch (const cv::Exception&) {  // it gives up where views are ill-conditioned
  return {};
}

// Without the views that fit far worse than most: something else was taken for the board.
Views WithoutOdd(const Views& views, const std::vector<double>& view_rms_px) {
  std::vector<double> sorted = view_rms_px;
  std::sort(sorted.begin(), sorted.end());
  const double limit_px = 3.0 * sorted[sorted.size() / 2];
  Views kept;
  for (std::size_t i = 0; i < view_rms_px.size(); ++i) {
    if (view_rms_px[i] > limit_px) continue;
    kept.corners_board_m.push_back(views.corners_board_m[i]);
    kept.corners_px.push_back(views.corners_px[i]);
  }
  return kept;
}

// A camera that could be, rather than where an ill-conditioned fit ran off to.
bool IsPlausible(const Fit& fit) {
  const CameraModel& camera = fit.camera;
  return std::isfinite(fit.rms_px) && camera.Problems().empty() &&
         std::abs(camera.fx_px / camera.fy_px - 1.0) < 0.1 &&
         camera.cx_px > 0.2 * camera.width_px && camera.cx_px < 0.8 * camera.width_px &&
         camera.cy_px > 0.2 * camera.height_px && camera.cy_px < 0.8 * camera.height_px;
}

std::string WordsOn(const Fit& fit, std::size_t num_boards) {
  char text[160];
  std::snprintf(text,
                sizeof text,
                "estimated from %zu boards in these images: %.2f px RMS, fx %.1f",
                num_boards,
                fit.rms_px,
                fit.camera.fx_px);
  if (fit.sigma_fx_px == 0.0) return text;  // not known
  return text + Format(" +- %.1f px", fit.sigma_fx_px);
}

}  // namespace

void CameraFromBoards::Take(const cv::Mat& grey) {
  ++num_images_;
  if (size_.empty()) size_ = grey.size();
  if (grey.size() != size_) return;
  const auto corners = TargetOf(board_).find_corners(grey, board_);
  if (!corners) return;
  const std::vector<Eigen::Vector3d> on_board = board_.InnerCornersBoardM();
  std::vector<cv::Point3f> corners_board_m;
  std::vector<cv::Point2f> corners_px;
  for (std::size_t i = 0; i < on_board.size(); ++i) {
    if (!(*corners)[i].allFinite()) continue;
    corners_board_m.emplace_back(
        on_board[i].cast<float>().x(), on_board[i].cast<float>().y(), 0.0F);
    corners_px.emplace_back((*corners)[i].cast<float>().x(), (*corners)[i].cast<float>().y());
  }
  if (2 * corners_px.size() < on_board.size()) return;  // too little of it for a pose
  corners_board_m_.push_back(std::move(corners_board_m));
  corners_px_.push_back(std::move(corners_px));
}

std::optional<CameraFromBoards::Estimate> CameraFromBoards::Solve() const try {
  if (num_boards() < kMinBoards) return {};
  Views views{corners_board_m_, corners_px_};
  Fit best = FitPlumbBob(views, size_);
  const Views kept = WithoutOdd(views, best.view_rms_px);
  if (kept.corners_px.size() < views.corners_px.size() && kept.corners_px.size() >= kMinBoards) {
    views = kept;
    best = FitPlumbBob(views, size_);
  }
  // A fisheye only where it is clearly one: two models often fit alike.
  const auto fisheye = FitEquidistant(views, size_, best);
  if (fisheye && IsPlausible(*fisheye) && fisheye->rms_px < 0.9 * best.rms_px) best = *fisheye;
  if (!IsPlausible(best)) return {};
  return Estimate{best.camera, WordsOn(best, views.corners_px.size())};
} catch (const cv::Exception&) {  // no camera explains these views
  return {};
}

}  // namespace voqcal
