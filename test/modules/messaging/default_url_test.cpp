// Neither rig nor messaging knows the other, yet both have a default URL: here they meet.
#include <gtest/gtest.h>

#include "messaging/bus.hpp"
#include "rig/rig.hpp"

namespace voqcal {
namespace {

TEST(DefaultUrl, OfARigFileIsThatOfABus) { EXPECT_STREQ(kDefaultRigLcmUrl, kDefaultLcmUrl); }

}  // namespace
}  // namespace voqcal
