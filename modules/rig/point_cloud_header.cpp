#include "rig/point_cloud_header.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "rig/number_text.hpp"

namespace voqcal {
namespace {

using Words = std::vector<std::string>;

/// What both formats tell before their data.
struct Header {
  std::string format;
  std::size_t num_points = 0;
  std::size_t num_columns = 0;  ///< Numbers a point.
  std::size_t point_bytes = 0;  ///< Bytes a point, in binary.
};

/// Walks through the lines of a file and says where something is wrong.
class LineReader {
 public:
  LineReader(const std::filesystem::path& path, const std::string& contents)
      : path_(path.string()), contents_(contents) {
    if (contents.empty()) Fail("is empty");
  }

  /// The words of the next line, "\r" apart; nothing at the end of the file.
  std::optional<Words> Next() {
    if (offset_ >= contents_.size()) return std::nullopt;
    const std::size_t end = std::min(contents_.find('\n', offset_), contents_.size());
    std::istringstream stream(contents_.substr(offset_, end - offset_));
    offset_ = end + 1;
    ++line_;
    Words words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
  }

  std::size_t NumBytesLeft() const {
    return contents_.size() - std::min(offset_, contents_.size());
  }
  const char* rest() const { return contents_.data() + offset_; }

  [[noreturn]] void Fail(const std::string& what) const {
    throw std::runtime_error(path_ + (line_ > 0 ? ":" + std::to_string(line_) : "") + ": " + what);
  }

  /// A number of a header: 0 or more.
  std::size_t Count(const Words& words, std::size_t i) const {
    int number = -1;
    if (i >= words.size() || !ParseNumber(words[i], &number) || number < 0) {
      Fail(words.front() + " must have a whole number from 0, is " +
           (i < words.size() ? '"' + words[i] + '"' : "empty"));
    }
    return static_cast<std::size_t>(number);
  }

