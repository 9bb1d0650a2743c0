// draft_rig: a rig file from what a recording says, and the numbers that it cannot say.

#include <filesystem>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <spdlog/spdlog.h>

#include "common/output_file.hpp"
#include "common/tool_main.hpp"
#include "core/format.hpp"
#include "core/lens_calibration/lens_calibration.hpp"
#include "core/lens_calibration/lens_view.hpp"
#include "draft_rig/rig_draft.hpp"
#include "files/atomic_file.hpp"
#include "import/camera_file.hpp"
#include "import/recorded_images.hpp"

namespace voqcal {
namespace {

struct DraftArgs {
  std::filesystem::path recording;
  std::vector<std::string> numbers;  ///< "board.width_m=0.61"
  std::filesystem::path camera;      ///< Empty: looked for.
  OutputFile out;
};

constexpr std::size_t kMaxImages = 60;  // more tell no more of a lens

// A draft is better than none: calibrate_lens demands more.
LensCalibrationOptions LensDemands() {
  LensCalibrationOptions options;
  options.min_views = 5;
  options.max_sigma = 0.05;
  return options;
}

std::string NameOf(const std::filesystem::path& recording) {
  const std::filesystem::path whole = std::filesystem::absolute(recording).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).stem().string();
}

void RequireBoard(const DraftArgs& args, const RigDraft& draft) {
  const std::string missing = draft.MissingOfBoard();
  if (missing.empty()) return;
  throw std::runtime_error(
      args.recording.string() +
      ": no recording says how large the board is. Measure it and add, with your numbers:" +
      missing +
      "\n(A pattern that is not in the plate's middle: board.pattern_offset_x_m, _y_m. A ChArUco "
      "board: board.pattern=charuco.)");
}

// Whoever gives one of these gives the camera: what is still missing is then told by its name.
bool HasNumbersOfCamera(const RigDraft& draft) {
  for (const char* key : {"lens_model", "fx_px", "fy_px", "cx_px", "cy_px", "distortion"}) {
    if (draft.Has("camera", key)) return true;
  }
  return false;
}

// What the board's numbers are, and the channels, before there is a camera.
Rig WithAnyCamera(RigDraft draft) {
  CameraModel any;
  any.width_px = 640;
  any.height_px = 480;
  any.fx_px = any.fy_px = 500.0;
  any.cx_px = 320.0;
  any.cy_px = 240.0;
  draft.Add(any, "");
  return draft.Read();
}

void AddEstimatedCamera(const DraftArgs& args, RigDraft* draft) {
  const Rig rig = WithAnyCamera(*draft);
  cv::Size image_px;
  std::size_t num_images = 0;
  std::vector<LensView> boards;
  ForEachImage(
      args.recording, rig.channels.camera_image, kMaxImages, [&](const RecordedImage& image) {
        ++num_images;
        if (image_px.empty()) image_px = image.grey.size();
        if (image.grey.size() != image_px) return;
        if (auto view = SeeLensView(image.grey, rig.board, image.utime)) boards.push_back(*view);
      });
  const LensCalibration found = CalibrateLens(
      ChooseViews(boards, rig.board, image_px, {}).views, rig.board, image_px, LensDemands());
  if (!found.refusal.empty()) {
    throw std::runtime_error(
        args.recording.string() +
        ": the camera's numbers are not given, and cannot be estimated: " +
        std::to_string(boards.size()) + " of " + std::to_string(num_images) + " images (" +
        std::to_string(image_px.width) + " x " + std::to_string(image_px.height) +
        ") show a board of " + std::to_string(rig.board.num_corners_x) + " x " +
        std::to_string(rig.board.num_corners_y) + " corners; " + found.refusal +
        ". Check board.num_corners_x and _y, or give the file of the "
        "camera's calibration (--camera FILE), or its numbers:" +
        "\n  camera.fx_px=900 camera.fy_px=900  focal lengths, pixels"
        "\n  camera.cx_px=640 camera.cy_px=360  principal point"
        "\n  camera.lens_model=plumb_bob        or rational, equidistant (a fisheye)"
        "\n  camera.distortion=[-0.4,0.2,0,0,0] k1 k2 p1 p2 k3; of a fisheye k1 k2 k3 k4");
  }
  const LensFit& fit = found.best->fit;
  const std::string words =
      Format("estimated from %zu boards in these images: %.2f px RMS, fx %.1f +- %.1f px",
             found.views.size(),
             fit.rms_px,
             fit.camera.fx_px,
             fit.Sigma(0));
  spdlog::warn(
      "no camera is given: its intrinsics are {}. The result can be no better than they are: a "
      "recording for the camera alone (calibrate_lens), or a calibration that you have (--camera "
      "FILE), is better.",
      words);
  draft->Add(fit.camera, words);
}

void AddImageSize(const DraftArgs& args, RigDraft* draft) {
  if (draft->Has("camera", "width_px") && draft->Has("camera", "height_px")) return;
  const std::string channel = WithAnyCamera(*draft).channels.camera_image;
  ForEachImage(args.recording, channel, 1, [&](const RecordedImage& image) {
    draft->AddDefault("camera", "width_px", std::to_string(image.grey.cols));
    draft->AddDefault("camera", "height_px", std::to_string(image.grey.rows));
  });
}

// By the names that other programs give it.
std::optional<std::filesystem::path> FindCameraFile(const std::filesystem::path& session) {
  for (const char* name : {"camera.yaml", "camera_info.yaml", "ost.yaml", "camchain.yaml"}) {
    if (std::filesystem::is_regular_file(session / name)) return session / name;
  }
  return {};
}

void AddCamera(const DraftArgs& args, RigDraft* draft) {
  if (args.camera.empty() && HasNumbersOfCamera(*draft)) return AddImageSize(args, draft);
  std::optional<std::filesystem::path> file = FindCameraFile(args.recording);
  if (!args.camera.empty()) file = args.camera;
  if (file) return draft->Add(ReadCameraFile(*file), "from " + file->filename().string());
  AddEstimatedCamera(args, draft);
}

void DraftRig(const DraftArgs& args) {
  RigDraft draft(NameOf(args.recording));
  for (const std::string& number : args.numbers) draft.Add(number);
  if (!std::filesystem::exists(args.recording)) {
    throw std::runtime_error(args.recording.string() + ": there is no such folder or log");
  }
  RequireBoard(args, draft);
  AddCamera(args, &draft);
  if (std::filesystem::is_directory(args.recording)) {
    draft.AddDefault("sample_collector", "num_still_frames", "1");  // one sweep, one image a place
  }
  draft.Read();
  args.out.Prepare();
  WriteFileAtomically(args.out.path, draft.Text());
  std::cout << "written\n  " << args.out.path.string() << '\n';
}

}  // namespace
}  // namespace voqcal

int main(int argc, char** argv) {
  CLI::App app(
      "Drafts a rig file from what a recording says. The board's numbers are asked for by name; "
      "the camera is taken from --camera, from camera.yaml, camera_info.yaml, ost.yaml or "
      "camchain.yaml in the folder, or estimated from the images of the board.",
      "draft_rig");
  voqcal::DraftArgs args;
  app.add_option("recording", args.recording, "A folder of images and clouds, or an LCM log")
      ->required();
  app.add_option(
      "numbers", args.numbers, "Keys of the rig file, as board.width_m=0.61 board.height_m=0.85");
  app.add_option("--camera",
                 args.camera,
                 "The camera's calibration: Kalibr's camchain, ROS' (camera_matrix), "
                 "cam_lidar_calibration's (K, D), "
                 "or a rig file's section");
  voqcal::AddOutputFile(&app, "The rig file to write", &args.out)->required();
  return voqcal::RunTool(&app, argc, argv, [&args] { voqcal::DraftRig(args); });
}
