// calibrate_lens: a camera's intrinsics from a recording of the board.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "calibrate/bag.hpp"
#include "calibrate_lens/lens_summary.hpp"
#include "calibrate_lens/rig_with_camera.hpp"
#include "common/output_file.hpp"
#include "common/progress.hpp"
#include "common/scratch_folder.hpp"
#include "common/tool_main.hpp"
#include "core/lens_calibration/lens_calibration.hpp"
#include "core/lens_calibration/lens_view.hpp"
#include "files/atomic_file.hpp"
#include "import/recorded_images.hpp"
#include "result/camera_yaml.hpp"
#include "rig/rig.hpp"
#include "rig/rig_doubts.hpp"

namespace voqcal {
namespace {

struct LensArgs {
  std::filesystem::path rig;
  std::filesystem::path log;
  BagInput bag;            ///< Instead of log.
  std::string lens_model;  ///< Empty: the rig file's.
  std::size_t max_images = 2000;
  OutputFile written;
};

/// The board in all of a recording's images.
struct SeenBoards {
  cv::Size image_px;
  std::size_t num_images = 0;
  std::map<std::string, std::size_t> without;  ///< Images by the reason for no board.
  std::vector<LensView> views;
};

void RequireSize(const Rig& rig, const cv::Size& image_px) {
  const CameraModel& camera = rig.camera;
  if ((camera.width_px == 0 || camera.width_px == image_px.width) &&
      (camera.height_px == 0 || camera.height_px == image_px.height)) {
    return;
  }
  throw std::runtime_error(
      rig.path.string() + ": camera.width_px and height_px are " + std::to_string(camera.width_px) +
      " x " + std::to_string(camera.height_px) + ", the images are " +
      std::to_string(image_px.width) + " x " + std::to_string(image_px.height) +
      " (who cuts or scales images has a lens for each size: leave both keys out, or give images "
      "of that size)");
}

SeenBoards SeeBoards(const Rig& rig, const std::filesystem::path& log, std::size_t max_images) {
  SeenBoards seen;
  Progress progress("images");
  const std::size_t num_unreadable =
      ForEachImage(log, rig.channels.camera_image, max_images, [&](const RecordedImage& image) {
        progress.Show(image.share, std::to_string(seen.views.size()) + " boards");
        ++seen.num_images;
        if (seen.image_px.empty()) {
          seen.image_px = image.grey.size();
          RequireSize(rig, seen.image_px);
        }
        if (image.grey.size() != seen.image_px) {
          ++seen.without["of another size than the first"];
          return;
        }
        auto view = SeeLensView(image.grey, rig.board, image.utime);
        if (view) {
          seen.views.push_back(std::move(*view));
        } else {
          ++seen.without[ToString(view.error().fault)];
        }
      });
  if (num_unreadable > 0) seen.without["cannot be decoded"] = num_unreadable;
  seen.num_images += num_unreadable;
  std::stable_sort(seen.views.begin(), seen.views.end(), [](const LensView& a, const LensView& b) {
    return a.utime < b.utime;
  });
  return seen;
}

void PrintImages(const SeenBoards& seen, const ViewChoice& choice) {
  std::printf("images      %zu of %d x %d px, %zu with a board, %zu of different poses\n",
              seen.num_images,
              seen.image_px.width,
              seen.image_px.height,
              seen.views.size(),
              choice.views.size());
  const auto print = [](std::size_t num, const std::string& reason) {
    if (num > 0) std::printf("left out    %zu: %s\n", num, reason.c_str());
  };
  for (const auto& [reason, num] : seen.without) print(num, reason);
  print(choice.num_moving, "the board moves");
  print(choice.num_blurred, "blurred");
  print(choice.num_repeated, "a pose that others show");
  print(choice.num_beyond, "more poses than are of use");
}

std::optional<LensModel> ModelToFind(const LensArgs& args, const LensInRig& lens) {
  if (args.lens_model.empty()) return lens.model;
  return LensModelFromString(args.lens_model);  // nothing: automatic
}

/// The rig file with the camera in it, in its section.
void WriteRig(const Rig& rig, const CameraModel& camera, const std::filesystem::path& written) {
  const bool is_by_name = !SensorsOfRig(rig.path).cameras.empty();
  const std::string name = is_by_name ? rig.camera_name : "";
  const std::string text = ReadWholeFile(PlaceOfRig(rig.path).file);
  const std::filesystem::path draft = written.string() + ".draft";
  WriteFileAtomically(draft, RigWithCamera(text, camera, name));
  try {
    // Says what lines could not tell: a key written as "camera :", say.
    LoadRig(draft.string() + (is_by_name ? "#" + name : ""), SensorChoice::kCamera);
  } catch (const std::exception&) {
    std::filesystem::remove(draft);
    throw;
  }
  std::filesystem::rename(draft, written);
  std::printf("written\n  %s\n", written.c_str());
}

/// Of a recording of ROS, an LCM log of its images, as long as this lives.
class Recording {
 public:
  Recording(const Rig& rig, const LensArgs& args) : log_(args.log) {
    if (args.bag.paths.empty()) return;
    const bool is_copy_asked_for = !args.written.path.empty();
    scratch_.emplace(is_copy_asked_for ? args.written.path
                                       : std::filesystem::temp_directory_path() / "calibrate_lens");
    log_ = ImportBag(rig, args.bag, RecordingTimes::kAuto, scratch_->path());
  }
  const std::filesystem::path& log() const { return log_; }

