#include "core/simulation/camera_simulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/light.hpp"
#include "core/simulation/room_painter.hpp"

namespace voqcal {
namespace {

constexpr int kNumSamples = 4;      // along each side of a pixel with an edge in it
constexpr int kNumNoise = 1 << 17;  // starts that a row can draw from
constexpr int kChannels = 3;

cv::Mat Blurred(const cv::Mat& sharp, double sigma_px) {
  if (sigma_px == 0) return sharp.clone();
  const int size = 2 * static_cast<int>(std::ceil(3 * sigma_px)) + 1;
  cv::Mat blurred;
  cv::GaussianBlur(sharp, blurred, {size, size}, sigma_px, sigma_px, cv::BORDER_REPLICATE);
  return blurred;
}

cv::Mat InGreyLevels(const cv::Mat& bgr) {
  cv::Mat image;
  bgr.convertTo(image, CV_8UC3);
  return image;
}

// The smallest rectangle around points as the camera sees them; empty if it sees none.
class Bounds {
 public:
  explicit Bounds(const CameraModel& camera) : camera_(camera) {}

  // A ball of `radius_m` around a point.
  void Add(const Eigen::Vector3d& point_camera_m, double radius_m) {
    constexpr double kMarginPx = 2.0;
    constexpr double kStretch = 1.5;  // of sizes, by distortion
    if (!camera_.IsInFront(point_camera_m)) return;
    const Eigen::Vector2d pixel = camera_.Project(point_camera_m);
    const double margin_px = kMarginPx + kStretch * std::max(camera_.fx_px, camera_.fy_px) *
                                             radius_m / point_camera_m.norm();
    left_ = std::min(left_, pixel.x() - margin_px);
    right_ = std::max(right_, pixel.x() + margin_px);
    top_ = std::min(top_, pixel.y() - margin_px);
    bottom_ = std::max(bottom_, pixel.y() + margin_px);
  }

  cv::Rect InImage() const {
    const auto within = [](double value, int size) {
      return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(size)));
    };
    const cv::Point first(within(left_, camera_.width_px), within(top_, camera_.height_px));
    const cv::Point last(within(right_ + 1, camera_.width_px),
                         within(bottom_ + 1, camera_.height_px));
    return first.x < last.x && first.y < last.y ? cv::Rect(first, last) : cv::Rect();
  }

 private:
  const CameraModel& camera_;
  double left_ = 1e9, right_ = -1e9, top_ = 1e9, bottom_ = -1e9;
};

cv::Rect AreaOf(const Tube& tube_camera, const CameraModel& camera) {
  constexpr int kNumSteps = 32;
  Bounds bounds(camera);
  for (int i = 0; i <= kNumSteps; ++i) {
    const double t = static_cast<double>(i) / kNumSteps;
    bounds.Add((1 - t) * tube_camera.begin_m + t * tube_camera.end_m, tube_camera.radius_m);
  }
  return bounds.InImage();
}

cv::Rect AreaOf(const BoardSpec& board,
                const Eigen::Isometry3d& T_camera_board,
                const CameraModel& camera) {
  constexpr int kNumPerEdge = 32;
  Bounds bounds(camera);
  for (const auto& point : OutlinePointsBoardM(board, kNumPerEdge))
    bounds.Add(T_camera_board * point, 0.0);
  return bounds.InImage();
}

cv::Rect Grown(const cv::Rect& area, int margin, const cv::Size& image) {
  return cv::Rect(
             area.x - margin, area.y - margin, area.width + 2 * margin, area.height + 2 * margin) &
         cv::Rect(cv::Point(), image);
}

// Calls `sample(u, v)` at the middles of the pixel's parts; u and v run over (0, 1).
template <typename Sample>
void ForSamplesOfPixel(const Sample& sample) {
  for (int j = 0; j < kNumSamples; ++j) {
    for (int i = 0; i < kNumSamples; ++i) {
      sample((static_cast<float>(i) + 0.5F) / kNumSamples,
             (static_cast<float>(j) + 0.5F) / kNumSamples);
    }
  }
}

template <typename Vector>
Vector Between(const std::array<Vector, 4>& corners, float u, float v) {
  return (1 - v) * ((1 - u) * corners[0] + u * corners[1]) +
         v * ((1 - u) * corners[2] + u * corners[3]);
}

// Lays `sum` of grey levels of `count` samples over a pixel, whose other samples stay as they were.
void LayOver(float sum, int count, cv::Vec3f* pixel) {
  constexpr float kAll = kNumSamples * kNumSamples;
  *pixel = *pixel * ((kAll - static_cast<float>(count)) / kAll) + cv::Vec3f::all(sum / kAll);
}

