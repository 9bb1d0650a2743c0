#include "files/point_cloud_table.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#ifdef VOQCAL_HAS_PCL
#include <pcl/io/lzf.h>
#endif

#include "files/foreign_file.hpp"
#include "files/number_text.hpp"

namespace voqcal {
namespace {

using Words = std::vector<std::string>;

/// One column, or several of one name.
struct Field {
  std::string name;
  char kind = 'F';            ///< As PCD's TYPE: I, U or F.
  std::size_t num_bytes = 4;  ///< Of one number, in binary.
  std::size_t count = 1;
};

/// What both formats tell before their data.
struct Header {
  std::string format;
  std::size_t num_points = 0;
  std::vector<Field> fields;

  std::size_t NumColumns() const {
    std::size_t num = 0;
    for (const Field& field : fields) num += field.count;
    return num;
  }
  std::size_t PointBytes() const {
    std::size_t num = 0;
    for (const Field& field : fields) num += field.count * field.num_bytes;
    return num;
  }
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

/// The table's names: of the fields with one number a point.
CloudTable EmptyTable(const Header& header) {
  CloudTable table;
  table.num_points = header.num_points;
  for (const Field& field : header.fields) {
    if (field.count == 1) table.names.push_back(field.name);
  }
  return table;
}

/// The numbers of a line, as many as the header says.
std::vector<double> ReadLine(const Words& words, std::size_t num_columns, const LineReader& lines) {
  if (words.size() != num_columns) {
    lines.Fail("has " + std::to_string(words.size()) + " numbers, must have " +
               std::to_string(num_columns));
  }
  std::vector<double> numbers(num_columns);
  for (std::size_t i = 0; i < num_columns; ++i) {
    if (!ParseNumber(words[i], &numbers[i])) {
      lines.Fail("must be numbers, has \"" + words[i] + '"');
    }
  }
  return numbers;
}

/// Lines of numbers.
CloudTable ReadText(const Header& header, LineReader* lines) {
  CloudTable table = EmptyTable(header);
  const std::size_t num_columns = header.NumColumns();
  std::size_t num_found = 0;
  while (num_found < header.num_points) {
    const auto words = lines->Next();
    if (!words) {
      lines->Fail("is cut short: has " + std::to_string(num_found) + " of " +
                  std::to_string(header.num_points) + " points");
    }
    if (words->empty()) continue;
    const std::vector<double> numbers = ReadLine(*words, num_columns, *lines);
    std::size_t column = 0;
    for (const Field& field : header.fields) {
      if (field.count == 1) table.values.push_back(numbers[column]);
      column += field.count;
    }
    ++num_found;
  }
  return table;
}

template <typename Value>
double ValueAt(const std::uint8_t* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}

/// One number; its bytes are this machine's way round.
double NumberAt(const std::uint8_t* bytes, const Field& field) {
  switch (field.num_bytes) {
    case 1:
      return field.kind == 'I' ? ValueAt<std::int8_t>(bytes) : ValueAt<std::uint8_t>(bytes);
    case 2:
      return field.kind == 'I' ? ValueAt<std::int16_t>(bytes) : ValueAt<std::uint16_t>(bytes);
    case 4:
      if (field.kind == 'F') return ValueAt<float>(bytes);
      return field.kind == 'I' ? ValueAt<std::int32_t>(bytes) : ValueAt<std::uint32_t>(bytes);
    default:
      if (field.kind == 'F') return ValueAt<double>(bytes);
      return field.kind == 'I' ? ValueAt<std::int64_t>(bytes) : ValueAt<std::uint64_t>(bytes);
  }
}

enum class Layout {
  kPointByPoint,
  kPointByPointSwapped,  ///< Each number's bytes the other way round.
  kFieldByField,         ///< All points' first field, then all their second.
};

/// @param data  PointBytes() of each point.
CloudTable ReadBinary(const Header& header, Layout layout, const std::uint8_t* data) {
  CloudTable table = EmptyTable(header);
  const std::size_t num_values = table.names.size();
  table.values.resize(header.num_points * num_values);
  const std::size_t point_bytes = header.PointBytes();
  std::size_t offset = 0;  // of the field within a point
  std::size_t column = 0;
  for (const Field& field : header.fields) {
    const std::size_t field_bytes = field.count * field.num_bytes;
    const bool is_by_field = layout == Layout::kFieldByField;
    const std::uint8_t* bytes = data + offset * (is_by_field ? header.num_points : 1);
    const std::size_t step = is_by_field ? field_bytes : point_bytes;
    for (std::size_t i = 0; field.count == 1 && i < header.num_points; ++i, bytes += step) {
      std::uint8_t number[8] = {};
      std::copy_n(bytes, field.num_bytes, number);
      if (layout == Layout::kPointByPointSwapped) std::reverse(number, number + field.num_bytes);
      table.values[i * num_values + column] = NumberAt(number, field);
    }
    offset += field_bytes;
    column += field.count == 1;
  }
  return table;
}

void RequireBytes(std::size_t num_wanted, const LineReader& lines) {
  if (lines.NumBytesLeft() >= num_wanted) return;
  lines.Fail("is cut short: the header tells of " + std::to_string(num_wanted) +
             " bytes of points, " + std::to_string(lines.NumBytesLeft()) + " follow");
}

/// Two sizes, then so many bytes of LZF, which never packs more than 264 bytes into 3.
CloudTable ReadCompressed([[maybe_unused]] const Header& header, const LineReader& lines) {
#ifdef VOQCAL_HAS_PCL
  constexpr std::size_t kMaxRatio = 100;
  std::uint32_t num_bytes[2] = {0, 0};  // compressed, unpacked
  RequireBytes(sizeof(num_bytes), lines);
  std::memcpy(num_bytes, lines.rest(), sizeof(num_bytes));
  RequireBytes(sizeof(num_bytes) + num_bytes[0], lines);
  const std::size_t wanted = header.num_points * header.PointBytes();
  if (num_bytes[1] != wanted || wanted > kMaxRatio * num_bytes[0]) {
    lines.Fail("must unpack " + std::to_string(num_bytes[0]) + " bytes to " +
               std::to_string(wanted) + ", claims " + std::to_string(num_bytes[1]));
  }
  std::vector<std::uint8_t> unpacked(wanted);
  const unsigned int num_unpacked = pcl::lzfDecompress(
      lines.rest() + sizeof(num_bytes), num_bytes[0], unpacked.data(), num_bytes[1]);
  if (num_unpacked != wanted) lines.Fail("cannot be read as a cloud: what is packed is damaged");
  return ReadBinary(header, Layout::kFieldByField, unpacked.data());
#else
  lines.Fail(
      "is compressed, and this voqcal was built without PCL, which unpacks it: install libpcl-dev "
      "and build again, or save the cloud as plain binary");
#endif
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
  if (num_fields > 0 && header_lines.count("COUNT") == 0) {
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
    header.fields.push_back({header_lines["FIELDS"][i],
                             header_lines["TYPE"][i][0],
                             lines->Count(header_lines["SIZE"], i),
                             lines->Count(header_lines["COUNT"], i)});
  }
  return header;
}

/// The kind and size of a PLY type; nothing for an unknown one.
std::optional<std::pair<char, std::size_t>> PlyType(const std::string& type) {
  static const std::map<std::string, std::pair<char, std::size_t>> kTypes = {{"char", {'I', 1}},
                                                                             {"uchar", {'U', 1}},
                                                                             {"int8", {'I', 1}},
                                                                             {"uint8", {'U', 1}},
                                                                             {"short", {'I', 2}},
                                                                             {"ushort", {'U', 2}},
                                                                             {"int16", {'I', 2}},
                                                                             {"uint16", {'U', 2}},
                                                                             {"int", {'I', 4}},
                                                                             {"uint", {'U', 4}},
                                                                             {"int32", {'I', 4}},
                                                                             {"uint32", {'U', 4}},
                                                                             {"float", {'F', 4}},
                                                                             {"float32", {'F', 4}},
                                                                             {"double", {'F', 8}},
                                                                             {"float64", {'F', 8}}};
  const auto known = kTypes.find(type);
  if (known == kTypes.end()) return std::nullopt;
  return known->second;
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
      const auto type = words->size() == 3 ? PlyType((*words)[1]) : std::nullopt;
      if (!type) lines->Fail("a vertex' property must have one known type and a name");
      header.fields.push_back({(*words)[2], type->first, type->second, 1});
    }
  }
}

/// What can be read, and no size overflows: at most 2^31 points of 2^8 fields of 2^20 numbers.
void RequireReadable(const Header& header, const LineReader& lines) {
  constexpr std::size_t kMaxFields = 256;
  constexpr std::size_t kMaxCount = 1 << 20;
  if (header.fields.size() > kMaxFields) lines.Fail("has more than 256 fields");
  for (const Field& field : header.fields) {
    const bool is_float = field.kind == 'F' && (field.num_bytes == 4 || field.num_bytes == 8);
    const bool is_whole =
        (field.kind == 'I' || field.kind == 'U') && (field.num_bytes == 1 || field.num_bytes == 2 ||
                                                     field.num_bytes == 4 || field.num_bytes == 8);
    if (!is_float && !is_whole) {
      lines.Fail("the type of field " + field.name + " is not known: " + field.kind + " of " +
                 std::to_string(field.num_bytes) + " bytes");
    }
    if (field.count > kMaxCount) lines.Fail("the COUNT of field " + field.name + " is too large");
  }
  if (header.num_points == 0 || header.PointBytes() == 0) lines.Fail("has no points");
}

CloudTable ReadBinary(const Header& header, Layout layout, const LineReader& lines) {
  RequireBytes(header.num_points * header.PointBytes(), lines);
  return ReadBinary(header, layout, reinterpret_cast<const std::uint8_t*>(lines.rest()));
}

void RefuseForeign(const std::string& contents, const LineReader& lines) {
  const std::string foreign = ForeignFileText(std::string_view(contents));
  if (!foreign.empty()) lines.Fail(foreign);
}

}  // namespace

