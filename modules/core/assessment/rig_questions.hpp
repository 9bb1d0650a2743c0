#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/assessment/given_session.hpp"

namespace voqcal {

/// "What if the rig file said ...": one discrete mistake that people make, undone.
struct RigQuestion {
  std::string cause;   ///< "mirrored sensor", ...: one of a few.
  std::string claim;   ///< What is wrong, half a sentence.
  std::string remedy;  ///< The line to put into the rig file, or what else to do.
  std::function<void(GivenSession* session)> undo;
};

/// Those about the camera alone: its lens model, its coefficients, its images' size.
std::vector<RigQuestion> QuestionsAboutLens(const CameraModel& camera);

/// What if one of the camera's numbers (a focal length, both, ...) were as a camera fitted to the
/// images has it?
std::vector<RigQuestion> QuestionsAboutNumbers(const CameraModel& given, const CameraModel& fitted);

/// What if the squares were `scale` times as large?
RigQuestion QuestionAboutSquares(const BoardSpec& board, double scale);

/// Those that make sense of such a board and camera: a sign of an offset that is not zero, ...
std::vector<RigQuestion> QuestionsAbout(const BoardSpec& board, const CameraModel& camera);

}  // namespace voqcal
