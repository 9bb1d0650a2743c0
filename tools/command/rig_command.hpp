#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "messaging/bus.hpp"
#include "rig/rig.hpp"

namespace voqcal {

/// A command to all sample collectors of a rig of several sensors.
struct RigCommand {
  std::string command;
  /// After finish, for the result, without news of it; 0: not at all.
  std::chrono::duration<double> wait{0};
  std::filesystem::path session;  ///< After that, each pair's report is made there; or empty.
};

/// Sends it, says what came of it, and after finish waits for the tree.
///
/// @param pairs  LoadPairs of the rig.
/// @param bus    of the rig's network.
/// @throws std::runtime_error if nothing came of it; DemandNotMet if the tree is not to be used.
void CommandRig(const RigCommand& command, const std::vector<Rig>& pairs, Bus* bus);

}  // namespace voqcal
