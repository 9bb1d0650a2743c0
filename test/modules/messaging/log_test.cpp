#include "messaging/log.hpp"

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <sys/resource.h>

namespace voqcal {
namespace {

using testing::HasSubstr;

/// A file of this test alone, gone before and after it.
class LogFile : public testing::Test {
 protected:
  LogFile() { std::filesystem::remove(path_); }
  ~LogFile() override { std::filesystem::remove(path_); }

  static LogEvent Event(std::int64_t number) {
    LogEvent event;
    event.number = number;
    event.utime = 1'700'000'000'000'000 + number;
    event.channel = "CHANNEL_" + std::to_string(number);
    event.bytes.assign(static_cast<std::size_t>(10 * number), static_cast<std::uint8_t>(number));
    return event;
  }

  void Write(int first, int last) const {
    LogWriter writer(path_);
    for (int i = first; i <= last; ++i) writer.Write(Event(i));
    writer.Flush();
  }

  std::string Contents() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  void SetContents(const std::string& contents) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << contents;
  }

  std::vector<LogEvent> Read() const {
    LogReader reader(path_);
    std::vector<LogEvent> events;
    while (auto event = reader.Next()) events.push_back(*event);
    return events;
  }

  void ExpectEvents(int last) const {
    const auto events = Read();
    ASSERT_EQ(events.size(), static_cast<std::size_t>(last));
    for (int i = 1; i <= last; ++i) {
      const LogEvent& event = events[static_cast<std::size_t>(i - 1)];
      EXPECT_EQ(event.number, i);
      EXPECT_EQ(event.utime, Event(i).utime);
      EXPECT_EQ(event.channel, Event(i).channel);
      EXPECT_EQ(event.bytes, Event(i).bytes);
    }
  }

  std::string path_ = testing::TempDir() + "voqcal_log_test_" +
                      testing::UnitTest::GetInstance()->current_test_info()->name() + ".lcm";
};

TEST_F(LogFile, ComesBackExactly) {
  Write(1, 3);
  ExpectEvents(3);
}

TEST_F(LogFile, HasTheSameBytesEachTime) {
  Write(1, 3);
  const std::string once = Contents();
  std::filesystem::remove(path_);
  Write(1, 1);
  Write(2, 3);
  EXPECT_EQ(Contents(), once);
}

TEST_F(LogFile, IsReadByLcm) {
  Write(1, 3);
  lcm::LogFile log(path_, "r");
  for (int i = 1; i <= 3; ++i) {
    const lcm::LogEvent* event = log.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, i);
    EXPECT_EQ(event->timestamp, Event(i).utime);
    EXPECT_EQ(event->channel, Event(i).channel);
    EXPECT_EQ(event->datalen, 10 * i);
  }
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST_F(LogFile, OfLcmIsRead) {
  {
    lcm::LogFile log(path_, "w");
    for (int i = 1; i <= 2; ++i) {
      LogEvent ours = Event(i);
      lcm::LogEvent event{};
      event.timestamp = ours.utime;
      event.channel = ours.channel;
      event.data = ours.bytes.data();
      event.datalen = static_cast<std::int32_t>(ours.bytes.size());
      ASSERT_EQ(log.writeEvent(&event), 0);
    }
  }
  const auto events = Read();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1].utime, Event(2).utime);
  EXPECT_EQ(events[1].channel, Event(2).channel);
  EXPECT_EQ(events[1].bytes, Event(2).bytes);
}

TEST_F(LogFile, MayBeEmpty) {
  SetContents("");
  EXPECT_TRUE(Read().empty());
  Write(1, 1);
  ExpectEvents(1);
}

TEST_F(LogFile, IsToldToBeCutOffWhereverTheCutIs) {
  Write(1, 2);
  const std::string whole = Contents();
  const auto first_bytes = static_cast<std::size_t>(28 + 9 + 10);
  for (std::size_t n = first_bytes + 1; n < whole.size(); ++n) {
    SetContents(whole.substr(0, n));
    LogReader reader(path_);
    EXPECT_TRUE(reader.Next());
    try {
      reader.Next();
      FAIL() << n;
    } catch (const TruncatedLogError& error) {
      EXPECT_EQ(error.offset(), static_cast<std::int64_t>(first_bytes));
      EXPECT_THAT(error.what(), HasSubstr(path_ + ": byte 47: "));
    }
  }
}

