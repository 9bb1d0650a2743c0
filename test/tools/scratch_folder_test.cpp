#include "common/scratch_folder.hpp"

#include <csignal>
#include <fstream>

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace voqcal {
namespace {

namespace fs = std::filesystem;

TEST(ScratchFolder, IsGoneAfterItsScopeWithWhatIsInIt) {
  const test::TemporaryFolder folder;
  {
    const ScratchFolder scratch(folder.path() / "made" / "out");
    std::ofstream(scratch.path() / "file") << "text";
    EXPECT_TRUE(fs::exists(scratch.path() / "file"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(ScratchFolder, IsGoneAfterASignalThatStillEndsTheProcess) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const test::TemporaryFolder folder;
    EXPECT_EXIT(
        {
          const ScratchFolder scratch(folder.path() / "out");
          std::ofstream(scratch.path() / "file") << "text";
          const ScratchFolder within(scratch.path() / "more");
          raise(signal);
        },
        ::testing::KilledBySignal(signal),
        "");
    EXPECT_TRUE(fs::is_empty(folder.path())) << signal;
  }
}

TEST(ScratchFolder, LeavesSignalsAloneAfterItsScope) {
  EXPECT_EXIT(
      {
        const test::TemporaryFolder folder;
        { const ScratchFolder scratch(folder.path() / "out"); }
        raise(SIGTERM);
      },
      ::testing::KilledBySignal(SIGTERM),
      "");
}

}  // namespace
}  // namespace voqcal
