#pragma once

#include "core/camera/camera_model.hpp"

namespace voqcal::test {

/// The fisheye camera of the real session.
inline CameraModel RealCamera() {
  CameraModel camera;
  camera.lens = LensModel::kEquidistant;
  camera.width_px = 1920;
  camera.height_px = 1208;
  camera.fx_px = 1176.93;
  camera.fy_px = 1177.72;
  camera.cx_px = 962.275;
  camera.cy_px = 612.725;
  camera.distortion = {-0.0540096, -0.0784275, 0.0959641, -0.0515253};
  return camera;
}

/// A camera of 640 x 400 pixels with a lens of each kind.
inline CameraModel SmallCamera(LensModel lens) {
  CameraModel camera;
  camera.lens = lens;
  camera.width_px = 640;
  camera.height_px = 400;
  camera.fx_px = 420;
  camera.fy_px = 425;
  camera.cx_px = 322;
  camera.cy_px = 197;
  if (lens == LensModel::kEquidistant) camera.distortion = {-0.05, -0.08, 0.09, -0.05};
  if (lens == LensModel::kPlumbBob) camera.distortion = {-0.2, 0.05, 0.001, -0.002, 0.003};
  if (lens == LensModel::kRational) {
    camera.distortion = {0.3, 0.05, 0.001, -0.002, 0.003, 0.5, 0.1, 0.01};
  }
  return camera;
}

inline constexpr LensModel kLenses[] = {
    LensModel::kEquidistant, LensModel::kPlumbBob, LensModel::kRational};

}  // namespace voqcal::test
