#pragma once

#include <string>

namespace voqcal {

/// Why hardly a lidar's packets arrive at an IPv4 address on which they are awaited, and what to
/// do; empty if it is one of this host's network cards' or 0.0.0.0, all of them.
std::string AddressDoubt(const std::string& address);

}  // namespace voqcal
