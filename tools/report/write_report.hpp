#pragma once

#include <filesystem>
#include <string>

#include "calibrate/offline_run.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// Writes result.json and, beside it, report.html made of it and of the scenes in samples.lcm.
///
/// @param run     finished, with a result.
/// @param folder  where they go, and where the run's samples.lcm is.
/// @return why there is no report.html (its program could not run: no Python, no jinja2); empty if
///     there is one.
/// @throws std::runtime_error naming the file and the cause if result.json cannot be written.
std::string WriteReport(const Rig& rig, const OfflineRun& run, const std::filesystem::path& folder);

}  // namespace voqcal
