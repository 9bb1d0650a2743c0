#pragma once

#include <string>

#include "rig/frame_folder.hpp"

namespace voqcal {

/// How clouds and images of two folders pair, in words: "18 pairs, by the numbers of their names".
///
/// @param max_offset_s  how far apart the times of a pair may be.
/// @throws std::runtime_error naming the files, where they would hardly pair as they were taken: no
///     two belong together, the numbers are shifted against each other, or names of different
///     kinds.
std::string PairingOf(const FrameFolder& clouds, const FrameFolder& images, double max_offset_s);

/// The same of the folders of a rig's two drivers; empty unless both have one with frames.
///
/// @throws std::runtime_error as PairingOf.
std::string PairingOfDrivers(const Rig& rig);

/// Logs it, before a driver begins. @throws as PairingOfDrivers.
void AnnouncePairing(const Rig& rig);

}  // namespace voqcal
