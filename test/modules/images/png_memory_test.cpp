// libpng where memory runs out: its functions are replaced in this program.
#include <stdexcept>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <png.h>

#include "images/png.hpp"
#include "modules/images/encoded_files.hpp"

namespace {

bool g_is_out_of_memory = false;
int g_num_destroyed = 0;

template <typename Function>
Function* TheRealOne(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" png_infop png_create_info_struct(png_const_structrp png) {
  if (g_is_out_of_memory) return nullptr;
  return TheRealOne<png_infop(png_const_structrp)>("png_create_info_struct")(png);
}

extern "C" void png_destroy_read_struct(png_structpp png, png_infopp info, png_infopp end) {
  ++g_num_destroyed;
  TheRealOne<void(png_structpp, png_infopp, png_infopp)>("png_destroy_read_struct")(png, info, end);
}

namespace voqcal {
namespace {

TEST(DecodePng, LeavesNothingBehindWhenTheSecondAllocationFails) {
  const auto png = test::PngFile(8, 8, {});
  g_is_out_of_memory = true;
  g_num_destroyed = 0;
  EXPECT_THROW(DecodePng(png), std::runtime_error);
  EXPECT_EQ(g_num_destroyed, 1);
  g_is_out_of_memory = false;
  EXPECT_EQ(DecodePng(png).cols, 8);
  EXPECT_EQ(g_num_destroyed, 2);
}

}  // namespace
}  // namespace voqcal
