#include "core/scene/edge_field.hpp"

#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace voqcal {
namespace {

// By the stored rank: 0 says nothing, 1 to 255 are ranks from 0 to 1.
std::array<float, 256> SurpriseByRank() {
  std::array<float, 256> surprise{};
  surprise[0] = static_cast<float>(EdgeField::kNothingSeen);
  for (std::size_t i = 1; i < surprise.size(); ++i) {
    surprise[i] = static_cast<float>(-std::log((static_cast<double>(i) - 0.5) / 255));
  }
  return surprise;
}

}  // namespace

EdgeField::EdgeField(const SceneView& view, double blur_px) : reduction_(view.reduction) {
  const std::array<float, 256> by_rank = SurpriseByRank();
  surprise_.create(view.edge_rank.size(), CV_32F);
  for (int y = 0; y < surprise_.rows; ++y) {
    const uchar* rank = view.edge_rank.ptr<uchar>(y);
    float* surprise = surprise_.ptr<float>(y);
    for (int x = 0; x < surprise_.cols; ++x) surprise[x] = by_rank[rank[x]];
  }
  cv::GaussianBlur(surprise_, surprise_, cv::Size(), blur_px);
}

double EdgeField::At(const Eigen::Vector2d& pixel_px, Eigen::RowVector2d* J_px) const {
  const Eigen::Vector2d at = ((pixel_px.array() + 0.5) / reduction_ - 0.5).matrix();
  const double left = std::floor(at.x());
  const double top = std::floor(at.y());
  if (J_px != nullptr) J_px->setZero();
  // Compared as doubles: a pixel far outside does not fit an int.
  if (!(left >= 0 && top >= 0 && left + 1 < surprise_.cols && top + 1 < surprise_.rows)) {
    return kNothingSeen;
  }
  const int x = static_cast<int>(left);
  const float* upper = surprise_.ptr<float>(static_cast<int>(top)) + x;
  const float* lower = surprise_.ptr<float>(static_cast<int>(top) + 1) + x;
  const double fx = at.x() - left;
  const double fy = at.y() - top;
  const double above = (1 - fx) * upper[0] + fx * upper[1];
  const double below = (1 - fx) * lower[0] + fx * lower[1];
  if (J_px != nullptr) {
    const double by_x = (1 - fy) * (upper[1] - upper[0]) + fy * (lower[1] - lower[0]);
    *J_px << by_x / reduction_, (below - above) / reduction_;
  }
  return (1 - fy) * above + fy * below;
}

}  // namespace voqcal
