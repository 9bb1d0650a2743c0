#include "messaging/scene_window.hpp"

#include <cstdlib>
#include <exception>
#include <utility>

#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"

namespace voqcal {
namespace {

constexpr std::size_t kNumKept = 5;  // of each sensor

template <typename Message>
void Keep(const Message& message, std::deque<Message>* kept) {
  kept->push_back(message);
  if (kept->size() > kNumKept) kept->pop_front();
}

double SecondsFrom(std::int64_t begin_us, std::int64_t end_us) {
  return 1e-6 * static_cast<double>(end_us - begin_us);
}

}  // namespace

SceneWindow::SceneWindow(const CameraModel& camera,
                         const SceneViewOptions& view,
                         const SceneWindowOptions& options,
                         std::function<void(const std::string&)> on_unusable)
    : camera_(camera), view_(view), options_(options), on_unusable_(std::move(on_unusable)) {}

void SceneWindow::Add(const pointcloud2_t& sweep) {
  BeginAnewIfSetBack(sweep.utime);
  Keep(sweep, &sweeps_);
  Pair();
}

void SceneWindow::Add(const image_t& image) {
  Keep(image, &images_);
  Pair();
}

bool SceneWindow::IsFull() const {
  return SecondsFrom(first_utime_, last_utime_) >= options_.window_s;
}

bool SceneWindow::IsWithoutPairs() const {
  return !last_tried_utime_ && sweeps_.size() == kNumKept && images_.size() == kNumKept;
}

void SceneWindow::Clear() {
  views_.clear();
  first_utime_ = last_utime_ = 0;
}

// Sweeps of one sensor may come out of order by less than that.
void SceneWindow::BeginAnewIfSetBack(std::int64_t sweep_utime) {
  constexpr double kSetBackS = 1.0;
  if (!last_tried_utime_ || SecondsFrom(sweep_utime, *last_tried_utime_) < kSetBackS) return;
  Clear();
  sweeps_.clear();
  images_.clear();
  last_tried_utime_.reset();
}

void SceneWindow::Pair() {
  for (const pointcloud2_t& sweep : sweeps_) {
    for (const image_t& image : images_) {
      if (TryPair(sweep, image)) return;
    }
  }
}

bool SceneWindow::TryPair(const pointcloud2_t& sweep, const image_t& image) {
  if (std::abs(SecondsFrom(image.utime, sweep.utime)) > options_.max_apart_s) return false;
  if (last_tried_utime_ && SecondsFrom(*last_tried_utime_, sweep.utime) < options_.every_s) {
    return false;
  }
  last_tried_utime_ = sweep.utime;
  try {
    views_.push_back(MakeSceneView(FromMessage(sweep), FromMessage(image), camera_, view_));
  } catch (const std::exception& error) {  // one broken message must not end who watches
    on_unusable_(error.what());
    return true;
  }
  if (views_.size() == 1) first_utime_ = sweep.utime;
  last_utime_ = sweep.utime;
  return true;
}

}  // namespace voqcal
