#pragma once

#include <string>

#include "calibrate/offline_run.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// The text of result.json: what a finished run found, for programs and for the report.
///
/// - result: everything of extrinsic.yaml, under the same keys
/// - rig: its name, board and camera
/// - samples: each accepted sample: ids, where it was, whether it was used, its errors (those of
///   PoseScore) by the average, by the refined extrinsic and by the one refined without it
/// - sets: the chosen sets with what each gave, as a difference from the average; the VOQ of all
///   sets as a histogram (null beyond two million sets)
/// - range_colours: of the report's pictures, from 1 to 30 m
/// - frames: what each module counted, and the frames that the collector rejected, with reasons
///
/// Numbers that are not known are null. The same run gives the same bytes.
/// @param run  finished, with a result.
std::string ResultJson(const Rig& rig, const OfflineRun& run);

}  // namespace voqcal
