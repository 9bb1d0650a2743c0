#include "files/atomic_file.hpp"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::HasSubstr;

int NumFiles(const std::filesystem::path& folder) {
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    num_files += entry.exists() ? 1 : 0;
  }
  return num_files;
}

TEST(WriteFileAtomically, ReplacesAFileAndLeavesNothingElse) {
  const test::TemporaryFolder folder;
  const std::string zeros("a\0b\n", 4);
  WriteFileAtomically(folder.path() / "file", "first");
  WriteFileAtomically(folder.path() / "file", zeros);
  EXPECT_EQ(ReadWholeFile(folder.path() / "file"), zeros);
  EXPECT_EQ(NumFiles(folder.path()), 1);
}

TEST(WriteFileAtomically, NamesAMissingFolder) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "none" / "file";
  EXPECT_EQ(test::ErrorOf([&] { WriteFileAtomically(path, "x"); }),
            path.string() + ": cannot be written: No such file or directory");
}

TEST(WriteFileAtomically, LeavesNothingWhereTheTargetIsAFolder) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "taken");
  EXPECT_THAT(test::ErrorOf([&] { WriteFileAtomically(folder.path() / "taken", "x"); }),
              HasSubstr("taken: cannot be replaced: Is a directory"));
  EXPECT_EQ(NumFiles(folder.path()), 1);
}

// A limit on the size of files fails in write() half-way, as a full disk does.
TEST(WriteFileAtomically, KeepsTheOldFileWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "file";
  WriteFileAtomically(path, "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1000, before.rlim_max};
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error =
      test::ErrorOf([&] { WriteFileAtomically(path, std::string(100000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(error, path.string() + ": cannot be written: File too large");
  EXPECT_EQ(ReadWholeFile(path), "old");
  EXPECT_EQ(NumFiles(folder.path()), 1);
}

TEST(ReadWholeFile, NamesWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(test::ErrorOf([&] { ReadWholeFile(folder.path()); }),
            folder.path().string() + ": cannot be read: Is a directory");
  EXPECT_EQ(test::ErrorOf([&] { ReadWholeFile(folder.path() / "none"); }),
            (folder.path() / "none").string() + ": cannot be read: No such file or directory");
}

}  // namespace
}  // namespace voqcal
