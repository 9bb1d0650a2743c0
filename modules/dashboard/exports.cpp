#include "dashboard/exports.hpp"

#include <stdexcept>

#include "files/atomic_file.hpp"
#include "result/extrinsic_text.hpp"
#include "result/result_file.hpp"

namespace voqcal {
namespace {

constexpr char kText[] = "text/plain; charset=utf-8";

/// The ending by which other programs know the format.
std::string EndingOf(const std::string& format) {
  if (format == "urdf") return ".urdf";
  if (format == "bot_frames") return ".cfg";
  if (format == "mrcal") return ".cameramodel";
  const bool is_command = format.compare(0, 3, "ros") == 0;
  return is_command ? ".txt" : ".yaml";
}

}  // namespace

std::map<std::string, StaticFile> ExportsOf(const std::filesystem::path& result_file,
                                            const std::string& samples_sha256,
                                            const CameraModel& camera) {
  // Read once: the assessor may put another in its place at any time.
  const std::string text = ReadWholeFile(result_file);
  if (LogSha256Of(text, result_file.string()) != samples_sha256) {
    throw std::runtime_error(result_file.string() + ": is made from other samples");
  }
  std::map<std::string, StaticFile> exports;
  ExportedExtrinsic extrinsic;
  extrinsic.T_child_parent = ExtrinsicOf(text, result_file.string());
  extrinsic.camera = camera;
  exports["extrinsic.yaml"] = {kText, text, true};
  for (const std::string& format : ExportFormats()) {
    if (!FormatProblem(format, extrinsic).empty()) continue;  // mrcal has no fisheye
    exports["extrinsic_" + format + EndingOf(format)] = {
        kText, ExtrinsicText(format, extrinsic), true};
  }
  return exports;
}

}  // namespace voqcal
