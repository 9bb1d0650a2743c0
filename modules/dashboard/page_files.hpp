#pragma once

#include <map>
#include <string>

#include "dashboard/server.hpp"

namespace voqcal {

/// The page and what it loads, by name, read once from share/dashboard beside the program's folder;
/// where the page was not built (no Node.js) one line that says how to get it.
std::map<std::string, StaticFile> PageFiles();

}  // namespace voqcal
