#include "support/lidar_detection.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "core/geometry/rigid.hpp"
#include "core/lidar_detection/accumulating_detector.hpp"
#include "core/simulation/clutter.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/simulation.hpp"
#include "support/synthetic_lidar_board.hpp"

namespace voqcal::test {
namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr int kBoardsPerHall = 10;
constexpr std::int64_t kSweepUs = 100000;
constexpr double kMaxTiltDeg = 35.0;  // about each of two axes: 50 together
constexpr double kClearanceM = 0.15;
constexpr double kViewMarginRad = 0.3 * kDeg;  // a beam's width and a row's step
constexpr double kWrongCentreM = 0.10;
constexpr double kKnownM = 0.05;  // 1 sigma
constexpr double kWrongAngleRad = 10.0 * kDeg;

BoardSpec Board() { return {0.61, 0.85, 0.095, 5, 7, 0.0, 0.0}; }

Box Hall() { return {{-9.0, -9.0, -1.3}, {9.0, 9.0, 2.7}, Material::kWall}; }

// Smaller or larger by a quarter to a half: sizes of other boards that people own.
double SecondBoardScale(const KeyedNoise& noise) {
  const double size = 0.25 + 0.25 * noise.Uniform(0);
  return noise.Uniform(1) < 0.5 ? 1.0 - size : 1.0 + size;
}

bool IsLikeTheBoard(double length_m, double other_length_m) {
  constexpr double kLikeness = 0.15;
  const BoardSpec board = Board();
  const auto is_near = [](double length, double true_length) {
    return std::abs(length / true_length - 1.0) < kLikeness;
  };
  return (is_near(length_m, board.width_m) && is_near(other_length_m, board.height_m)) ||
         (is_near(length_m, board.height_m) && is_near(other_length_m, board.width_m));
}

// A crate with a face of the board's size is a board, as far as a lidar can tell.
void RemoveTwins(Props* props) {
  const auto is_twin = [](const Box& box) {
    const Eigen::Vector3d size_m = box.max_lidar_m - box.min_lidar_m;
    return IsLikeTheBoard(size_m.x(), size_m.y()) || IsLikeTheBoard(size_m.x(), size_m.z()) ||
           IsLikeTheBoard(size_m.y(), size_m.z());
  };
  std::vector<Box>& boxes = props->boxes;
  boxes.erase(std::remove_if(boxes.begin(), boxes.end(), is_twin), boxes.end());
}

Props ClutterOf(std::uint32_t seed) {
  ClutterOptions clutter;
  clutter.num_people = 5;
  clutter.num_tripods = 4;
  clutter.num_doors = 4;
  clutter.num_furniture = 8;
  clutter.second_board_scale = SecondBoardScale(KeyedNoise(seed, NoiseUse::kStops, -1));
  Props props = DrawClutter(clutter, Board(), Hall(), seed);
  RemoveTwins(&props);
  return props;
}

// Sees, clear of things and unhidden, every part of the board.
bool IsGood(const Eigen::Isometry3d& T_lidar_board, ScanPattern pattern, const Room& room) {
  const BoardSpec board = Board();
  constexpr int kNumSteps = 8;  // 0.08 and 0.11 m: nothing in the hall hides less
  for (int i = 0; i <= kNumSteps; ++i) {
    for (int j = 0; j <= kNumSteps; ++j) {
      const Eigen::Vector3d point_m =
          T_lidar_board * Eigen::Vector3d(board.width_m * (1.0 * i / kNumSteps - 0.5),
                                          board.height_m * (1.0 * j / kNumSteps - 0.5),
                                          0.0);
      const double range_m = point_m.norm();
      if (!IsInFieldOfView(pattern, point_m, kViewMarginRad) ||
          room.DistanceToShellM(point_m) < kClearanceM ||
          room.DistanceToFurnitureM(point_m) < kClearanceM ||
          room.Cast(Eigen::Vector3d::Zero(), point_m / range_m).range_m < range_m) {
        return false;
      }
    }
  }
  return true;
}

Eigen::Isometry3d DrawBoard(const LidarDetectionOptions& options,
                            const Room& room,
                            std::uint32_t seed,
                            int board) {
  constexpr int kNumTrials = 20000;
  const KeyedNoise noise(seed, NoiseUse::kStops, board);
  for (int trial = 0; trial < kNumTrials; ++trial) {
    const auto between = [&](int i, double low, double high) {
      return low + (high - low) * noise.Uniform(8 * trial + i);
    };
    const double azimuth_rad = between(0, -M_PI, M_PI);
    const double elevation_rad = between(1, -20 * kDeg, 20 * kDeg);
    const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                    std::cos(elevation_rad) * std::sin(azimuth_rad),
                                    std::sin(elevation_rad));
    const Eigen::Isometry3d T_lidar_board =
        FacingBoard(between(2, options.min_distance_m, options.max_distance_m) * direction,
                    between(3, -90.0, 90.0),
                    between(4, -kMaxTiltDeg, kMaxTiltDeg),
                    between(5, -kMaxTiltDeg, kMaxTiltDeg));
    if (IsGood(T_lidar_board, options.pattern, room)) return T_lidar_board;
  }
  throw std::runtime_error("no place for a board in the hall of seed " + std::to_string(seed));
}

