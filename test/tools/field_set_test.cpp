// `voqcal_figures field` in small: recordings of other people, of which nothing may be taken
// wrongly.

#include "figures/field_set.hpp"

#include <gtest/gtest.h>

#include "support/real_data.hpp"

namespace voqcal {
namespace {

// Boards that are seen in part, by a dome lidar and by a VLP-16 that looks down on them.
TEST(MeasureFieldSet, TakesBoardsThatAreSeenInPart) {
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  for (const char* name : {"yoco_bpearl_1", "basem_vlp16_zed"}) {
    const FieldSet set = MeasureFieldSet(*data / "field" / name);
    EXPECT_GE(set.num_consistent, 3u) << name;
    EXPECT_EQ(set.NumWrong(), 0u) << name;
  }
}

}  // namespace
}  // namespace voqcal
