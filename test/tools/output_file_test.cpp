#include "common/output_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

using ::testing::EndsWith;

TEST(OutputFile, IsNotOverwrittenUnlessForced) {
  const test::TemporaryFolder folder;
  OutputFile file{folder.Write("raw.lcm", "precious"), false};
  EXPECT_THAT(test::ErrorOf([&] { file.Prepare(); }),
              EndsWith("raw.lcm: is there already (--force overwrites it)"));
  file.is_forced = true;
  EXPECT_NO_THROW(file.Prepare());
}

TEST(OutputFile, IsNoFolder) {
  const test::TemporaryFolder folder;
  const OutputFile file{folder.path(), true};
  EXPECT_THAT(test::ErrorOf([&] { file.Prepare(); }), EndsWith(": is a folder"));
}

TEST(OutputFile, GetsItsFolders) {
  const test::TemporaryFolder folder;
  const OutputFile file{folder.path() / "a" / "b" / "raw.lcm", false};
  file.Prepare();
  EXPECT_TRUE(std::filesystem::is_directory(folder.path() / "a" / "b"));
  const OutputFile below_a_file{folder.Write("file", "") / "raw.lcm", false};
  EXPECT_THAT(test::ErrorOf([&] { below_a_file.Prepare(); }),
              EndsWith("file: cannot make the folder: Not a directory"));
}

}  // namespace
}  // namespace voqcal