// Rays of the camera to places on the board's plane: (x, y) = (q0, q1) / q2 with q = M * ray.
// A point s * ray has board coordinates s * R * ray + t; its z is zero at s = -t_z / (R_2 * ray).
struct BoardPlane {
  Eigen::Matrix3f M;
  float t_z = 0.0F;  // of the camera, above the board's face; negative behind it

  explicit BoardPlane(const Eigen::Isometry3d& T_board_camera)
      : t_z(static_cast<float>(T_board_camera(2, 3))) {
    const Eigen::Matrix3d R = T_board_camera.linear();
    const Eigen::Vector3d t = T_board_camera.translation();
    M.row(0) = (t.x() * R.row(2) - t.z() * R.row(0)).cast<float>();
    M.row(1) = (t.y() * R.row(2) - t.z() * R.row(1)).cast<float>();
    M.row(2) = R.row(2).cast<float>();
  }

  bool IsAhead(const Eigen::Vector3f& q) const { return t_z * q.z() < 0; }  // false for NaN
  float RangeM(const Eigen::Vector3f& q) const { return -t_z / q.z(); }
};

// Light on the face, linear over it.
class FaceLight {
 public:
  explicit FaceLight(const Eigen::Isometry3d& T_lidar_board) {
    constexpr double kStepM = 0.1;
    const auto at = [&](double x, double y) {
      return LightAt(T_lidar_board * Eigen::Vector3d(x, y, 0), T_lidar_board.linear().col(2));
    };
    centre_ = static_cast<float>(at(0, 0));
    slope_x_ = static_cast<float>((at(kStepM, 0) - at(-kStepM, 0)) / (2 * kStepM));
    slope_y_ = static_cast<float>((at(0, kStepM) - at(0, -kStepM)) / (2 * kStepM));
  }
  float At(float x, float y) const { return centre_ + slope_x_ * x + slope_y_ * y; }

 private:
  float centre_, slope_x_, slope_y_;
};

}  // namespace

CameraSimulator::CameraSimulator(const SimulationOptions& options,
                                 const BoardSpec& board,
                                 const CameraModel& camera,
                                 const Room& room)
    : options_(options),
      board_(board),
      camera_(camera),
      face_(board),
      floor_z_m_(room.FloorZM()),
      rays_(camera) {
  const RoomPicture picture = PaintRoom(room, camera, rays_, options.T_camera_lidar.inverse());
  room_range_m_ = picture.range_m;
  room_sharp_ = picture.bgr;
  room_image_ = InGreyLevels(Blurred(room_sharp_, options.image_blur_px));
  const KeyedNoise noise(options.seed, NoiseUse::kPixelTable);
  const int num_noise = kNumNoise + kChannels * camera.width_px;
  noise_.reserve(num_noise + 1);
  for (int i = 0; i < num_noise; i += 2) {
    const auto [first, second] = noise.Normals(i);
    for (const double normal : {first, second}) {
      noise_.push_back(cv::saturate_cast<std::int16_t>(options.image_noise * normal));
    }
  }
}

cv::Mat CameraSimulator::Render(const Eigen::Isometry3d& T_lidar_board,
                                std::int64_t frame_us) const {
  std::array<Tube, 5> tubes = StandTubes(T_lidar_board, board_, floor_z_m_);
  std::array<cv::Rect, 5> tube_areas;
  const cv::Rect board_area = AreaOf(board_, options_.T_camera_lidar * T_lidar_board, camera_);
  cv::Rect area = board_area;
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    tubes[i].begin_m = options_.T_camera_lidar * tubes[i].begin_m;
    tubes[i].end_m = options_.T_camera_lidar * tubes[i].end_m;
    tube_areas[i] = AreaOf(tubes[i], camera_);
    area |= tube_areas[i];
  }
  cv::Mat image = room_image_.clone();
  if (!area.empty()) {
    // Blur reaches out of the painted area, and needs the room around it.
    const int reach_px = static_cast<int>(std::ceil(3 * options_.image_blur_px));
    const cv::Rect changed = Grown(area, reach_px, image.size());
    const cv::Rect read = Grown(changed, reach_px, image.size());
    cv::Mat sharp(image.size(), CV_32FC3);
    room_sharp_(read).copyTo(sharp(read));  // the rest is not used
    for (std::size_t i = 0; i < tubes.size(); ++i) PaintTube(tubes[i], tube_areas[i], &sharp);
    PaintBoard(T_lidar_board, board_area, &sharp);
    const cv::Mat blurred = Blurred(sharp(read), options_.image_blur_px);
    InGreyLevels(blurred(changed - read.tl())).copyTo(image(changed));
  }
  AddNoise(frame_us, &image);
  return image;
}

