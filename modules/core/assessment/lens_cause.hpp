#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/board/board_spec.hpp"
#include "core/camera/camera_model.hpp"

namespace voqcal {

/// Of each image the inner corners, in BoardSpec::InnerCornersBoardM order; NaN: not seen.
using Views = std::vector<std::vector<Eigen::Vector2d>>;

/// The numbers of the lens model that is given by which the views fit best; nothing if they tell
/// none. No more than a hint which number is wrong: CalibrateLens is for good ones.
std::optional<CameraModel> FittedCamera(const Views& views_px,
                                        const BoardSpec& board,
                                        const CameraModel& camera);

/// What the rig file says of the camera, and should say.
struct LensCause {
  std::string cause;            ///< "lens model", "image size", ...: one of a few.
  std::string claim;            ///< What is wrong, half a sentence.
  std::string remedy;           ///< The line to put into the rig file.
  std::size_t num_fitting = 0;  ///< Views of the pattern that fit the camera then.
};

/// Why images show the pattern, and its corners fit no pose of the board: which answer to
/// QuestionsAboutLens, else to QuestionsAboutNumbers by a lens fitted to these very images, makes
/// most of them fit, and far better than as it is; of several the one with
/// the smallest median RMS. No lidar is needed to tell: a plane seen through the wrong lens is
/// none.
/// @param max_rms_px  of the reprojection, of a view that fits.
/// @return nothing if there are fewer than five views, or no answer does.
std::optional<LensCause> FindLensCause(const Views& views_px,
                                       const BoardSpec& board,
                                       const CameraModel& camera,
                                       double max_rms_px);

}  // namespace voqcal
