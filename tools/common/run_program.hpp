#pragma once

#include <string>
#include <vector>

namespace voqcal {

/// Path of a script of tools ("report/make_report.py"): beside the programs where they are
/// installed, else in the source tree that they were built from.
std::string ScriptOfTools(const std::string& script);

/// Path of a file that is built (and installed) beside the folder of programs ("lib/x").
std::string FileBesidePrograms(const std::string& file);

/// Runs a program to its end. @return what went wrong; empty if it ended well.
std::string RunProgram(const std::vector<std::string>& args);

}  // namespace voqcal
