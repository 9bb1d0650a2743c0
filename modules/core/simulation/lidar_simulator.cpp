#include "core/simulation/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>

#include "core/simulation/keyed_noise.hpp"

namespace voqcal {
namespace {

constexpr int kNumRings = 16;
constexpr int kNumColumns = 1800;
constexpr double kSweepS = 0.1;
constexpr double kMaxBlendM = 0.3;      // farther apart, the receiver tells echoes apart
constexpr double kFullIntensity = 100;  // of a white surface, VLP-16 scale
constexpr int kBoardSurface = -1;
constexpr int kFirstTubeSurface = -2;  // and downwards, one for each tube

std::vector<Eigen::Vector3d> BeamDirections() {
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(kNumRings * kNumColumns);
  for (int column = 0; column < kNumColumns; ++column) {
    const double azimuth_rad = M_PI - column * (2.0 * M_PI / kNumColumns);
    for (int ring = 0; ring < kNumRings; ++ring) {
      const double elevation_rad = kMaxBeamElevationRad * (2.0 * ring / (kNumRings - 1) - 1.0);
      directions.emplace_back(std::cos(elevation_rad) * std::cos(azimuth_rad),
                              std::cos(elevation_rad) * std::sin(azimuth_rad),
                              std::sin(elevation_rad));
    }
  }
  return directions;
}

// The rays that stand for a beam, the centre's first: 1 + 6 + 12 on rings that share its disc
// evenly.
std::vector<Eigen::Vector3d> RaysOfBeam(const Eigen::Vector3d& centre, double divergence_rad) {
  std::vector<Eigen::Vector3d> rays{centre};
  if (divergence_rad == 0) return rays;
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(centre).normalized();
  const Eigen::Vector3d up = centre.cross(left);
  for (const int count : {6, 12}) {
    const double radius = divergence_rad / 2 * (count == 6 ? 0.46 : 0.84);  // middle of their areas
    for (int i = 0; i < count; ++i) {
      const double angle = (i + 0.5) * 2.0 * M_PI / count;
      rays.push_back(
          (centre + radius * (std::cos(angle) * left + std::sin(angle) * up)).normalized());
    }
  }
  return rays;
}

// Directions that can meet a sphere.
struct Cone {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double min_cosine = -1.0;  // all of them

  Cone(const Eigen::Vector3d& centre_m, double radius_m, double margin_rad) {
    const double distance_m = centre_m.norm();
    if (distance_m <= radius_m) return;
    axis = centre_m / distance_m;
    min_cosine = std::cos(std::min(std::asin(radius_m / distance_m) + margin_rad, M_PI));
  }
  bool Holds(const Eigen::Vector3d& direction) const { return axis.dot(direction) >= min_cosine; }
};

Cone ConeAround(const std::vector<Eigen::Vector3d>& points_m, double margin_m, double margin_rad) {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  for (const auto& point : points_m) middle_m += point / static_cast<double>(points_m.size());
  double radius_m = 0.0;
  for (const auto& point : points_m) radius_m = std::max(radius_m, (point - middle_m).norm());
  return {middle_m, radius_m + margin_m, margin_rad};
}

std::vector<Eigen::Vector3d> EndsOf(const std::array<Tube, 5>& tubes) {
  std::vector<Eigen::Vector3d> ends;
  for (const Tube& tube : tubes) {
    ends.push_back(tube.begin_m);
    ends.push_back(tube.end_m);
  }
  return ends;
}

}  // namespace

struct LidarSimulator::Moving {
  Moving(const Eigen::Isometry3d& T_lidar_board_in,
         const BoardSpec& board,
         double floor_z_m,
         double divergence_rad)
      : T_lidar_board(T_lidar_board_in),
        T_board_lidar(T_lidar_board.inverse()),
        tubes(StandTubes(T_lidar_board, board, floor_z_m)),
        board_cone(T_lidar_board.translation(),
                   std::hypot(board.width_m, board.height_m) / 2,
                   divergence_rad),
        stand_cone(ConeAround(EndsOf(tubes), 0.05, divergence_rad)) {}

