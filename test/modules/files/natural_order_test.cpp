#include "files/natural_order.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(IsNaturallyLess, CountsNumbersOfAnyLength) {
  EXPECT_TRUE(IsNaturallyLess("pose2", "pose10"));
  EXPECT_FALSE(IsNaturallyLess("pose10", "pose2"));
  EXPECT_TRUE(IsNaturallyLess("a1b9", "a1b10"));
  EXPECT_TRUE(IsNaturallyLess("99999999999999999998", "99999999999999999999"));
  EXPECT_TRUE(IsNaturallyLess("a", "a1"));
  EXPECT_TRUE(IsNaturallyLess("0", "00"));
  EXPECT_FALSE(IsNaturallyLess("same7", "same7"));
}

// A strict total order, or std::sort is undefined: exactly one of a < b, b < a, a == b.
TEST(IsNaturallyLess, IsATotalOrder) {
  std::vector<std::string> names = {
      "", "0", "00", "1", "01", "a", "a0", "a00b1", "a0b01", "a0b1", "b"};
  std::sort(names.begin(), names.end(), IsNaturallyLess);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      EXPECT_EQ(IsNaturallyLess(names[i], names[j]), i < j) << names[i] << ' ' << names[j];
    }
  }
}

TEST(FilesInNaturalOrder, TakesTheExtensionsOnly) {
  const test::TemporaryFolder folder;
  for (const char* name : {"pose10.png", "pose2.PNG", "pose1.jpg", "pose3.txt"})
    folder.Write(name, "");
  std::filesystem::create_directory(folder.path() / "pose4.png");
  std::vector<std::string> names;
  for (const auto& file : FilesInNaturalOrder(folder.path(), {".png", ".jpg"})) {
    names.push_back(file.filename().string());
  }
  EXPECT_THAT(names, ElementsAre("pose1.jpg", "pose2.PNG", "pose10.png"));
}

TEST(FilesInNaturalOrder, NamesAFolderThatIsMissingOrEmpty) {
  const test::TemporaryFolder folder;
  const auto error_of = [](const std::filesystem::path& path) {
    return test::ErrorOf([&] { FilesInNaturalOrder(path, {".pcd", ".ply"}); });
  };
  EXPECT_EQ(error_of(folder.path()),
            folder.path().string() + ": has no file that ends in .pcd, .ply");
  EXPECT_THAT(error_of(folder.path() / "none"),
              HasSubstr("none: cannot be read as a folder: No such"));
}

}  // namespace
}  // namespace voqcal
