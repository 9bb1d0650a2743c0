#include "messaging/log.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "files/foreign_file.hpp"

namespace voqcal {
namespace {

// An event, all big-endian: sync word u32, event number i64, time i64, channel length u32, data
// length u32, channel, data. (LCM 1.3.1, lcm/eventlog.c.)
constexpr std::array<std::uint8_t, 4> kSyncWord = {0xED, 0xA1, 0xDA, 0x01};
constexpr std::int64_t kHeaderBytes = 28;

/// LCM's channels have at most 63; a longer one is damage.
constexpr std::uint64_t kMaxChannelBytes = 63;

std::uint64_t ReadBigEndian(const std::uint8_t* bytes, int num_bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < num_bytes; ++i) value = (value << 8) | bytes[i];
  return value;
}

void AppendBigEndian(std::uint64_t value, int num_bytes, std::vector<std::uint8_t>* bytes) {
  for (int shift = 8 * (num_bytes - 1); shift >= 0; shift -= 8) {
    bytes->push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

std::string At(const std::filesystem::path& path, std::int64_t offset) {
  return path.string() + ": byte " + std::to_string(offset) + ": ";
}

/// Makes a new file's name as durable as its contents.
void SyncFolderOf(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

// As fcntl takes it. Of the open file, not of the process (F_OFD_...): two writers of one process
// keep each other out, and to ask takes no lock.
struct flock WholeFile(short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

std::vector<std::uint8_t> EncodeLogEvent(const LogEvent& event) {
  std::vector<std::uint8_t> bytes(kSyncWord.begin(), kSyncWord.end());
  bytes.reserve(static_cast<std::size_t>(kHeaderBytes) + event.channel.size() + event.bytes.size());
  AppendBigEndian(static_cast<std::uint64_t>(event.number), 8, &bytes);
  AppendBigEndian(static_cast<std::uint64_t>(event.utime), 8, &bytes);
  AppendBigEndian(event.channel.size(), 4, &bytes);
  AppendBigEndian(event.bytes.size(), 4, &bytes);
  bytes.insert(bytes.end(), event.channel.begin(), event.channel.end());
  bytes.insert(bytes.end(), event.bytes.begin(), event.bytes.end());
  return bytes;
}

LogReader::LogReader(const std::filesystem::path& path) : path_(path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw std::runtime_error(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status)) {
    throw std::runtime_error(path.string() + ": not a file");
  }
  num_bytes_ = static_cast<std::int64_t>(std::filesystem::file_size(path));
  file_.open(path, std::ios::binary);
  if (!file_) throw std::runtime_error(path.string() + ": cannot be read");
}

std::vector<std::uint8_t> LogReader::Read(std::int64_t offset, std::int64_t num_bytes) {
  std::vector<std::uint8_t> bytes(
      static_cast<std::size_t>(std::min(num_bytes, num_bytes_ - offset)));
  file_.clear();
  file_.seekg(offset);
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file_.gcount()));
  return bytes;
}

// A cut may fall within the sync word: what there is of it must match.
bool LogReader::IsSyncOrEnd(std::int64_t offset) {
  const std::vector<std::uint8_t> bytes = Read(offset, std::int64_t{kSyncWord.size()});
  return std::equal(bytes.begin(), bytes.end(), kSyncWord.begin());
}

LogReader::Extent LogReader::ExtentAt(std::int64_t offset) {
  Extent extent;
  extent.has_sync = IsSyncOrEnd(offset);
  const std::vector<std::uint8_t> header = Read(offset, kHeaderBytes);
  if (!extent.has_sync || header.size() < static_cast<std::size_t>(kHeaderBytes)) return extent;
  const std::uint64_t channel_bytes = ReadBigEndian(&header[20], 4);
  const std::uint64_t data_bytes = ReadBigEndian(&header[24], 4);
  extent.is_possible = channel_bytes > 0 && channel_bytes <= kMaxChannelBytes;
  extent.channel_bytes = static_cast<std::int64_t>(channel_bytes);
  extent.end = offset + kHeaderBytes + static_cast<std::int64_t>(channel_bytes + data_bytes);
  return extent;
}

// The next place at which a whole event begins that ends where another does, or with the file.
std::optional<std::int64_t> LogReader::FindEvent(std::int64_t from) {
  constexpr std::int64_t kBlockBytes = 1 << 20;
  for (std::int64_t begin = from; begin < num_bytes_; begin += kBlockBytes) {
    const std::vector<std::uint8_t> block =
        Read(begin, kBlockBytes + static_cast<std::int64_t>(kSyncWord.size()) - 1);
    auto sync = block.begin();
    while (true) {
      sync = std::search(sync, block.end(), kSyncWord.begin(), kSyncWord.end());
      if (sync == block.end()) break;
      const std::int64_t offset = begin + (sync - block.begin());
      const Extent extent = ExtentAt(offset);
      if (extent.is_possible && extent.end <= num_bytes_ && IsSyncOrEnd(extent.end)) return offset;
      ++sync;
    }
  }
  return std::nullopt;
}

LogEvent LogReader::Take(const Extent& extent) {
  const std::vector<std::uint8_t> bytes = Read(offset_, extent.end - offset_);
  if (static_cast<std::int64_t>(bytes.size()) < extent.end - offset_) {
    throw std::runtime_error(At(path_, offset_) + "cannot be read");
  }
  const auto data = bytes.begin() + kHeaderBytes;
  LogEvent event;
  event.number = static_cast<std::int64_t>(ReadBigEndian(&bytes[4], 8));
  event.utime = static_cast<std::int64_t>(ReadBigEndian(&bytes[12], 8));
  event.channel.assign(data, data + extent.channel_bytes);
  event.bytes.assign(data + extent.channel_bytes, bytes.end());
  offset_ = extent.end;
  return event;
}

std::optional<LogEvent> LogReader::Next() {
  if (offset_ == num_bytes_) return std::nullopt;
  const Extent extent = ExtentAt(offset_);
  const bool is_whole = extent.is_possible && extent.end <= num_bytes_;
  if (is_whole && IsSyncOrEnd(extent.end)) return Take(extent);
  if (offset_ == 0 && !extent.has_sync) {
    const std::string foreign = ForeignFileText(path_);
    if (!foreign.empty()) throw std::runtime_error(path_.string() + ": " + foreign);
    throw std::runtime_error(At(path_, 0) + "no LCM log event begins here (a foreign file)");
  }
  const std::optional<std::int64_t> next = FindEvent(offset_ + 1);
  // Damage after this event is not its own.
  if (is_whole && (!next || *next >= extent.end)) return Take(extent);
  const bool is_cut =
      extent.has_sync && (extent.is_possible || num_bytes_ - offset_ < kHeaderBytes);
  if (!next && is_cut) {
    throw TruncatedLogError(
        At(path_, offset_) + "the LCM log is cut off within the event that begins here", offset_);
  }
  ++num_damaged_;
  offset_ = next.value_or(num_bytes_);
  return next ? std::optional(Take(ExtentAt(offset_))) : std::nullopt;
}

void RequireNotBeingWritten(const std::filesystem::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  struct flock lock = WholeFile(F_RDLCK);
  const bool is_asked = fcntl(descriptor, F_OFD_GETLK, &lock) == 0;
  close(descriptor);
  if (is_asked && lock.l_type != F_UNLCK)
    throw std::runtime_error(path.string() + ": is being written by another process");
}

LogWriter::LogWriter(const std::filesystem::path& path) : path_(path) {
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) Fail("open");
  try {
    struct flock lock = WholeFile(F_WRLCK);
    if (fcntl(descriptor_, F_OFD_SETLK, &lock) != 0) {
      if (errno != EAGAIN && errno != EACCES) Fail("lock");
      throw std::runtime_error(path.string() + ": is being written by another process");
    }
    CutHalfWrittenEvent();
  } catch (...) {
    close(descriptor_);
    throw;
  }
  SyncFolderOf(path);
}

LogWriter::~LogWriter() { close(descriptor_); }

void LogWriter::CutHalfWrittenEvent() {
  LogReader reader(path_);
  try {
    while (reader.Next()) {
    }
  } catch (const TruncatedLogError& error) {
    spdlog::warn("{} (cut off there, to go on)", error.what());
    CutAt(error.offset());
  }
  if (reader.num_damaged() > 0) {
    spdlog::warn("{}: {} damaged places, left as they are", path_.string(), reader.num_damaged());
  }
  num_bytes_ = reader.offset();
}

void LogWriter::Write(const LogEvent& event) {
  if (event.channel.empty() || event.channel.size() > kMaxChannelBytes) {
    throw std::invalid_argument("LCM log: channel '" + event.channel +
                                "' must have 1 to 63 characters");
  }
  const std::vector<std::uint8_t> bytes = EncodeLogEvent(event);
  std::size_t num_written = 0;
  while (num_written < bytes.size()) {
    const ssize_t num_now =
        write(descriptor_, bytes.data() + num_written, bytes.size() - num_written);
    if (num_now < 0 && errno == EINTR) continue;
    if (num_now <= 0) {
      const int cause = errno;
      const bool is_taken_back = ftruncate(descriptor_, num_bytes_) == 0;
      errno = cause;
      Fail(is_taken_back ? "write" : "write (and take back)");
    }
    num_written += static_cast<std::size_t>(num_now);
  }
  num_bytes_ += static_cast<std::int64_t>(bytes.size());
}

void LogWriter::CutAt(std::int64_t offset) {
  if (ftruncate(descriptor_, offset) != 0) Fail("cut");
  num_bytes_ = offset;
}

void LogWriter::Flush() {
  if (fsync(descriptor_) != 0) Fail("sync");
}

void LogWriter::Fail(const std::string& action) const {
  throw std::runtime_error(path_.string() + ": cannot " + action + ": " + std::strerror(errno));
}

}  // namespace voqcal
