#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/scene/scene_view.hpp"
#include "core/scene/scene_window_options.hpp"
#include "voqcal/image_t.hpp"
#include "voqcal/pointcloud2_t.hpp"

namespace voqcal {

/// The scenes of a stretch of time: sweeps with the image nearest in time, not all of a second's.
/// Messages of the two sensors may come late by some of the other's. Where the sweeps'
/// time is set back (a recording starts again) a new stretch begins.
class SceneWindow {
 public:
  /// @param on_unusable  told of each pair that makes no scene, and why.
  /// @throws std::invalid_argument if `options` has Problems().
  SceneWindow(const CameraModel& camera,
              const SceneViewOptions& view,
              const SceneWindowOptions& options,
              std::function<void(const std::string& reason)> on_unusable);

  void Add(const pointcloud2_t& sweep);
  void Add(const image_t& image);
  /// No more come: the last sweep waits for no other image.
  void Finish();

  const std::vector<SceneView>& views() const { return views_; }
  std::int64_t first_utime() const { return first_utime_; }  ///< Of its sweeps; 0 without any.
  std::int64_t last_utime() const { return last_utime_; }
  bool IsFull() const;  ///< It lasts window_s.
  /// Both sensors come, and of late no image is near a sweep in time.
  bool IsWithoutPairs() const;

  /// Begins a new stretch.
  void Clear();

 private:
  void BeginAnewIfSetBack(std::int64_t sweep_utime);
  void Pair();
  /// Null if none is near enough, or a nearer one may be under way.
  const image_t* ImageOf(const pointcloud2_t& sweep) const;
  void AddView(const pointcloud2_t& sweep, const image_t& image);

  CameraModel camera_;
  SceneViewOptions view_;
  SceneWindowOptions options_;
  std::function<void(const std::string&)> on_unusable_;
  std::deque<pointcloud2_t> sweeps_;
  std::deque<image_t> images_;
  int num_sweeps_alone_ = 0;  // since a sweep and an image were near in time
  int num_images_alone_ = 0;
  bool is_finished_ = false;
  std::optional<std::int64_t> last_tried_utime_;  // of the last pair's sweep
  std::int64_t first_utime_ = 0;
  std::int64_t last_utime_ = 0;
  std::vector<SceneView> views_;
};

}  // namespace voqcal
