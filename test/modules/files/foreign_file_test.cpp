#include "files/foreign_file.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

TEST(ForeignFileText, NamesTheRemedy) {
  const test::TemporaryFolder folder;
  const auto text_of = [&](const std::string& bytes) {
    return ForeignFileText(folder.Write("file", bytes));
  };
  EXPECT_EQ(text_of("\x1F\x8B\x08..."), "is compressed: unpack it first (gunzip)");
  EXPECT_EQ(text_of("\x28\xB5\x2F\xFD..."), "is compressed: unpack it first (unzstd)");
  EXPECT_EQ(text_of("\x89MCAP0"), "is a recording of ROS: calibrate --bag reads it");
  EXPECT_EQ(text_of("only words"), "");
  EXPECT_EQ(text_of(""), "");
  EXPECT_EQ(ForeignFileText(folder.path() / "missing"), "");
}

}  // namespace
}  // namespace voqcal
