#pragma once

#include <string>

namespace voqcal {

/// A rig file with every key: what must be given by an example, all else by its default, and what
/// each means. The same from `check_rig --print-defaults`.
std::string DefaultRigText();

}  // namespace voqcal