TEST_F(LogFile, GoesOnAfterACut) {
  Write(1, 3);
  const std::string whole = Contents();
  for (std::size_t n = 0; n < whole.size(); n += 7) {
    SetContents(whole.substr(0, n));
    int num_kept = 0;
    {
      const LogWriter writer(path_);
      num_kept = static_cast<int>(Read().size());
    }
    Write(num_kept + 1, 3);
    EXPECT_EQ(Contents(), whole) << n;
  }
}

TEST_F(LogFile, OfAnotherKindIsRefusedAndLeftAlone) {
  for (const std::string& contents :
       {std::string("# .PCD v0.7 - Point Cloud Data file format"), std::string(4000, '\0')}) {
    SetContents(contents);
    EXPECT_THROW(Read(), std::runtime_error);
    EXPECT_THROW(LogWriter{path_}, std::runtime_error);
    EXPECT_EQ(Contents(), contents);
  }
  SetContents("\x1F\x8B\x08...");
  try {
    Read();
    ADD_FAILURE() << "must be refused";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("gunzip"), std::string::npos) << error.what();
  }
}

TEST_F(LogFile, IsReadAroundDamageInItsMiddle) {
  Write(1, 3);
  const std::string whole = Contents();
  constexpr std::size_t kSecond = 47;
  const auto damage = [&](std::size_t at, const std::string& bytes) {
    std::string damaged = whole;
    damaged.replace(at, bytes.size(), bytes);
    SetContents(damaged);
  };
  const auto numbers = [this] {
    LogReader reader(path_);
    std::vector<std::int64_t> read;
    while (const auto event = reader.Next()) read.push_back(event->number);
    EXPECT_EQ(reader.num_damaged(), 1);
    EXPECT_EQ(reader.offset(), reader.num_bytes());
    return read;
  };
  const std::vector<std::int64_t> first_and_third = {1, 3};
  damage(kSecond, "?");  // its sync word
  EXPECT_EQ(numbers(), first_and_third);
  damage(kSecond + 20, "\x01");  // a channel name of 16 MB
  EXPECT_EQ(numbers(), first_and_third);
  damage(kSecond + 24, "\x7F");  // 2 GB of data: beyond the file's end
  EXPECT_EQ(numbers(), first_and_third);
  damage(kSecond + 27, "\x40");  // data that reach into the third event
  EXPECT_EQ(numbers(), first_and_third);
  damage(kSecond + 27, "\x01");                                // data that end too early
  EXPECT_EQ(numbers(), (std::vector<std::int64_t>{1, 2, 3}));  // cut short, but an event
  const std::size_t third = whole.size() - (28 + 9 + 30);
  damage(third, std::string(20, '\0'));  // the last
  EXPECT_EQ(numbers(), (std::vector<std::int64_t>{1, 2}));
}

TEST_F(LogFile, GoesOnAfterDamageInItsMiddleAndCutsNothing) {
  Write(1, 3);
  std::string damaged = Contents();
  damaged[47 + 24] = 0x7F;  // the second event claims 2 GB
  SetContents(damaged);
  Write(4, 4);
  EXPECT_EQ(Contents().substr(0, damaged.size()), damaged);
  const auto events = Read();
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[2].number, 4);
}

TEST_F(LogFile, ThatIsMissingOrAFolderIsRefusedByName) {
  try {
    const LogReader reader(path_);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(path_ + ": no such file"));
  }
  EXPECT_THROW(LogReader{testing::TempDir()}, std::runtime_error);
  EXPECT_THROW(LogWriter{testing::TempDir()}, std::runtime_error);
}

TEST_F(LogFile, HasOneWriter) {
  const LogWriter writer(path_);
  try {
    const LogWriter second(path_);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("another process"));
  }
}

TEST_F(LogFile, TakesNoImpossibleChannel) {
  LogWriter writer(path_);
  LogEvent event = Event(1);
  event.channel.clear();
  EXPECT_THROW(writer.Write(event), std::invalid_argument);
  event.channel.assign(64, 'A');
  EXPECT_THROW(writer.Write(event), std::invalid_argument);
}

// A limit on the file's size fails a write half-way, as a full disk does.
TEST_F(LogFile, TakesBackAnEventThatDidNotFit) {
  Write(1, 2);
  const std::string whole = Contents();
  struct rlimit before {};
  getrlimit(RLIMIT_FSIZE, &before);
  struct rlimit limit = before;
  limit.rlim_cur = whole.size() + 30;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  std::string cause;
  try {
    LogWriter writer(path_);
    writer.Write(Event(3));
  } catch (const std::runtime_error& error) {
    cause = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(cause, HasSubstr(path_ + ": cannot write"));
  EXPECT_EQ(Contents(), whole);
}

}  // namespace
}  // namespace voqcal
