#include "core/lens_calibration/lens_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/camera_detection/planar_pose.hpp"
#include "core/lens_calibration/lens_verdict.hpp"
#include "core/median.hpp"
#include "core/problems.hpp"

namespace voqcal {
namespace {

using Points = std::vector<Eigen::Vector3d>;

std::vector<double> RmsOfViews(const CameraModel& camera,
                               const Points& corners_board_m,
                               const std::vector<LensView>& views) {
  std::vector<double> rms_px;
  for (const LensView& view : views) {
    const auto pose = FitSeenCorners(camera, corners_board_m, view.corners_px);
    rms_px.push_back(pose ? pose->reprojection_rms_px : HUGE_VAL);
  }
  return rms_px;
}

std::vector<LensView> ViewsBelow(const std::vector<LensView>& views,
                                 const std::vector<double>& rms_px,
                                 double limit_px) {
  std::vector<LensView> below;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (rms_px[i] <= limit_px) below.push_back(views[i]);
  }
  return below;
}

// From nothing, and whatever some of the views show: those that fit badly count little.
std::optional<LensFit> RobustFit(const LensForm& form,
                                 const Points& corners_board_m,
                                 const std::vector<LensView>& views,
                                 const cv::Size& image_px) {
  std::optional<CameraModel> lens = StartLens(form.lens, image_px, corners_board_m, views);
  std::optional<LensFit> fit;
  for (int pass = 0; pass < 3 && lens; ++pass) {
    const std::vector<double> rms_px = RmsOfViews(*lens, corners_board_m, views);
    const double median_px = Median(rms_px);
    if (!std::isfinite(median_px)) break;
    const auto posed = ViewsBelow(views, rms_px, 1e6);
    const auto next = FitLens(form, corners_board_m, posed, *lens, 2 * median_px);
    if (!next) break;
    fit = next;
    lens = next->camera;
  }
  return fit;
}

std::vector<LensForm> FormsToTry(const std::optional<LensModel>& lens) {
  return lens ? std::vector<LensForm>{WholeForm(*lens)} : LensForms();
}

/// Views that one lens explains, and the others.
struct Agreeing {
  std::vector<LensView> views;
  std::vector<LensView> odd;
  std::vector<double> odd_rms_px;
};

// Those that fit the lens as well as most do; of several lenses the one that fits the median view
// best tells.
Agreeing FindAgreeing(const std::vector<LensFit>& fits,
                      const Points& corners_board_m,
                      const std::vector<LensView>& views,
                      double max_ratio) {
  constexpr int kMaxRounds = 5;
  const auto median_px = [](const LensFit& fit) { return Median(fit.view_rms_px); };
  LensFit best =
      *std::min_element(fits.begin(), fits.end(), [&](const LensFit& a, const LensFit& b) {
        return median_px(a) < median_px(b);
      });
  std::vector<double> rms_px;
  double limit_px = 0;
  std::vector<LensView> kept;
  for (int round = 0; round < kMaxRounds; ++round) {
    rms_px = RmsOfViews(best.camera, corners_board_m, views);
    limit_px = max_ratio * Median(rms_px);
    const std::size_t num_before = kept.size();
    kept = ViewsBelow(views, rms_px, limit_px);
    if (kept.size() == num_before) break;
    const auto fit = FitLens(best.form, corners_board_m, kept, best.camera, 0.0);
    if (!fit) break;
    best = *fit;
  }
  Agreeing agreeing;
  agreeing.views = kept;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (rms_px[i] <= limit_px) continue;
    agreeing.odd.push_back(views[i]);
    agreeing.odd_rms_px.push_back(rms_px[i]);
  }
  return agreeing;
}

HeldOutErrors Sum(std::vector<double> view_px2, const std::vector<LensView>& views) {
  double sum_px2 = 0;
  double num = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    sum_px2 += view_px2[i] * static_cast<double>(NumCorners(views[i]));
    num += static_cast<double>(NumCorners(views[i]));
  }
  return {std::sqrt(sum_px2 / num), std::move(view_px2)};
}

HeldOutErrors ErrorsOf(const CameraModel& camera,
                       const Points& corners_board_m,
                       const std::vector<LensView>& views) {
  std::vector<double> view_px2 = RmsOfViews(camera, corners_board_m, views);
  for (double& value : view_px2) value *= value;
  return Sum(std::move(view_px2), views);
}

