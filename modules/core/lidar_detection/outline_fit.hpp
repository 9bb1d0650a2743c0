#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/lidar_detection/outline_likelihood.hpp"

namespace voqcal {

/// The blur of SearchOutline: a twelfth of the shorter edge.
double SearchBlurM(const OutlineModel& model);

/// The best of many angles about `centre_m`, found with a wide blur and few beams: good enough to
/// reject a patch that is not the board, and for SharpenOutline to start from.
OutlineFit SearchOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const Eigen::Vector2d& centre_m);

/// From `start` with a blur of `first_blur_m`, then ever less, down to the model's; few beams.
OutlineFit SharpenOutline(const std::vector<OutlineBeam>& beams,
                          const OutlineModel& model,
                          const RectanglePose& start,
                          double first_blur_m);

/// The most likely rectangle of the model's size near `start`: Fisher scoring (expected second
/// derivatives) with Levenberg-Marquardt damping.
OutlineFit RefineOutline(const std::vector<OutlineBeam>& beams,
                         const OutlineModel& model,
                         const RectanglePose& start);

}  // namespace voqcal
