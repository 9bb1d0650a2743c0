#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include "calibrate/offline_run.hpp"
#include "core/assessment/verdict.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Where a calibration's files are made, and where they go.
struct SessionFolders {
  std::filesystem::path scratch;  ///< Has the run's samples.lcm.
  std::filesystem::path out;      ///< Made if missing.
};

/// There is no result: too few samples, say. With advice, a line each.
struct NoCalibration : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Calibrates from the samples that a run has collected, and leaves extrinsic.yaml, samples.lcm,
/// result.json and, unless its program could not run (a warning), report.html in the folder.
///
/// @param input  the recording, as errors name it.
/// @throws NoCalibration; no_result.html then shows what was seen.
/// @throws std::runtime_error naming a file that cannot be written, and the cause.
void FinishSession(const Rig& rig,
                   const std::filesystem::path& input,
                   const SessionFolders& folders,
                   OfflineRun* run);

/// @param demand  "good", "usable" or, for none, empty.
/// @throws DemandNotMet unless the verdict is as good as was demanded.
void RequireVerdict(const Verdict& verdict, const std::string& demand);

}  // namespace voqcal