// Each group is predicted by the lens of all others. Neighbours in time are alike, so that groups
// of them test what is new to the lens.
HeldOutErrors HoldOut(const LensFit& fit,
                      const Points& corners_board_m,
                      const std::vector<LensView>& views,
                      std::size_t num_groups) {
  std::vector<double> view_px2;
  num_groups = std::min(num_groups, views.size());
  for (std::size_t group = 0; group < num_groups; ++group) {
    const auto begin = static_cast<std::ptrdiff_t>(group * views.size() / num_groups);
    const auto end = static_cast<std::ptrdiff_t>((group + 1) * views.size() / num_groups);
    std::vector<LensView> others(views.begin(), views.begin() + begin);
    others.insert(others.end(), views.begin() + end, views.end());
    const std::vector<LensView> held_out(views.begin() + begin, views.begin() + end);
    const auto refit = FitLens(fit.form, corners_board_m, others, fit.camera, 0.0);
    const std::vector<double> errors_px2 =
        refit ? ErrorsOf(refit->camera, corners_board_m, held_out).view_px2
              : std::vector<double>(held_out.size(), HUGE_VAL);
    view_px2.insert(view_px2.end(), errors_px2.begin(), errors_px2.end());
  }
  return Sum(std::move(view_px2), views);
}

// The standard error of the mean square over the views.
double StandardErrorPx2(const HeldOutErrors& errors) {
  const auto num = static_cast<double>(errors.view_px2.size());
  double mean = 0;
  for (const double value : errors.view_px2) mean += value / num;
  double variance = 0;
  for (const double value : errors.view_px2) variance += (value - mean) * (value - mean);
  return std::sqrt(variance / (num - 1) / num);
}

std::optional<LensTrial> SimplestGood(const std::vector<LensTrial>& trials) {
  if (trials.empty()) return {};
  const LensTrial& best =
      *std::min_element(trials.begin(), trials.end(), [](const LensTrial& a, const LensTrial& b) {
        return a.held_out.rms_px < b.held_out.rms_px;
      });
  const double limit_px2 =
      best.held_out.rms_px * best.held_out.rms_px + StandardErrorPx2(best.held_out);
  for (const LensTrial& trial : trials) {
    if (trial.held_out.rms_px * trial.held_out.rms_px <= limit_px2) return trial;
  }
  return best;
}

}  // namespace

std::vector<std::string> LensCalibrationOptions::Problems() const {
  ProblemList problems;
  problems.Require(min_views >= 2, "min_views must be at least 2", min_views);
  problems.Require(max_view_ratio >= 1, "max_view_ratio must be at least 1", max_view_ratio);
  problems.Require(num_groups >= 2, "num_groups must be at least 2", num_groups);
  problems.RequirePositive("max_rms_px", max_rms_px);
  problems.RequirePositive("max_sigma", max_sigma);
  return problems.lines();
}

LensCalibration CalibrateLens(const std::vector<LensView>& views,
                              const BoardSpec& board,
                              const cv::Size& image_px,
                              const LensCalibrationOptions& options) {
  RequireUsable("LensCalibrationOptions", options.Problems());
  LensCalibration result;
  result.views = views;
  const Points corners_board_m = board.InnerCornersBoardM();
  if (views.size() >= options.min_views) {
    std::vector<LensFit> fits;
    for (const LensForm& form : FormsToTry(options.lens)) {
      if (auto fit = RobustFit(form, corners_board_m, views, image_px)) fits.push_back(*fit);
    }
    if (!fits.empty()) {
      Agreeing agreeing = FindAgreeing(fits, corners_board_m, views, options.max_view_ratio);
      result.views = std::move(agreeing.views);
      result.odd = std::move(agreeing.odd);
      result.odd_rms_px = std::move(agreeing.odd_rms_px);
    }
    for (const LensFit& robust : fits) {
      if (result.views.size() < options.min_views) break;
      const auto fit = FitLens(robust.form, corners_board_m, result.views, robust.camera, 0.0);
      if (!fit) continue;
      result.trials.push_back(
          {*fit, HoldOut(*fit, corners_board_m, result.views, options.num_groups)});
    }
    result.best = SimplestGood(result.trials);
  }
  JudgeLens(options, &result);
  return result;
}

HeldOutErrors ErrorsOfLens(const CameraModel& camera,
                           const BoardSpec& board,
                           const std::vector<LensView>& views) {
  return ErrorsOf(camera, board.InnerCornersBoardM(), views);
}

}  // namespace voqcal
