#include "rig/rig.hpp"

#include <arpa/inet.h>
#include <spdlog/spdlog.h>

#include "core/problems.hpp"
#include "files/atomic_file.hpp"
#include "files/sha256.hpp"
#include "rig/rig_sections.hpp"

namespace voqcal {

std::vector<std::string> LidarDriverOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("rate_hz", rate_hz);
  return problems.lines();
}

std::vector<std::string> CameraDriverOptions::Problems() const {
  ProblemList problems;
  problems.RequirePositive("rate_hz", rate_hz);
  problems.Require(
      jpeg_quality >= 1 && jpeg_quality <= 100, "jpeg_quality must be 1 to 100", jpeg_quality);
  const int num_named = !device.empty() + !pipeline.empty() + !url.empty();
  if (source == Source::kVideo && num_named != 1) {
    problems.Add(
        {"source video needs one of device, pipeline and url, has " + std::to_string(num_named)});
  }
  problems.RequirePositive("retry_s", retry_s);
  return problems.lines();
}

std::vector<std::string> LidarSensorOptions::Problems() const {
  ProblemList problems;
  problems.Add(packets.Problems());
  in_addr parsed{};
  problems.Require(inet_pton(AF_INET, address.c_str(), &parsed) == 1,
                   "address must be an IPv4 address of this host",
                   '"' + address + '"');
  problems.Require(!packets.protocol->needs_calibration || !calibration.empty(),
                   "calibration must name " + packets.protocol->calibration + " of this " +
                       packets.protocol->title,
                   "not given");
  problems.Require(port >= 0 && port <= 65535, "port must be 0 to 65535", port);
  return problems.lines();
}

CalibrationTask Rig::Task() const {
  return {board,
          camera,
          {consistency,
           voq_selector,
           extrinsic_estimator,
           average,
           extrinsic_refiner,
           scene_check,
           diagnosis,
           pose_guide.enough}};
}

namespace {

Rig Load(const std::filesystem::path& path, LensInRig* lens) {
  const std::string text = ReadWholeFile(path);
  YamlDocument document(path.string(), text);
  Rig rig;
  rig.path = path;
  rig.sha256 = Sha256OfBytes(text);
  ReadRigSections(&document, &rig, lens);
  document.ThrowIfWrong();
  rig.remarks = document.Remarks();
  for (const std::string& remark : rig.remarks) spdlog::warn(remark);
  return rig;
}

}  // namespace

Rig LoadRig(const std::filesystem::path& path) { return Load(path, nullptr); }

Rig LoadRig(const std::filesystem::path& path, LensInRig* lens) { return Load(path, lens); }

}  // namespace voqcal
