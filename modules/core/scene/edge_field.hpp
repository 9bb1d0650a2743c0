#pragma once

#include <array>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "core/scene/scene_view.hpp"

namespace voqcal {

/// How surprising it is to see a depth edge at a pixel: -log of the rank (0 to 1) of the image's
/// gradient there, blurred. Where edges have nothing to do with each other ranks are uniform, and
/// its mean is 1; so it is 1 where the image says nothing: outside and on the board.
class EdgeField {
 public:
  static constexpr double kNothingSeen = 1.0;

  EdgeField() = default;  ///< Of no image: nothing is seen anywhere.

  /// @param blur_px  1 sigma, of the reduced image.
  EdgeField(const SceneView& view, double blur_px);

  /// A piece of the field. Who asks for an edge's surprise again and again, a little moved each
  /// time, finds it there: in the field each edge lies in a page of memory of its own.
  struct Patch {
    static constexpr int kSize = 4;
    int x = -kSize;  ///< Its first column and row; none at first.
    int y = -kSize;
    std::array<float, kSize * kSize> surprise;

    /// With the neighbours to the right and below.
    bool Holds(int pixel_x, int pixel_y) const;
  };

  /// The surprise at a pixel of the whole image, and its derivative unless `J_px` is null.
  /// @param patch  of this field, moved to the pixel where it does not hold it; may be null.
  double At(const Eigen::Vector2d& pixel_px, Patch* patch, Eigen::RowVector2d* J_px) const;

  /// Has memory fetch what At will ask of the field.
  void Prefetch(const Eigen::Vector2d& pixel_px, const Patch* patch) const;

 private:
  /// A pixel of the whole image in the reduced one.
  struct Place {
    bool is_inside = false;  ///< With its neighbours to the right and below.
    int x = 0;
    int y = 0;
    double fx = 0;  ///< Beyond x.
    double fy = 0;
  };
  Place PlaceOf(const Eigen::Vector2d& pixel_px) const;
  void Move(const Place& place, Patch* patch) const;
  double Between(const Place& place,
                 const float* upper,
                 const float* lower,
                 Eigen::RowVector2d* J_px) const;

  cv::Mat surprise_;  // CV_32F, of the reduced image
  double reduction_ = 1.0;
};

}  // namespace voqcal
