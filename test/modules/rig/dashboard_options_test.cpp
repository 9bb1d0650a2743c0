#include "rig/dashboard_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voqcal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(DashboardOptionsProblems, AreNoneByDefaultAndForEveryAddress) {
  DashboardOptions options;
  EXPECT_THAT(options.Problems(), IsEmpty());
  for (const char* address : {"0.0.0.0", "192.168.1.7", "::1", "::"}) {
    options.address = address;
    EXPECT_THAT(options.Problems(), IsEmpty()) << address;
  }
}

TEST(DashboardOptionsProblems, NameEachBrokenRuleAndItsValue) {
  DashboardOptions options;
  options.address = "localhost";
  options.port = 65536;
  options.image_rate_hz = 0;
  options.cloud_rate_hz = -1;
  options.max_image_width_px = 10;
  options.max_cloud_points = 0;
  EXPECT_THAT(options.Problems(),
              ElementsAre(HasSubstr("address must be an IP address, is 'localhost'"),
                          HasSubstr("port must be 0 to 65535, is 65536"),
                          HasSubstr("image_rate_hz"),
                          HasSubstr("cloud_rate_hz"),
                          HasSubstr("max_image_width_px must be at least 64, is 10"),
                          HasSubstr("max_cloud_points")));
}

}  // namespace
}  // namespace voqcal
