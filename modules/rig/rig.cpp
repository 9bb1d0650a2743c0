#include "rig/rig.hpp"

#include <arpa/inet.h>

#include "rig/atomic_file.hpp"
#include "rig/rig_sections.hpp"
#include "rig/sha256.hpp"

namespace voqcal {

std::vector<std::string> DriverOptions::Problems() const {
  std::vector<std::string> problems;
  if (!(rate_hz > 0)) problems.push_back("rate_hz must be positive, is " + std::to_string(rate_hz));
  if (jpeg_quality < 1 || jpeg_quality > 100) {
    problems.push_back("jpeg_quality must be 1 to 100, is " + std::to_string(jpeg_quality));
  }
  const int num_named = !device.empty() + !pipeline.empty() + !url.empty();
  if (source == DriverSource::kVideo && num_named != 1) {
    problems.push_back("source video needs one of device, pipeline and url, has " +
                       std::to_string(num_named));
  }
  if (!(retry_s > 0)) problems.push_back("retry_s must be positive, is " + std::to_string(retry_s));
  return problems;
}

int LidarSensorOptions::Port() const {
  constexpr int kVlp16Port = 2368;
  constexpr int kSpectrumScanPort = 5044;
  if (port != 0) return port;
  return packets.model == LidarModel::kVlp16 ? kVlp16Port : kSpectrumScanPort;
}

std::vector<std::string> LidarSensorOptions::Problems() const {
  std::vector<std::string> problems = packets.Problems();
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) {
    problems.push_back("address must be an IPv4 address of this host, is \"" + address + '"');
  }
  if (port < 0 || port > 65535) {
    problems.push_back("port must be 0 to 65535, is " + std::to_string(port));
  }
  return problems;
}

Rig LoadRig(const std::filesystem::path& path) {
  const std::string text = ReadWholeFile(path);
  YamlDocument document(path.string(), text);
  Rig rig;
  rig.path = path;
  rig.sha256 = Sha256OfBytes(text);
  ReadRigSections(&document, &rig);
  document.ThrowIfWrong();
  return rig;
}

}  // namespace voqcal
