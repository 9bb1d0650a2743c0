#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/scene/scene_check.hpp"

namespace voqcal {

/// What a verdict rests on. NaN: unknown, which is never good.
struct Evidence {
  double held_out_mm = std::numeric_limits<double>::quiet_NaN();   ///< Mean centre error.
  double in_sample_mm = std::numeric_limits<double>::quiet_NaN();  ///< The same of the fit's poses.
  double normal_deg = std::numeric_limits<double>::quiet_NaN();    ///< Mean, held out.
  double chessboard_turn_deg = 0.0;  ///< Calibration's, about both axes; zero: not estimated.
  double sigma_deg = std::numeric_limits<double>::quiet_NaN();  ///< Of the worst axis.
  double sigma_mm = std::numeric_limits<double>::quiet_NaN();   ///< Of the translation's length.
  int num_used = 0;
  bool is_enough = false;  ///< Enough's, as the guide says it.
  std::string enough_words;
  int num_samples = 0;  ///< With those that were left out.
  /// Which other lens the samples ask for, a sentence; empty if for none (LensCorrection).
  std::string other_lens;
  /// Of the image (ImagePartNames): those without a used pose.
  std::vector<std::string> empty_parts;
  Agreement scene = Agreement::kCannotTell;
  std::string scene_reason;
  std::string likeliest_fault;  ///< A sentence; empty: none was found.
  std::string likeliest_cause;  ///< The same in a word or two.
  bool must_be_mended = false;  ///< The result is wrong by it.
};

enum class Grade { kGood, kLook, kBad };

std::string ToString(Grade grade);  ///< "good", "look", "bad".

/// One thing that was looked at, and what it means.
struct VerdictCheck {
  std::string name;  ///< "Certainty of the rotation"
  Grade grade = Grade::kLook;
  std::string text;  ///< The number, and what to do unless it is good.
};

/// Is the result good? In words for somebody who has never calibrated anything.
struct Verdict {
  Grade grade = Grade::kBad;  ///< The worst of the checks.
  std::string headline;
  std::vector<VerdictCheck> checks;
};

Verdict VerdictOf(const Evidence& evidence);

}  // namespace voqcal
