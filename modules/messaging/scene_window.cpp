#include "messaging/scene_window.hpp"

#include <cmath>
#include <exception>
#include <utility>

#include "core/problems.hpp"
#include "messaging/convert_image.hpp"
#include "messaging/convert_points.hpp"

namespace voqcal {
namespace {

constexpr double kKeptS = 0.5;  // of each sensor: its messages come later than the other's by less

double SecondsFrom(std::int64_t begin_us, std::int64_t end_us) {
  return 1e-6 * static_cast<double>(end_us - begin_us);
}

template <typename Message>
void ForgetOld(std::deque<Message>* kept) {
  while (std::abs(SecondsFrom(kept->front().utime, kept->back().utime)) > kKeptS) kept->pop_front();
}

}  // namespace

SceneWindow::SceneWindow(const CameraModel& camera,
                         const SceneViewOptions& view,
                         const SceneWindowOptions& options,
                         std::function<void(const std::string&)> on_unusable)
    : camera_(camera), view_(view), options_(options), on_unusable_(std::move(on_unusable)) {
  RequireUsable("SceneWindowOptions", options_.Problems());
}

void SceneWindow::Add(const pointcloud2_t& sweep) {
  BeginAnewIfSetBack(sweep.utime);
  sweeps_.push_back(sweep);
  ++num_sweeps_alone_;
  Pair();  // before the old are forgotten: in slow recordings the next message is far off
  ForgetOld(&sweeps_);
}

void SceneWindow::Add(const image_t& image) {
  images_.push_back(image);
  ++num_images_alone_;
  Pair();
  ForgetOld(&images_);
}

bool SceneWindow::IsFull() const {
  return SecondsFrom(first_utime_, last_utime_) >= options_.window_s;
}

bool SceneWindow::IsWithoutPairs() const {
  constexpr int kNumTelling = 5;
  return num_sweeps_alone_ >= kNumTelling && num_images_alone_ >= kNumTelling;
}

void SceneWindow::Finish() {
  is_finished_ = true;
  Pair();
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
    const image_t* image = ImageOf(sweep);
    if (image == nullptr) continue;
    num_sweeps_alone_ = num_images_alone_ = 0;
    const bool is_due =
        !last_tried_utime_ || SecondsFrom(*last_tried_utime_, sweep.utime) >= options_.every_s;
    if (is_due) return AddView(sweep, *image);
  }
}

const image_t* SceneWindow::ImageOf(const pointcloud2_t& sweep) const {
  const image_t* nearest = nullptr;
  double least_apart_s = options_.max_apart_s;
  // A nearer one may come until the images have passed the sweep; a slow camera is not waited for.
  bool is_settled = is_finished_ || SecondsFrom(sweep.utime, sweeps_.back().utime) > kKeptS / 2;
  for (const image_t& image : images_) {
    const double later_s = SecondsFrom(sweep.utime, image.utime);
    is_settled = is_settled || later_s >= 0;
    if (std::abs(later_s) > least_apart_s) continue;
    least_apart_s = std::abs(later_s);
    nearest = &image;
  }
  return is_settled ? nearest : nullptr;
}

void SceneWindow::AddView(const pointcloud2_t& sweep, const image_t& image) {
  last_tried_utime_ = sweep.utime;
  try {
    views_.push_back(MakeSceneView(FromMessage(sweep), FromMessage(image), camera_, view_));
  } catch (const std::exception& error) {  // one broken message must not end who watches
    on_unusable_(error.what());
    return;
  }
  if (views_.size() == 1) first_utime_ = sweep.utime;
  last_utime_ = sweep.utime;
}

}  // namespace voqcal
