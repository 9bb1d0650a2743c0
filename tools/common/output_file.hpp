#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

namespace voqcal {

/// The one file that a tool writes, where its user said: --out FILE, and --force.
struct OutputFile {
  std::filesystem::path path;  ///< Empty if not given.
  bool is_forced = false;

  /// Makes the folders that it lies in.
  /// @throws std::runtime_error naming the file, if it is there and not to be overwritten, or a
  ///     folder that cannot be made.
  void Prepare() const;
};

/// Adds the two flags. @param what  e.g. "The log to write". @return --out.
CLI::Option* AddOutputFile(CLI::App* app, const std::string& what, OutputFile* file);

}  // namespace voqcal