 private:
  std::filesystem::path log_;
  std::optional<ScratchFolder> scratch_;
};

void CalibrateLensOf(const LensArgs& args) {
  LensInRig lens;
  const Rig rig = LoadRig(args.rig, &lens);
  for (const std::string& doubt : BoardDoubts(rig.board)) spdlog::warn("{}", doubt);
  if (!args.written.path.empty()) {
    RequireSamePaths(PlaceOfRig(args.rig).file, args.written.path);
    args.written.Prepare();
  }
  const SeenBoards seen = SeeBoards(rig, Recording(rig, args).log(), args.max_images);
  ViewChoiceOptions choice_options;
  choice_options.max_still_motion_px = rig.sample_collector.max_still_motion_px;
  const ViewChoice choice = ChooseViews(seen.views, rig.board, seen.image_px, choice_options);
  PrintImages(seen, choice);

  LensCalibrationOptions options;
  options.lens = ModelToFind(args, lens);
  options.max_rms_px = rig.camera_board_detector.max_reprojection_rms_px;
  const LensCalibration calibration =
      CalibrateLens(choice.views, rig.board, seen.image_px, options);
  std::printf("%s", LensSummary(calibration, rig.board, lens.camera).c_str());
  if (!calibration.refusal.empty()) {
    const bool is_restless = choice.num_moving > choice.views.size();
    throw DemandNotMet("do not use it: " + calibration.refusal +
                       (is_restless ? " (in most others the board moves: let it rest)" : ""));
  }
  const CameraModel camera = Rounded(calibration.best->fit.camera);
  std::printf("for the rig file\ncamera:\n%s", CameraYaml(camera, "  ").c_str());
  if (!args.written.path.empty()) WriteRig(rig, camera, args.written.path);
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Finds a camera's intrinsics (focal lengths, principal point, distortion) from a recording "
      "of the board: 20 or more poses, near, all over the image, tilted each way, at rest. The rig "
      "file needs the board's numbers; the camera's may be missing.\n"
      "Exit status: 0 found; 1 and 2 errors; 3 it should not be used, and why.",
      "calibrate_lens");
  voqcal::LensArgs args;
  args.bag.has_images_only = true;
  app.add_option("rig",
                 args.rig,
                 "The rig file (YAML): board and channels; of one with cameras by name FILE#CAMERA")
      ->required();
  auto* input = app.add_option_group("input", "One of:");
  input->add_option(
      "--log", args.log, "A recording (LCM log), a session's samples.lcm, or a folder of images");
  auto* bag = input->add_option("--bag",
                                args.bag.paths,
                                "A recording of ROS 1 or 2: .bag, .mcap, .db3, their folder; "
                                "several files if it is split");
  input->require_option(1);
  app.add_option("--image-topic", args.bag.image_topic, "Of --bag, unless there is only one")
      ->needs(bag);
  app.add_option("--lens-model",
                 args.lens_model,
                 "By default the rig file's, or automatic: the simplest that predicts images held "
                 "out as well as any")
      ->check(CLI::IsMember({"automatic", "equidistant", "plumb_bob", "rational"}));
  app.add_option("--max-images", args.max_images, "Looked at, spread over the recording")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option(
      "--write", args.written.path, "Write a copy of the rig file with the camera in it");
  app.add_flag("--force", args.written.is_forced, "Overwrite that file");
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::CalibrateLensOf(args); });
}