CloudTable ReadPcd(const std::filesystem::path& path, const std::string& contents) {
  LineReader lines(path, contents);
  RefuseForeign(contents, lines);
  const Header header = ReadPcdHeader(&lines);
  RequireReadable(header, lines);
  if (header.format == "ascii") return ReadText(header, &lines);
  if (header.format == "binary") return ReadBinary(header, Layout::kPointByPoint, lines);
  if (header.format == "binary_compressed") return ReadCompressed(header, lines);
  lines.Fail("DATA must be ascii, binary or binary_compressed, is \"" + header.format + '"');
}

CloudTable ReadPly(const std::filesystem::path& path, const std::string& contents) {
  LineReader lines(path, contents);
  RefuseForeign(contents, lines);
  const Header header = ReadPlyHeader(&lines);
  RequireReadable(header, lines);
  if (header.format == "ascii") return ReadText(header, &lines);
  if (header.format == "binary_little_endian") {
    return ReadBinary(header, Layout::kPointByPoint, lines);
  }
  if (header.format == "binary_big_endian") {
    return ReadBinary(header, Layout::kPointByPointSwapped, lines);
  }
  lines.Fail("format must be ascii, binary_little_endian or binary_big_endian, is \"" +
             header.format + '"');
}

}  // namespace voqcal