/// A centre's error along the directions in which it is known: between sides that are open it may
/// rightly be anywhere.
struct KnownError {
  double norm_m = 0.0;
  double nees = 0.0;  ///< Over the number of these directions.
};

KnownError KnownErrorOf(const Eigen::Vector3d& error_m, const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  double square_m2 = 0.0;
  double nees = 0.0;
  int num_known = 0;
  for (int i = 0; i < 3; ++i) {
    const double variance_m2 = axes.eigenvalues()[i];
    if (variance_m2 > kKnownM * kKnownM) continue;
    const double along_m = axes.eigenvectors().col(i).dot(error_m);
    square_m2 += along_m * along_m;
    nees += along_m * along_m / variance_m2;
    ++num_known;
  }
  return {std::sqrt(square_m2), num_known > 0 ? nees / num_known : LidarSighting::kUnmeasured};
}

void Judge(const LidarBoard& found, LidarSighting* sighting) {
  const Eigen::Isometry3d& truth = sighting->T_lidar_board;
  const BoardPose& pose = found.pose;
  const Eigen::Vector3d centre_error_m = pose.centre_m - truth.translation();
  const double angle_rad = std::min(
      RotationAngleBetween(TransformFromPose(pose).linear(), truth.linear()),
      RotationAngleBetween(TransformFromPose(TurnedByHalf(pose)).linear(), truth.linear()));
  sighting->found = pose;
  sighting->num_measured_sides = NumMeasuredSides(found);
  sighting->centre_error_m = centre_error_m.norm();
  sighting->normal_error_rad = AngleBetween(pose.normal, truth.linear().col(2));
  const KnownError known = KnownErrorOf(centre_error_m, pose.covariance.bottomRightCorner<3, 3>());
  const bool is_right = known.norm_m < kWrongCentreM && angle_rad < kWrongAngleRad;
  sighting->verdict = is_right ? SightingVerdict::kRight : SightingVerdict::kWrong;
  sighting->centre_nees = known.nees;
  // A normal's error is a tilt about two directions in the board's plane.
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = pose.normal.unitOrthogonal();
  across.col(1) = pose.normal.cross(across.col(0));
  const Eigen::Vector2d tilt_rad = across.transpose() * pose.normal.cross(truth.linear().col(2));
  const Eigen::Matrix2d tilt_covariance =
      across.transpose() * pose.covariance.topLeftCorner<3, 3>() * across;
  sighting->normal_nees = tilt_rad.dot(tilt_covariance.ldlt().solve(tilt_rad)) / 2;
}

}  // namespace

std::string LidarSighting::Line() const {
  const Eigen::Quaterniond q(T_lidar_board.linear());
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << "seed " << seed << " board " << board << ": "
       << (verdict == SightingVerdict::kMissed  ? "missed, " + reason
           : verdict == SightingVerdict::kWrong ? "wrong"
                                                : "right");
  if (verdict != SightingVerdict::kMissed) {
    text << ", centre off by " << centre_error_m << " m, normal by " << normal_error_rad / kDeg
         << " deg, found at " << found.centre_m.transpose() << " m facing "
         << found.normal.transpose() << ", " << num_measured_sides << " sides measured, NEES "
         << centre_nees << ", " << normal_nees;
  }
  if (num_frames > 1) text << " in " << num_frames << " sweeps";
  text << "; " << hits.num_points << " points, " << hits.num_rings << " rings; t_m "
       << T_lidar_board.translation().transpose() << " q_xyzw " << q.coeffs().transpose();
  return text.str();
}

