#include "core/simulation/lidar_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/simulation/keyed_noise.hpp"

namespace voqcal {
namespace {

constexpr double kMaxBlendM = 0.3;      // farther apart, the receiver tells echoes apart
constexpr double kFullIntensity = 100;  // of a white surface, VLP-16 scale
constexpr int kBoardSurface = -1;
constexpr int kNoSurface = std::numeric_limits<int>::min();
constexpr int kFirstTubeSurface = -2;  // and downwards, one for each tube

ViewCone ConeAround(const std::vector<Eigen::Vector3d>& points_m,
                    double margin_m,
                    double margin_rad) {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  for (const auto& point : points_m) middle_m += point / static_cast<double>(points_m.size());
  double radius_m = 0.0;
  for (const auto& point : points_m) radius_m = std::max(radius_m, (point - middle_m).norm());
  return {middle_m, radius_m + margin_m, margin_rad};
}

// The stand is upright in the room, whichever way the lidar is.
std::array<Tube, 5> Seen(std::array<Tube, 5> tubes, const Eigen::Isometry3d& T_room_lidar) {
  for (Tube& tube : tubes) {
    tube.begin_m = T_room_lidar.inverse() * tube.begin_m;
    tube.end_m = T_room_lidar.inverse() * tube.end_m;
  }
  return tubes;
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
         const Eigen::Isometry3d& T_room_lidar,
         double divergence_rad)
      : T_lidar_board(T_lidar_board_in),
        T_board_lidar(T_lidar_board.inverse()),
        tubes(Seen(StandTubes(T_room_lidar * T_lidar_board, board, floor_z_m), T_room_lidar)),
        board_cone(T_lidar_board.translation(),
                   std::hypot(board.width_m, board.height_m) / 2,
                   divergence_rad),
        stand_cone(ConeAround(EndsOf(tubes), 0.05, divergence_rad)) {}

  bool MayMeet(const Eigen::Vector3d& direction) const {
    return board_cone.Holds(direction) || stand_cone.Holds(direction);
  }

