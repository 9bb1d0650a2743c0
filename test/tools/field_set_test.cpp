// `voqcal_figures field` in small: recordings of other people, of which nothing may be taken
// wrongly.

#include "figures/field_set.hpp"

#include <gtest/gtest.h>

#include "support/real_data.hpp"
#include "support/sanitizers.hpp"

namespace voqcal {
namespace {

struct Expected {
  const char* name;
  std::size_t num_samples;
};

// Of lce_rles02_frame's 28, one image has another size than its camera's and one pose comes twice.
TEST(MeasureFieldSet, MakesSamplesOfOtherPeoplesBoards) {
  VOQCAL_LEAVE_TO_RELEASE();
  const auto data = test::RealDataFolder();
  if (!data) GTEST_SKIP() << "no real data on this machine";
  constexpr Expected kSets[] = {{"basem_vlp16_zed", 5},
                                {"lce_handheld_os1_128_roi", 15},
                                {"lce_rles02_frame", 26},
                                {"lce_rlfs01_vlp16", 18},
                                {"squirrel_bpearl", 6},
                                {"yingna_vlp16", 11},
                                {"yoco_bpearl_1", 6},
                                {"zhixy_tls", 8}};
  for (const Expected& expected : kSets) {
    const FieldSet set = MeasureFieldSet(*data / "field" / expected.name);
    EXPECT_GE(set.num_samples, expected.num_samples) << expected.name;
    EXPECT_GE(set.num_consistent, expected.num_samples * 4 / 5) << expected.name;
    EXPECT_EQ(set.NumWrong(), 0u) << expected.name;
  }
}

}  // namespace
}  // namespace voqcal
