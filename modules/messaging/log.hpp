#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace voqcal {

/// One message of an LCM log, as lcm-logger writes them.
struct LogEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;  ///< When it was received, microseconds since the Unix epoch.
  std::string channel;
  std::vector<std::uint8_t> bytes;  ///< The encoded message; DecodeMessage takes them.
};

/// The event's bytes in a log.
std::vector<std::uint8_t> EncodeLogEvent(const LogEvent& event);

/// The file ends within an event.
class TruncatedLogError : public std::runtime_error {
 public:
  TruncatedLogError(const std::string& what, std::int64_t offset)
      : std::runtime_error(what), offset_(offset) {}
  std::int64_t offset() const { return offset_; }  ///< Where the cut event begins, bytes.

 private:
  std::int64_t offset_;
};

/// Reads an LCM log from the front. LCM's own reader looks for the next sync word when it meets
/// anything else, and takes a cut event for the end; this one counts what is damaged, and tells a
/// cut.
class LogReader {
 public:
  /// @throws std::runtime_error naming the file, if it cannot be read.
  explicit LogReader(const std::filesystem::path& path);

  /// The next whole event, or nothing at the end. What is damaged before it is skipped: an event
  /// whose header cannot be, or which does not end where another begins while another begins
  /// within it.
  /// @throws TruncatedLogError if the file ends within the event.
  /// @throws std::runtime_error naming the file, if it does not begin with an event.
  std::optional<LogEvent> Next();

  /// Where Next will read, bytes from the start.
  std::int64_t offset() const { return offset_; }
  std::int64_t num_bytes() const { return num_bytes_; }  ///< The file's size when it was opened.
  std::int64_t num_damaged() const { return num_damaged_; }  ///< Places that Next has skipped.

 private:
  /// What an event's header says of it.
  struct Extent {
    bool has_sync = false;     ///< As far as the file goes.
    bool is_possible = false;  ///< A whole header of an event that may be.
    std::int64_t channel_bytes = 0;
    std::int64_t end = 0;
  };

  std::vector<std::uint8_t> Read(std::int64_t offset, std::int64_t num_bytes);
  Extent ExtentAt(std::int64_t offset);
  bool IsSyncOrEnd(std::int64_t offset);
  std::optional<std::int64_t> FindEvent(std::int64_t from);
  LogEvent Take(const Extent& extent);

  std::filesystem::path path_;
  std::ifstream file_;
  std::int64_t num_bytes_ = 0;
  std::int64_t offset_ = 0;
  std::int64_t num_damaged_ = 0;
};

/// @throws std::runtime_error naming the log, if a LogWriter has it open in another process; not if
/// there is no such file.
void RequireNotBeingWritten(const std::filesystem::path& path);

/// Appends to an LCM log. Numbers and times come from the caller, so that the same events give the
/// same bytes.
class LogWriter {
 public:
  /// Starts a new log, or goes on after the last complete event of an old one: an event that a
  /// crash left half-written is cut off, with a warning.
  ///
  /// @throws std::runtime_error naming the file, if it cannot be written, is written by another
  ///     process, or is no LCM log (it is then left as it is).
  explicit LogWriter(const std::filesystem::path& path);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Appends the event whole, or takes back what was written of it and throws.
  /// @throws std::runtime_error naming file and cause (a full disk, ...).
  void Write(const LogEvent& event);

  /// Takes back everything from `offset` on, which is where an event begins, or the end.
  /// @throws std::runtime_error naming file and cause.
  void CutAt(std::int64_t offset);

  /// Returns once all events are on the disk.
  /// @throws std::runtime_error naming file and cause.
  void Flush();

 private:
  void CutHalfWrittenEvent();
  [[noreturn]] void Fail(const std::string& action) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t num_bytes_ = 0;  ///< Of complete events.
};

}  // namespace voqcal
