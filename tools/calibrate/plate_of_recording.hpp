#pragma once

#include <filesystem>

#include "calibrate/collect.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// For a rig file that leaves the plate's size out: measures it in the recording, says what it is,
/// and puts it into the rig. Which of its edges is the width, the samples tell: they agree for one.
/// @param scratch  folder for what is made meanwhile.
/// @throws std::runtime_error naming the input, the cause and the remedy if it is no recording or
///     the plate cannot be measured in it.
void MeasurePlate(const InputPaths& input, const std::filesystem::path& scratch, Rig* rig);

}  // namespace voqcal
