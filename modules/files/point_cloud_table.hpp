#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace voqcal {

/// The numbers of a cloud file: its fields with one number a point.
struct CloudTable {
  std::vector<std::string> names;
  std::size_t num_points = 0;
  std::vector<double> values;  ///< Point by point, in the order of the names.
};

/// Reads a PCD file's bytes. Not by PCL's own reader: that of 1.13 trusts the header, allocates
/// what it claims, reads beyond short files and crashes on damaged ones.
/// @throws std::runtime_error naming the file (with the line, in text) and what is wrong.
CloudTable ReadPcd(const std::filesystem::path& path, const std::string& contents);

/// The same for a PLY file, whose first element must be vertex.
CloudTable ReadPly(const std::filesystem::path& path, const std::string& contents);

}  // namespace voqcal
