#include "messaging/session_views.hpp"

#include <exception>
#include <iterator>
#include <memory>
#include <optional>

#include <spdlog/spdlog.h>

#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"

namespace voqcal {

SessionViews::SessionViews(const BoardSpec& board,
                           const CameraModel& camera,
                           const SceneViewOptions& options,
                           const std::filesystem::path& samples_log)
    : board_(board), camera_(camera), options_(options), samples_log_(samples_log) {}

std::vector<SceneView> SessionViews::Of(const std::vector<const BoardSample*>& samples) {
  std::map<Key, const BoardSample*> wanted;
  for (const BoardSample* sample : samples) wanted[{sample->id, sample->utime}] = sample;
  for (auto view = views_.begin(); view != views_.end();) {
    view = wanted.count(view->first) == 0 ? views_.erase(view) : std::next(view);
  }
  if (std::filesystem::exists(samples_log_)) ReadNew(wanted);
  std::vector<SceneView> views;
  for (const auto& [key, view] : views_) views.push_back(view);
  return views;
}

void SessionViews::ReadNew(const std::map<Key, const BoardSample*>& samples) {
  try {
    SessionSceneReader reader(samples_log_);
    while (const std::optional<SessionScene> scene = reader.Next()) {
      const auto sample = samples.find({scene->sample_id, scene->sweep.utime});
      if (sample == samples.end() || views_.count(sample->first) != 0) continue;
      Add(*scene, sample->first, *sample->second);
    }
  } catch (const std::exception& error) {
    spdlog::warn("the scene check goes without what follows: {}", error.what());
  }
}

void SessionViews::Add(const SessionScene& scene, const Key& key, const BoardSample& sample) {
  try {
    views_[key] = MakeSceneView(
        FromMessage(scene.sweep), FromMessage(scene.image), sample, board_, camera_, options_);
  } catch (const std::exception& error) {
    spdlog::warn("{}: the scene of sample {} is left out: {}",
                 samples_log_.string(),
                 scene.sample_id,
                 error.what());
  }
}

SceneViewsOf ViewsOfSession(const BoardSpec& board,
                            const CameraModel& camera,
                            const SceneViewOptions& options,
                            const std::filesystem::path& samples_log) {
  const auto views = std::make_shared<SessionViews>(board, camera, options, samples_log);
  return [views](const std::vector<const BoardSample*>& samples) { return views->Of(samples); };
}

}  // namespace voqcal