  Eigen::Isometry3d T_lidar_board;
  Eigen::Isometry3d T_board_lidar;
  std::array<Tube, 5> tubes;
  Cone board_cone;
  Cone stand_cone;
};

struct LidarSimulator::Hit {
  double range_m = 0.0;
  int surface = 0;
  int cell = 0;  // of the board's face
  RoomHit room;  // if it is the room's
};

LidarSimulator::LidarSimulator(const SimulationOptions& options,
                               const BoardSpec& board,
                               const Room& room)
    : options_(options), board_(board), face_(board), room_(room), directions_(BeamDirections()) {
  const KeyedNoise noise(options.seed, NoiseUse::kRingBias);
  for (int ring = 0; ring < kNumRings; ++ring) {
    ring_bias_m_[ring] = options.ring_bias_m * noise.Normals(ring).first;
  }
  room_echoes_.reserve(directions_.size());
  for (int beam = 0; beam < static_cast<int>(directions_.size()); ++beam) {
    room_echoes_.push_back(CastBeam(beam, nullptr));
  }
}

PointCloud LidarSimulator::Sweep(const Eigen::Isometry3d& T_lidar_board,
                                 std::int64_t frame_us) const {
  const Moving moving(T_lidar_board, board_, room_.FloorZM(), options_.beam_divergence_rad);
  const KeyedNoise range_noise(options_.seed, NoiseUse::kRange, frame_us);
  const KeyedNoise dropout_noise(options_.seed, NoiseUse::kDropout, frame_us);
  PointCloud cloud;
  cloud.has_intensity = cloud.has_ring = cloud.has_time = true;
  cloud.points.reserve(directions_.size());
  for (int beam = 0; beam < static_cast<int>(directions_.size()); ++beam) {
    if (dropout_noise.Uniform(beam) < options_.dropout) continue;
    const Eigen::Vector3d& direction = directions_[beam];
    const bool is_moving = moving.board_cone.Holds(direction) || moving.stand_cone.Holds(direction);
    const Echo echo = is_moving ? CastBeam(beam, &moving) : room_echoes_[beam];
    const int ring = beam % kNumRings;
    const auto [range_normal, intensity_normal] = range_noise.Normals(beam);
    const double range_m = echo.range_m + echo.bias_m + options_.common_bias_m +
                           ring_bias_m_[ring] + options_.range_noise_m * range_normal;
    const double intensity =
        kFullIntensity * echo.albedo + options_.intensity_noise * intensity_normal;
    LidarPoint point;
    point.position_m = (range_m * direction).cast<float>();
    point.intensity = static_cast<float>(std::max(intensity, 0.0));
    point.ring = static_cast<std::uint16_t>(ring);
    point.time_s = static_cast<float>(beam / kNumRings * (kSweepS / kNumColumns));
    cloud.points.push_back(point);
  }
  return cloud;
}

LidarSimulator::Echo LidarSimulator::CastBeam(int beam, const Moving* moving) const {
  std::vector<Hit> hits;
  bool is_one_surface = true;
  for (const auto& ray : RaysOfBeam(directions_[beam], options_.beam_divergence_rad)) {
    hits.push_back(Cast(ray, moving));
    is_one_surface = is_one_surface && hits.back().surface == hits.front().surface;
  }
  return is_one_surface ? EchoOf(hits.front()) : EchoOfMixture(&hits);
}

LidarSimulator::Hit LidarSimulator::Cast(const Eigen::Vector3d& direction,
                                         const Moving* moving) const {
  const Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Hit hit;
  hit.room = room_.Cast(origin_m, direction);
  hit.range_m = hit.room.range_m;
  hit.surface = hit.room.surface;
  if (moving == nullptr) return hit;
  for (std::size_t i = 0; i < moving->tubes.size(); ++i) {
    const auto range_m = moving->tubes[i].Cast(origin_m, direction);
    if (!range_m || *range_m >= hit.range_m) continue;
    hit.range_m = *range_m;
    hit.surface = kFirstTubeSurface - static_cast<int>(i);
  }
  const double range_m =
      -moving->T_board_lidar(2, 3) / moving->T_board_lidar.linear().row(2).dot(direction);
  if (!(range_m > 0) || range_m >= hit.range_m) return hit;
  const Eigen::Vector3d point_board_m = moving->T_board_lidar * (range_m * direction);
  const int cell = face_.CellAt(point_board_m.x(), point_board_m.y());
  if (face_.IsOutside(cell)) return hit;
  hit.range_m = range_m;
  hit.surface = kBoardSurface;
  hit.cell = cell;
  return hit;
}

LidarSimulator::Echo LidarSimulator::EchoOf(const Hit& hit) const {
  if (hit.surface <= kFirstTubeSurface) return {hit.range_m, kTubeAlbedo, 0.0};
  if (hit.surface != kBoardSurface) return {hit.range_m, RoomAlbedo(hit.room).mean(), 0.0};
  const bool is_dark = face_.IsDark(hit.cell);
  return {hit.range_m,
          is_dark ? BoardFace::kDarkAlbedo : BoardFace::kBrightAlbedo,
          is_dark ? options_.dark_bias_m : -options_.dark_bias_m};
}

// Splits the rays at the largest step in depth. A small step blends: the answer is the mean range,
// weighted by the light that comes back. At a large one the side that sends more light back
// answers.
LidarSimulator::Echo LidarSimulator::EchoOfMixture(std::vector<Hit>* hits) const {
  const Hit centre = hits->front();
  std::stable_sort(
      hits->begin(), hits->end(), [](const Hit& a, const Hit& b) { return a.range_m < b.range_m; });
  std::size_t split = 1;
  for (std::size_t i = 2; i < hits->size(); ++i) {
    if ((*hits)[i].range_m - (*hits)[i - 1].range_m >
        (*hits)[split].range_m - (*hits)[split - 1].range_m) {
      split = i;
    }
  }
  const double step_m = (*hits)[split].range_m - (*hits)[split - 1].range_m;
  const auto light = [this](auto begin, auto end) {
    double sum = 0.0;
    for (auto hit = begin; hit != end; ++hit) sum += EchoOf(*hit).albedo;
    return sum;
  };
  const auto middle = hits->begin() + static_cast<std::ptrdiff_t>(split);
  auto begin = hits->begin();
  auto end = hits->end();
  if (step_m > kMaxBlendM) {
    if (light(begin, middle) >= light(middle, end)) {
      end = middle;
    } else {
      begin = middle;
    }
  }
  const bool has_centre = centre.range_m >= begin->range_m && centre.range_m <= (end - 1)->range_m;
  Echo echo = EchoOf(has_centre ? centre : *begin);
  const double sum = light(begin, end);
  if (sum <= 0) return echo;
  echo.range_m = 0.0;
  for (auto hit = begin; hit != end; ++hit)
    echo.range_m += EchoOf(*hit).albedo / sum * hit->range_m;
  return echo;
}

}  // namespace voqcal