void CameraSimulator::PaintTube(const Tube& tube_camera,
                                const cv::Rect& area,
                                cv::Mat* sharp) const {
  const Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  for (int y = area.y; y < area.br().y; ++y) {
    for (int x = area.x; x < area.br().x; ++x) {
      const std::array<Eigen::Vector3f, 4> corners{rays_.AtCorner(x, y),
                                                   rays_.AtCorner(x + 1, y),
                                                   rays_.AtCorner(x, y + 1),
                                                   rays_.AtCorner(x + 1, y + 1)};
      int count = 0;
      float sum = 0.0F;
      ForSamplesOfPixel([&](float u, float v) {
        const Eigen::Vector3d ray = Between(corners, u, v).cast<double>().normalized();
        const auto range_m = tube_camera.Cast(origin_m, ray);
        if (!range_m || *range_m > room_range_m_.at<float>(y, x)) return;
        ++count;
        // Round: brightest where it faces the camera.
        const Eigen::Vector3d axis = (tube_camera.end_m - tube_camera.begin_m).normalized();
        const Eigen::Vector3d offset = *range_m * ray - tube_camera.begin_m;
        const Eigen::Vector3d normal = (offset - axis * axis.dot(offset)) / tube_camera.radius_m;
        sum += 255.0F * kTubeAlbedo * (0.5F + 0.9F * static_cast<float>(std::abs(normal.dot(ray))));
      });
      if (count > 0) LayOver(sum, count, &sharp->at<cv::Vec3f>(y, x));
    }
  }
}

void CameraSimulator::PaintBoard(const Eigen::Isometry3d& T_lidar_board,
                                 const cv::Rect& area,
                                 cv::Mat* sharp) const {
  const BoardPlane plane((options_.T_camera_lidar * T_lidar_board).inverse());
  const FaceLight light(T_lidar_board);
  const auto level_at = [&](const Eigen::Vector3f& q, int cell) {
    const bool is_dark = plane.t_z > 0 && face_.IsDark(cell);  // the back is plain
    const float albedo = is_dark ? BoardFace::kDarkAlbedo : BoardFace::kBrightAlbedo;
    return 255.0F * albedo * light.At(q.x() / q.z(), q.y() / q.z());
  };
  const auto cell_at = [&](const Eigen::Vector3f& q) {
    return face_.CellAt(q.x() / q.z(), q.y() / q.z());
  };
  for (int y = area.y; y < area.br().y; ++y) {
    for (int x = area.x; x < area.br().x; ++x) {
      const std::array<Eigen::Vector3f, 4> q{plane.M * rays_.AtCorner(x, y),
                                             plane.M * rays_.AtCorner(x + 1, y),
                                             plane.M * rays_.AtCorner(x, y + 1),
                                             plane.M * rays_.AtCorner(x + 1, y + 1)};
      if (!std::all_of(q.begin(), q.end(), [&](const auto& c) { return plane.IsAhead(c); }))
        continue;
      if (plane.RangeM(q[0]) > room_range_m_.at<float>(y, x)) continue;
      auto& pixel = sharp->at<cv::Vec3f>(y, x);
      const int cell = cell_at(q[0]);
      if (cell_at(q[1]) == cell && cell_at(q[2]) == cell && cell_at(q[3]) == cell) {
        if (!face_.IsOutside(cell)) pixel = cv::Vec3f::all(level_at(q[0], cell));
        continue;
      }
      int count = 0;
      float sum = 0.0F;
      ForSamplesOfPixel([&](float u, float v) {
        const Eigen::Vector3f sample = Between(q, u, v);
        const int sample_cell = cell_at(sample);
        if (face_.IsOutside(sample_cell)) return;
        ++count;
        sum += level_at(sample, sample_cell);
      });
      LayOver(sum, count, &pixel);
    }
  }
}

void CameraSimulator::AddNoise(std::int64_t frame_us, cv::Mat* image) const {
  if (options_.image_noise == 0) return;
  const KeyedNoise starts(options_.seed, NoiseUse::kPixelRow, frame_us);
  for (int y = 0; y < image->rows; ++y) {
    const std::int16_t* noise = &noise_[starts.Bits(y) % kNumNoise];
    auto* level = image->ptr<std::uint8_t>(y);
    for (int i = 0; i < kChannels * image->cols; ++i) {
      level[i] = static_cast<std::uint8_t>(std::clamp(level[i] + noise[i], 0, 255));
    }
  }
}

}  // namespace voqcal