  Eigen::Isometry3d T_lidar_board;
  Eigen::Isometry3d T_board_lidar;
  std::array<Tube, 5> tubes;
  ViewCone board_cone;
  ViewCone stand_cone;
};

struct LidarSimulator::Hit {
  double range_m = 0.0;
  int surface = 0;
  int cell = 0;  // of the board's face
  RoomHit room;  // if it is the room's
};

LidarSimulator::LidarSimulator(const SimulationOptions& options,
                               const BoardSpec& board,
                               const Room& room,
                               const Eigen::Isometry3d& T_room_lidar)
    : options_(options),
      board_(board),
      face_(board),
      room_(room),
      T_room_lidar_(T_room_lidar),
      rays_(options.beam_divergence_rad) {
  for (const Bound& bound : room.Bounds()) {
    solid_cones_.emplace_back(
        T_room_lidar.inverse() * bound.centre_m, bound.radius_m, options.beam_divergence_rad);
  }
  const KeyedNoise noise(options.seed, NoiseUse::kRingBias);
  const double ring_bias_m = HasRings(options.scan.pattern) ? options.ring_bias_m : 0.0;
  for (int emitter = 0; emitter < NumEmitters(options.scan.pattern); ++emitter) {
    emitter_bias_m_.push_back(ring_bias_m * noise.Normals(emitter).first);
  }
  if (!IsRepeating(options.scan.pattern)) return;
  beams_ = BeamsOfSweep(options.scan, 0);
  room_echoes_ = RoomEchoes(beams_);
}

PointCloud LidarSimulator::Sweep(const Eigen::Isometry3d& T_lidar_board,
                                 std::int64_t frame_us) const {
  const bool is_repeating = IsRepeating(options_.scan.pattern);
  const auto own_beams =
      is_repeating ? std::vector<ScanBeam>() : BeamsOfSweep(options_.scan, frame_us);
  const auto own_echoes = is_repeating ? std::vector<Echo>() : RoomEchoes(own_beams);
  const std::vector<ScanBeam>& beams = is_repeating ? beams_ : own_beams;
  const std::vector<Echo>& room_echoes = is_repeating ? room_echoes_ : own_echoes;
  const Moving moving(
      T_lidar_board, board_, room_.FloorZM(), T_room_lidar_, options_.beam_divergence_rad);
  const KeyedNoise range_noise(options_.seed, NoiseUse::kRange, frame_us);
  const KeyedNoise dropout_noise(options_.seed, NoiseUse::kDropout, frame_us);
  const KeyedNoise pointing_noise(options_.seed, NoiseUse::kPointing, frame_us);
  PointCloud cloud;
  cloud.has_intensity = cloud.has_time = true;
  cloud.has_ring = HasRings(options_.scan.pattern);
  cloud.points.reserve(beams.size());
  for (std::size_t beam = 0; beam < beams.size(); ++beam) {
    if (dropout_noise.Uniform(beam) < options_.dropout) continue;
    const Eigen::Vector3d& direction = beams[beam].direction;
    const int emitter = beams[beam].emitter;
    const Echo echo =
        moving.MayMeet(direction)
            ? EchoWithMoving(
                  Astray(direction, pointing_noise.Normals(beam)), moving, room_echoes[beam])
            : room_echoes[beam];
    const auto [range_normal, intensity_normal] = range_noise.Normals(beam);
    const double range_m = echo.range_m + echo.bias_m + options_.common_bias_m +
                           emitter_bias_m_[emitter] + options_.range_noise_m * range_normal;
    const double intensity =
        kFullIntensity * echo.albedo + options_.intensity_noise * intensity_normal;
    LidarPoint point;
    point.position_m = (range_m * direction).cast<float>();
    point.intensity = static_cast<float>(std::max(intensity, 0.0));
    if (cloud.has_ring) point.ring = static_cast<std::uint16_t>(emitter);
    point.time_s = beams[beam].time_s;
    cloud.points.push_back(point);
  }
  return cloud;
}

BoardHits LidarSimulator::CountBoardHits(const Eigen::Isometry3d& T_lidar_board,
                                         std::int64_t frame_us) const {
  const bool is_repeating = IsRepeating(options_.scan.pattern);
  const auto own_beams =
      is_repeating ? std::vector<ScanBeam>() : BeamsOfSweep(options_.scan, frame_us);
  const std::vector<ScanBeam>& beams = is_repeating ? beams_ : own_beams;
  const Moving moving(
      T_lidar_board, board_, room_.FloorZM(), T_room_lidar_, options_.beam_divergence_rad);
  const KeyedNoise dropout_noise(options_.seed, NoiseUse::kDropout, frame_us);
  const KeyedNoise pointing_noise(options_.seed, NoiseUse::kPointing, frame_us);
  std::set<int> emitters;
  BoardHits hits;
  for (std::size_t beam = 0; beam < beams.size(); ++beam) {
    if (!moving.board_cone.Holds(beams[beam].direction)) continue;
    const Eigen::Vector3d direction = Astray(beams[beam].direction, pointing_noise.Normals(beam));
    if (dropout_noise.Uniform(beam) < options_.dropout) continue;
    if (Cast(direction, &moving, SolidsNear(direction)).surface != kBoardSurface) continue;
    ++hits.num_points;
    emitters.insert(beams[beam].emitter);
  }
  if (HasRings(options_.scan.pattern)) hits.num_rings = static_cast<int>(emitters.size());
  return hits;
}

Eigen::Vector3d LidarSimulator::Astray(const Eigen::Vector3d& direction,
                                       const std::pair<double, double>& normals) const {
  const Eigen::Vector3d left = Eigen::Vector3d::UnitZ().cross(direction).normalized();
  const Eigen::Vector3d up = direction.cross(left);
  return (direction + options_.pointing_noise_rad * (normals.first * left + normals.second * up))
      .normalized();
}

std::vector<LidarSimulator::Echo> LidarSimulator::RoomEchoes(
    const std::vector<ScanBeam>& beams) const {
  std::vector<Echo> echoes;
  echoes.reserve(beams.size());
  for (const ScanBeam& beam : beams) echoes.push_back(CastBeam(beam.direction, nullptr));
  return echoes;
}

// Most beams near the board end wholly on it, or pass it wholly: then the room need not be asked.
LidarSimulator::Echo LidarSimulator::EchoWithMoving(const Eigen::Vector3d& direction,
                                                    const Moving& moving,
                                                    const Echo& room_echo) const {
  bool is_all_board = true;
  bool is_all_room = true;
  double farthest_m = 0.0;
  Hit centre;
  for (const auto& ray : rays_.Around(direction)) {
    const Hit hit = CastMoving(ray, moving);
    if (farthest_m == 0) centre = hit;
    is_all_board = is_all_board && hit.surface == kBoardSurface;
    is_all_room = is_all_room && hit.surface == kNoSurface;
    farthest_m = std::max(farthest_m, hit.range_m);
  }
  if (is_all_room) return room_echo;
  if (is_all_board && farthest_m < room_echo.nearest_m) return EchoOf(centre);
  return CastBeam(direction, &moving);
}

LidarSimulator::Echo LidarSimulator::CastBeam(const Eigen::Vector3d& direction,
                                              const Moving* moving) const {
  const std::vector<int> solids = SolidsNear(direction);
  std::vector<Hit> hits;
  bool is_one_surface = true;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& ray : rays_.Around(direction)) {
    hits.push_back(Cast(ray, moving, solids));
    is_one_surface = is_one_surface && hits.back().surface == hits.front().surface;
    nearest_m = std::min(nearest_m, hits.back().range_m);
  }
  Echo echo = is_one_surface ? EchoOf(hits.front()) : EchoOfMixture(&hits);
  echo.nearest_m = nearest_m;
  return echo;
}