 private:
  std::string path_;
  const std::string& contents_;
  std::size_t offset_ = 0;
  int line_ = 0;
};

/// Lines of numbers: as many as the header says, each with its columns.
void CheckText(const Header& header, LineReader* lines) {
  std::size_t num_found = 0;
  while (num_found < header.num_points) {
    const auto words = lines->Next();
    if (!words) {
      lines->Fail("is cut short: has " + std::to_string(num_found) + " of " +
                  std::to_string(header.num_points) + " points");
    }
    if (words->empty()) continue;
    if (words->size() != header.num_columns) {
      lines->Fail("has " + std::to_string(words->size()) + " numbers, must have " +
                  std::to_string(header.num_columns));
    }
    for (const std::string& word : *words) {
      double number = 0;
      if (!ParseNumber(word, &number)) lines->Fail("must be numbers, has \"" + word + '"');
    }
    ++num_found;
  }
}

void RequireBytes(std::size_t num_wanted, const LineReader& lines) {
  if (lines.NumBytesLeft() >= num_wanted) return;
  lines.Fail("is cut short: the header tells of " + std::to_string(num_wanted) +
             " bytes of points, " + std::to_string(lines.NumBytesLeft()) + " follow");
}

/// Two sizes, then so many bytes of LZF, which never packs more than 264 bytes into 3.
void CheckCompressed(const Header& header, const LineReader& lines) {
  constexpr std::size_t kMaxRatio = 100;
  std::uint32_t num_bytes[2] = {0, 0};  // compressed, unpacked
  RequireBytes(sizeof(num_bytes), lines);
  std::memcpy(num_bytes, lines.rest(), sizeof(num_bytes));
  RequireBytes(sizeof(num_bytes) + num_bytes[0], lines);
  const std::size_t wanted = header.num_points * header.point_bytes;
  if (num_bytes[1] != wanted || wanted > kMaxRatio * num_bytes[0]) {
    lines.Fail("must unpack " + std::to_string(num_bytes[0]) + " bytes to " +
               std::to_string(wanted) + ", claims " + std::to_string(num_bytes[1]));
  }
}

/// The header of a PCD file, its lines by their first word. Stops behind DATA.
std::map<std::string, Words> ReadPcdLines(LineReader* lines) {
  std::map<std::string, Words> header;
  while (header.count("DATA") == 0) {
    const auto words = lines->Next();
    if (!words) lines->Fail("is no PCD file: its header has no DATA");
    if (!words->empty() && words->front()[0] != '#') header[words->front()] = *words;
  }
  return header;
}

Header ReadPcdHeader(LineReader* lines) {
  std::map<std::string, Words> header_lines = ReadPcdLines(lines);
  const std::size_t num_fields = header_lines["FIELDS"].size();
  if (header_lines.count("COUNT") == 0) {
    header_lines["COUNT"] = Words(num_fields, "1");
    header_lines["COUNT"][0] = "COUNT";
  }
  for (const char* key : {"FIELDS", "SIZE", "TYPE", "COUNT"}) {
    if (num_fields < 2 || header_lines[key].size() != num_fields) {
      lines->Fail(std::string("is no PCD file: its header must have FIELDS, and one value of ") +
                  key + " for each");
    }
  }
  for (const char* key : {"WIDTH", "HEIGHT", "POINTS"}) {
    if (header_lines[key].size() != 2) {
      lines->Fail(std::string("is no PCD file: its header must have one value of ") + key);
    }
  }
  Header header;
  header.format = header_lines["DATA"].size() > 1 ? header_lines["DATA"][1] : "";
  header.num_points = lines->Count(header_lines["POINTS"], 1);
  if (lines->Count(header_lines["WIDTH"], 1) * lines->Count(header_lines["HEIGHT"], 1) !=
      header.num_points) {
    lines->Fail("POINTS must be WIDTH times HEIGHT");
  }
  for (std::size_t i = 1; i < num_fields; ++i) {
    const std::size_t count = lines->Count(header_lines["COUNT"], i);
    header.num_columns += count;
    header.point_bytes += count * lines->Count(header_lines["SIZE"], i);
  }
  return header;
}

/// Bytes of a PLY type; 0 for an unknown one.
std::size_t PlyTypeBytes(const std::string& type) {
  static const std::map<std::string, std::size_t> kBytes = {{"char", 1},
                                                            {"uchar", 1},
                                                            {"int8", 1},
                                                            {"uint8", 1},
                                                            {"short", 2},
                                                            {"ushort", 2},
                                                            {"int16", 2},
                                                            {"uint16", 2},
                                                            {"int", 4},
                                                            {"uint", 4},
                                                            {"int32", 4},
                                                            {"uint32", 4},
                                                            {"float", 4},
                                                            {"float32", 4},
                                                            {"double", 8},
                                                            {"float64", 8}};
  const auto type_bytes = kBytes.find(type);
  return type_bytes == kBytes.end() ? 0 : type_bytes->second;
}

Header ReadPlyHeader(LineReader* lines) {
  Header header;
  std::string element;
  const auto first = lines->Next();
  if (!first || *first != Words{"ply"}) lines->Fail("is no PLY file: must begin with ply");
  while (true) {
    const auto words = lines->Next();
    if (!words) lines->Fail("is no PLY file: its header has no end_header");
    if (words->empty()) continue;
    const std::string& key = words->front();
    if (key == "end_header") return header;
    if (key == "format" && words->size() > 1) header.format = (*words)[1];
    if (key == "element") {
      const bool is_first = element.empty();
      element = words->size() > 1 ? (*words)[1] : "";
      if (is_first && element != "vertex") lines->Fail("the first element must be vertex");
      if (element == "vertex") header.num_points = lines->Count(*words, 2);
    }
    if (key == "property" && element == "vertex") {
      const std::size_t num_bytes = words->size() == 3 ? PlyTypeBytes((*words)[1]) : 0;
      if (num_bytes == 0) lines->Fail("a vertex' property must have one known type and a name");
      ++header.num_columns;
      header.point_bytes += num_bytes;
    }
  }
}

void RequirePoints(const Header& header, const LineReader& lines) {
  if (header.num_points == 0 || header.point_bytes == 0) lines.Fail("has no points");
}

}  // namespace

void CheckPcd(const std::filesystem::path& path, const std::string& contents) {
  LineReader lines(path, contents);
  const Header header = ReadPcdHeader(&lines);
  RequirePoints(header, lines);
  if (header.format == "ascii") return CheckText(header, &lines);
  if (header.format == "binary") {
    return RequireBytes(header.num_points * header.point_bytes, lines);
  }
  if (header.format == "binary_compressed") return CheckCompressed(header, lines);
  lines.Fail("DATA must be ascii, binary or binary_compressed, is \"" + header.format + '"');
}

void CheckPly(const std::filesystem::path& path, const std::string& contents) {
  LineReader lines(path, contents);
  const Header header = ReadPlyHeader(&lines);
  RequirePoints(header, lines);
  if (header.format == "ascii") return CheckText(header, &lines);
  if (header.format == "binary_little_endian" || header.format == "binary_big_endian") {
    return RequireBytes(header.num_points * header.point_bytes, lines);
  }
  lines.Fail("format must be ascii, binary_little_endian or binary_big_endian, is \"" +
             header.format + '"');
}

}  // namespace voqcal
