#pragma once

#include <string>

namespace voqcal {

/// Something that is wrong with a session, for who sits before it.
struct Fault {
  std::string of;      ///< "lidar", "camera", "disk", "recorder", "network" or a module's name.
  std::string what;    ///< What is to be seen: "The lidar has sent nothing for 4 s".
  std::string cause;   ///< As far as it is known; may be empty.
  std::string remedy;  ///< What to do.
  /// Nothing good comes of going on; else it should be known, and may be over.
  bool is_grave = true;
};

/// "What: cause. Remedy" on one line.
std::string ToString(const Fault& fault);

}  // namespace voqcal