std::vector<int> LidarSimulator::SolidsNear(const Eigen::Vector3d& direction) const {
  std::vector<int> solids;
  for (std::size_t i = 0; i < solid_cones_.size(); ++i) {
    if (solid_cones_[i].Holds(direction)) solids.push_back(static_cast<int>(i));
  }
  return solids;
}

LidarSimulator::Hit LidarSimulator::Cast(const Eigen::Vector3d& direction,
                                         const Moving* moving,
                                         const std::vector<int>& solids) const {
  Hit hit;
  hit.room = room_.Cast(T_room_lidar_.translation(), T_room_lidar_.linear() * direction, solids);
  hit.range_m = hit.room.range_m;
  hit.surface = hit.room.surface;
  if (moving == nullptr) return hit;
  const Hit moving_hit = CastMoving(direction, *moving);
  return moving_hit.range_m < hit.range_m ? moving_hit : hit;
}

// Board and stand alone; an infinite range if neither is met.
LidarSimulator::Hit LidarSimulator::CastMoving(const Eigen::Vector3d& direction,
                                               const Moving& moving) const {
  Hit hit;
  hit.range_m = std::numeric_limits<double>::infinity();
  hit.surface = kNoSurface;
  for (std::size_t i = 0; i < moving.tubes.size(); ++i) {
    const auto range_m = moving.tubes[i].Cast(Eigen::Vector3d::Zero(), direction);
    if (!range_m || *range_m >= hit.range_m) continue;
    hit.range_m = *range_m;
    hit.surface = kFirstTubeSurface - static_cast<int>(i);
  }
  const double range_m =
      -moving.T_board_lidar(2, 3) / moving.T_board_lidar.linear().row(2).dot(direction);
  if (!(range_m > 0) || range_m >= hit.range_m) return hit;
  const Eigen::Vector3d point_board_m = moving.T_board_lidar * (range_m * direction);
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
