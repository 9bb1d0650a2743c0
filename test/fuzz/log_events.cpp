// An LCM log, read to its end and then gone on with.
#include <spdlog/spdlog.h>

#include "fuzz/fuzz_input.hpp"
#include "messaging/log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  spdlog::set_level(spdlog::level::off);
  const auto path = voqcal::fuzz::AsFile({data, size}, "log.lcm");
  voqcal::fuzz::Tolerate([&path] {
    voqcal::LogReader reader(path);
    while (reader.Next()) {
    }
  });
  voqcal::fuzz::Tolerate([&path] {
    voqcal::LogWriter writer(path);
    writer.Write({1, 2, "CHANNEL", {3, 4}});
  });
  return 0;
}
