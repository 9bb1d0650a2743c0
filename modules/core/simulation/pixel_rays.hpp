#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/camera/camera_model.hpp"

namespace voqcal {

/// The rays through the corners of all pixels of a camera, by the exact inverse of its lens model,
/// computed once. Rays inside a pixel lie between those of its corners: over one pixel the
/// curvature of a lens is below 0.001 px.
class PixelRays {
 public:
  explicit PixelRays(const CameraModel& camera);

  /// The ray at (x - 0.5, y - 0.5) px, x in 0..width, y in 0..height: the corner shared by pixels
  /// (x - 1, y - 1) and (x, y). Camera frame, unit length; NaN where the lens cannot be inverted.
  const Eigen::Vector3f& AtCorner(int x, int y) const { return rays_[y * (width_ + 1) + x]; }

 private:
  int width_;
  std::vector<Eigen::Vector3f> rays_;
};

}  // namespace voqcal
