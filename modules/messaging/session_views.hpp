#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"
#include "core/calibration/calibrate.hpp"
#include "core/camera/camera_model.hpp"
#include "core/scene/scene_view.hpp"
#include "messaging/session_scenes.hpp"

namespace voqcal {

/// Is told of a sample's decoded image, by several threads at once. Must not throw: what it makes
/// of the image is no part of the scene.
using OnSceneImage = std::function<void(const BoardSample& sample, const cv::Mat& image)>;

/// The edges of each sample's scene, taken from the session's samples.lcm: one sweep and one image
/// a core in memory at a time, each worked on once.
class SessionViews {
 public:
  SessionViews(const BoardSpec& board,
               const CameraModel& camera,
               const SceneViewOptions& options,
               const std::filesystem::path& samples_log,
               OnSceneImage on_image = {});

  /// Of the samples that have a scene, in order. A log that is not there (the sample collector runs
  /// on another machine) has none; a scene that cannot be read is left out with a warning.
  std::vector<SceneView> Of(const std::vector<const BoardSample*>& samples);

 private:
  /// A new session on the same folder counts its samples anew, at other times.
  using Key = std::pair<std::int64_t, std::int64_t>;  // id, utime

  void Read(const std::map<Key, const BoardSample*>& samples);
  std::optional<SceneView> ViewOf(const SessionScene& scene, const BoardSample& sample) const;

  BoardSpec board_;
  CameraModel camera_;
  SceneViewOptions options_;
  std::filesystem::path samples_log_;
  OnSceneImage on_image_;
  std::map<Key, SceneView> views_;
};

/// SessionViews::Of, of one SessionViews that all copies of the function share.
SceneViewsOf ViewsOfSession(const BoardSpec& board,
                            const CameraModel& camera,
                            const SceneViewOptions& options,
                            const std::filesystem::path& samples_log,
                            OnSceneImage on_image = {});

}  // namespace voqcal
