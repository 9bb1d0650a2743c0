#include "messaging/session_views.hpp"

#include <exception>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <spdlog/spdlog.h>

#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"

namespace voqcal {

SessionViews::SessionViews(const BoardSpec& board,
                           const CameraModel& camera,
                           const SceneViewOptions& options,
                           const std::filesystem::path& samples_log,
                           OnSceneImage on_image)
    : board_(board),
      camera_(camera),
      options_(options),
      samples_log_(samples_log),
      on_image_(std::move(on_image)) {}

std::vector<SceneView> SessionViews::Of(const std::vector<const BoardSample*>& samples) {
  std::map<Key, const BoardSample*> wanted;
  for (const BoardSample* sample : samples) wanted[{sample->id, sample->utime}] = sample;
  for (auto view = views_.begin(); view != views_.end();) {
    view = wanted.count(view->first) == 0 ? views_.erase(view) : std::next(view);
  }
  std::map<Key, const BoardSample*> missing = wanted;
  for (const auto& [key, view] : views_) missing.erase(key);
  if (!missing.empty() && std::filesystem::exists(samples_log_)) Read(missing);
  std::vector<SceneView> views;
  for (const auto& [key, view] : views_) views.push_back(view);
  return views;
}

void SessionViews::Read(const std::map<Key, const BoardSample*>& samples) {
  const auto key_of = [](const SessionScene& scene) {
    return Key(scene.sample_id, scene.sweep.utime);
  };
  const auto is_wanted = [&](const SessionScene& scene) {
    return samples.count(key_of(scene)) != 0;
  };
  std::mutex adding;
  try {
    ForEachScene(samples_log_, is_wanted, [&](const SessionScene& scene) {
      const Key key = key_of(scene);
      std::optional<SceneView> view = ViewOf(scene, *samples.at(key));
      if (!view) return;
      const std::lock_guard<std::mutex> lock(adding);
      views_[key] = std::move(*view);
    });
  } catch (const std::exception& error) {
    spdlog::warn("the scene check goes without what follows: {}", error.what());
  }
}

std::optional<SceneView> SessionViews::ViewOf(const SessionScene& scene,
                                              const BoardSample& sample) const {
  try {
    const cv::Mat image = FromMessage(scene.image);
    SceneView view =
        MakeSceneView(FromMessage(scene.sweep), image, sample, board_, camera_, options_);
    if (on_image_) on_image_(sample, image);
    return view;
  } catch (const std::exception& error) {
    spdlog::warn("{}: the scene of sample {} is left out: {}",
                 samples_log_.string(),
                 scene.sample_id,
                 error.what());
    return std::nullopt;
  }
}

SceneViewsOf ViewsOfSession(const BoardSpec& board,
                            const CameraModel& camera,
                            const SceneViewOptions& options,
                            const std::filesystem::path& samples_log,
                            OnSceneImage on_image) {
  const auto views =
      std::make_shared<SessionViews>(board, camera, options, samples_log, std::move(on_image));
  return [views](const std::vector<const BoardSample*>& samples) { return views->Of(samples); };
}

}  // namespace voqcal