namespace {

/// What touches the board, beside what stands in the hall.
Props PropsAt(const LidarDetectionOptions& options,
              const Eigen::Isometry3d& T_lidar_board,
              std::uint32_t seed,
              int board) {
  const auto drawn_by = seed * 100 + static_cast<std::uint32_t>(board);
  const std::size_t edge = ContactEdge(T_lidar_board, Board(), drawn_by);
  Props props;
  if (options.contact) {
    props.Append(ContactProps(*options.contact, edge, T_lidar_board, Board()));
  }
  for (int i = 0; i < options.num_joined; ++i) {
    const std::size_t side = (edge + static_cast<std::size_t>(i)) % 4;
    props.Append(ContactProps(BoardContact::kDoor, side, T_lidar_board, Board()));
  }
  return props;
}

/// The truth, off by chance as far as it says.
BoardPrior PriorOf(const LidarDetectionOptions& options,
                   const Eigen::Isometry3d& T_lidar_board,
                   std::uint32_t seed,
                   int board) {
  const KeyedNoise noise(seed, NoiseUse::kStops, 1000 + board);
  BoardPrior prior;
  prior.covariance.diagonal() << Eigen::Vector3d::Constant(options.prior_sigma_rad).cwiseAbs2(),
      Eigen::Vector3d::Constant(options.prior_sigma_m).cwiseAbs2();
  Eigen::Vector3d turn_rad;
  Eigen::Vector3d shift_m;
  for (int i = 0; i < 3; ++i) {
    const auto [first, second] = noise.Normals(static_cast<std::uint64_t>(i));
    turn_rad[i] = options.prior_sigma_rad * first;
    shift_m[i] = options.prior_sigma_m * second;
  }
  prior.T_lidar_board = T_lidar_board;
  prior.T_lidar_board.linear() =
      Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()) * T_lidar_board.linear();
  prior.T_lidar_board.translation() += shift_m;
  return prior;
}

/// Of sweeps of a resting board, from the first to the last.
LidarBoardSighting Sight(const LidarSimulator& lidar,
                         const Eigen::Isometry3d& T_lidar_board,
                         const LidarBoardOptions& options,
                         const BoardPrior& prior,
                         ExpectedBoard expected,
                         std::int64_t first_us,
                         std::int64_t last_us) {
  const auto sweep = [&](std::int64_t utime) { return lidar.Sweep(T_lidar_board, utime); };
  const auto expect = [&] {
    return LidarBoardSighting{DetectLidarBoard(sweep(last_us), Board(), options, nullptr, prior)};
  };
  if (expected == ExpectedBoard::kAlways) return expect();
  AccumulatingDetector detector(Board(), options);
  for (std::int64_t utime = first_us; utime < last_us; utime += kSweepUs) {
    detector.Detect(sweep(utime), utime);
  }
  LidarBoardSighting found = detector.Detect(sweep(last_us), last_us);
  const bool is_unsure = !found.boards && expected == ExpectedBoard::kWhereUnsure;
  return is_unsure ? expect() : found;
}

}  // namespace

std::vector<LidarSighting> SightLidarBoards(const LidarDetectionOptions& options,
                                            const LidarBoardOptions& detector) {
  std::vector<LidarSighting> sightings;
  SimulationOptions simulation;
  simulation.scan.pattern = options.pattern;
  if (options.dropout) simulation.dropout = *options.dropout;
  const bool is_touched = options.contact.has_value() || options.num_joined > 0;
  while (static_cast<int>(sightings.size()) < options.num_sweeps) {
    simulation.seed = options.seed + static_cast<std::uint32_t>(sightings.size()) / kBoardsPerHall;
    const Props clutter = ClutterOf(simulation.seed);
    const Room room(Hall(), clutter);
    std::optional<LidarSimulator> lidar;
    if (!is_touched) lidar.emplace(simulation, Board(), room);
    for (int board = 0; board < kBoardsPerHall; ++board) {
      if (static_cast<int>(sightings.size()) == options.num_sweeps) break;
      const std::int64_t first_us = kSweepUs * board * options.num_frames;
      const std::int64_t last_us = first_us + kSweepUs * (options.num_frames - 1);
      LidarSighting sighting;
      sighting.seed = simulation.seed;
      sighting.board = board;
      sighting.T_lidar_board = DrawBoard(options, room, simulation.seed, board);
      if (is_touched) {
        Props props = clutter;
        props.Append(PropsAt(options, sighting.T_lidar_board, simulation.seed, board));
        lidar.emplace(simulation, Board(), Room(Hall(), props));
      }
      sighting.hits = lidar->CountBoardHits(sighting.T_lidar_board, last_us);
      const auto found = Sight(*lidar,
                               sighting.T_lidar_board,
                               detector,
                               PriorOf(options, sighting.T_lidar_board, simulation.seed, board),
                               options.expected,
                               first_us,
                               last_us);
      sighting.num_frames = static_cast<int>(found.accumulated_us / kSweepUs) + 1;
      if (found.boards) {
        Judge(found.boards->front(), &sighting);
      } else {
        sighting.reason = ToString(found.boards.error());
      }
      sightings.push_back(sighting);
    }
  }
  return sightings;
}

}  // namespace voqcal::test
