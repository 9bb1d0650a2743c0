// A JPEG or PNG, as a driver passes it on, a detector decodes it and the dashboard makes it small.
#include "dashboard/sensor_frames.hpp"
#include "fuzz/fuzz_input.hpp"
#include "images/encoded_image.hpp"
#include "messaging/convert_image.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int kMaxPixels = 1 << 20;  // larger ones take long and are no different
  const std::vector<std::uint8_t> bytes(data, data + size);
  const auto info = voqcal::InspectEncodedImage(bytes);
  if (info && std::int64_t{info->width_px} * info->height_px > kMaxPixels) return 0;
  voqcal::fuzz::Tolerate([&bytes] { voqcal::FromMessage(voqcal::EncodedToMessage(bytes, 0, 0)); });
  voqcal::DashboardOptions options;
  options.max_image_width_px = 16;  // less than the corpus has
  voqcal::fuzz::Tolerate(
      [&bytes, &options] { voqcal::ForPage(voqcal::EncodedToMessage(bytes, 0, 0), options); });
  return 0;
}
