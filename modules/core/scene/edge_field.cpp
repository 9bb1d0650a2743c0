#include "core/scene/edge_field.hpp"

#include <algorithm>
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

EdgeField::Place EdgeField::PlaceOf(const Eigen::Vector2d& pixel_px) const {
  const Eigen::Vector2d at = ((pixel_px.array() + 0.5) / reduction_ - 0.5).matrix();
  const double left = std::floor(at.x());
  const double top = std::floor(at.y());
  // Compared as doubles: a pixel far outside does not fit an int.
  if (!(left >= 0 && top >= 0 && left + 1 < surprise_.cols && top + 1 < surprise_.rows)) return {};
  return {true, static_cast<int>(left), static_cast<int>(top), at.x() - left, at.y() - top};
}

double EdgeField::Between(const Place& place,
                          const float* upper,
                          const float* lower,
                          Eigen::RowVector2d* J_px) const {
  const double fx = place.fx;
  const double fy = place.fy;
  const double above = (1 - fx) * upper[0] + fx * upper[1];
  const double below = (1 - fx) * lower[0] + fx * lower[1];
  if (J_px != nullptr) {
    const double by_x = (1 - fy) * (upper[1] - upper[0]) + fy * (lower[1] - lower[0]);
    *J_px << by_x / reduction_, (below - above) / reduction_;
  }
  return (1 - fy) * above + fy * below;
}

bool EdgeField::Patch::Holds(int pixel_x, int pixel_y) const {
  return pixel_x >= x && pixel_x + 1 < x + kSize && pixel_y >= y && pixel_y + 1 < y + kSize;
}

void EdgeField::Move(const Place& place, Patch* patch) const {
  constexpr int kSize = Patch::kSize;
  patch->x = place.x - (kSize / 2 - 1);
  patch->y = place.y - (kSize / 2 - 1);
  for (int row = 0; row < kSize; ++row) {
    const float* surprise = surprise_.ptr<float>(std::clamp(patch->y + row, 0, surprise_.rows - 1));
    for (int column = 0; column < kSize; ++column) {
      patch->surprise[static_cast<std::size_t>(kSize * row + column)] =
          surprise[std::clamp(patch->x + column, 0, surprise_.cols - 1)];
    }
  }
}

double EdgeField::At(const Eigen::Vector2d& pixel_px,
                     Patch* patch,
                     Eigen::RowVector2d* J_px) const {
  if (J_px != nullptr) J_px->setZero();
  const Place place = PlaceOf(pixel_px);
  if (!place.is_inside) return kNothingSeen;
  const auto at = [&place, J_px, this](const float* upper, std::ptrdiff_t to_lower) {
    return Between(place, upper, upper + to_lower, J_px);
  };
  if (patch == nullptr) {
    return at(surprise_.ptr<float>(place.y) + place.x,
              static_cast<std::ptrdiff_t>(surprise_.step1()));
  }
  if (!patch->Holds(place.x, place.y)) Move(place, patch);
  const int first = Patch::kSize * (place.y - patch->y) + (place.x - patch->x);
  return at(patch->surprise.data() + first, Patch::kSize);
}

void EdgeField::Prefetch(const Eigen::Vector2d& pixel_px, const Patch* patch) const {
  const Place place = PlaceOf(pixel_px);
  if (!place.is_inside || (patch != nullptr && patch->Holds(place.x, place.y))) return;
  const int above = patch != nullptr ? Patch::kSize / 2 - 1 : 0;
  const int below = patch != nullptr ? Patch::kSize / 2 : 1;
  for (int y = std::max(place.y - above, 0); y <= std::min(place.y + below, surprise_.rows - 1);
       ++y) {
    __builtin_prefetch(surprise_.ptr<float>(y) + place.x);
  }
}

}  // namespace voqcal
