#include "core/simulation/clutter.hpp"

#include <algorithm>
#include <cmath>

#include "core/simulation/board_prop.hpp"
#include "core/simulation/keyed_noise.hpp"
#include "core/simulation/room.hpp"

namespace voqcal {
namespace {

constexpr double kWallClearanceM = 0.3;

// One thing's random numbers and its place on the floor.
class Draw {
 public:
  Draw(const ClutterOptions& options, const Box& hall, std::uint32_t seed, int thing)
      : noise_(seed, NoiseUse::kClutter, thing), floor_z_m_(hall.min_lidar_m.z()) {
    const Eigen::Vector3d margin_m = Eigen::Vector3d::Constant(kWallClearanceM);
    do {  // the hall is larger than what is kept free around the lidar
      const Eigen::Vector3d share(Next(), Next(), 0.0);
      place_m_ = hall.min_lidar_m + margin_m +
                 share.cwiseProduct(hall.max_lidar_m - hall.min_lidar_m - 2 * margin_m);
    } while (place_m_.head<2>().norm() < options.min_distance_m);
    place_m_.z() = floor_z_m_;
  }

  double Next() { return noise_.Uniform(num_drawn_++); }
  double Between(double low, double high) { return low + (high - low) * Next(); }
  const Eigen::Vector3d& PlaceM() const { return place_m_; }

  // Upright at the place, `height_m` above the floor, turned anywhere: x level, y up, z level.
  Eigen::Isometry3d Upright(double height_m) {
    const double azimuth_rad = Between(-M_PI, M_PI);
    Eigen::Isometry3d T_lidar_thing = Eigen::Isometry3d::Identity();
    T_lidar_thing.linear().col(2) =
        Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    T_lidar_thing.linear().col(1) = Eigen::Vector3d::UnitZ();
    T_lidar_thing.linear().col(0) =
        T_lidar_thing.linear().col(1).cross(T_lidar_thing.linear().col(2));
    T_lidar_thing.translation() = place_m_ + height_m * Eigen::Vector3d::UnitZ();
    return T_lidar_thing;
  }

 private:
  KeyedNoise noise_;
  double floor_z_m_;
  std::uint64_t num_drawn_ = 0;
  Eigen::Vector3d place_m_;
};

Props Tripod(Draw* draw) {
  const Eigen::Vector3d top_m = draw->PlaceM() + draw->Between(0.9, 1.6) * Eigen::Vector3d::UnitZ();
  const double turn_rad = draw->Between(0.0, 2.0);
  Props props;
  for (int leg = 0; leg < 3; ++leg) {
    const double azimuth_rad = turn_rad + leg * 2.0 * M_PI / 3.0;
    const Eigen::Vector3d foot_m =
        draw->PlaceM() + 0.4 * Eigen::Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
    props.tubes.push_back({foot_m, top_m, 0.015, Material::kMetal});
  }
  props.tubes.push_back({top_m, top_m + 0.3 * Eigen::Vector3d::UnitZ(), 0.02, Material::kMetal});
  return props;
}

Props OpenDoor(Draw* draw) {
  constexpr double kWidthM = 0.9;
  constexpr double kHeightM = 2.0;
  Props props;
  props.panels.push_back({draw->Upright(kHeightM / 2), kWidthM, kHeightM, Material::kDoor});
  return props;
}

// A crate, a cupboard or a table's top on a foot.
Props Furniture(Draw* draw) {
  const Eigen::Vector3d half_m(draw->Between(0.15, 0.6), draw->Between(0.15, 0.6), 0.0);
  const double height_m = draw->Between(0.3, 1.9);
  const Eigen::Vector3d up_m = height_m * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d low_m = draw->PlaceM() - half_m;
  const Eigen::Vector3d high_m = draw->PlaceM() + half_m + up_m;
  Props props;
  if (height_m > 1.0) {
    props.boxes.push_back({low_m, high_m, Material::kCupboard});
  } else if (height_m < 0.6) {
    props.boxes.push_back({low_m, high_m, Material::kCrate});
  } else {
    const Eigen::Vector3d under_m = low_m + up_m - 0.04 * Eigen::Vector3d::UnitZ();
    props.boxes.push_back({under_m, high_m, Material::kTable});
    props.tubes.push_back({draw->PlaceM(), draw->PlaceM() + up_m, 0.04, Material::kTable});
  }
  return props;
}

// Held as the true one may be: roughly facing the lidar, at any roll.
Props SecondBoard(const ClutterOptions& options,
                  const BoardSpec& board,
                  const Box& hall,
                  Draw* draw) {
  constexpr double kMaxTurnRad = 0.6;
  const Eigen::Vector3d facing = -draw->PlaceM().normalized();
  Panel panel;
  panel.width_m = options.second_board_scale * board.width_m;
  panel.height_m = options.second_board_scale * board.height_m;
  panel.T_lidar_panel.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), facing).toRotationMatrix() *
      (Eigen::AngleAxisd(draw->Between(-kMaxTurnRad, kMaxTurnRad), Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(draw->Between(-kMaxTurnRad, kMaxTurnRad), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(draw->Between(0.0, M_PI), Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  const double half_diagonal_m = std::hypot(panel.width_m, panel.height_m) / 2;
  const double hall_height_m = hall.max_lidar_m.z() - hall.min_lidar_m.z();
  const double height_m = std::min(half_diagonal_m + draw->Between(0.3, 0.8), hall_height_m / 2);
  panel.T_lidar_panel.translation() = draw->PlaceM() + height_m * Eigen::Vector3d::UnitZ();
  Props props;
  BoardSpec scaled = board;
  scaled.width_m = panel.width_m;
  scaled.height_m = panel.height_m;
  for (const Tube& tube : StandTubes(panel.T_lidar_panel, scaled, hall.min_lidar_m.z())) {
    props.tubes.push_back(tube);
  }
  props.panels.push_back(panel);
  return props;
}

}  // namespace

Props ClutterOf(const SimulationOptions& options, const BoardSpec& board) {
  ClutterOptions clutter;
  if (!options.has_clutter) {
    clutter.num_people = clutter.num_tripods = clutter.num_doors = clutter.num_furniture = 0;
  }
  clutter.second_board_scale = options.second_board_scale;
  return DrawClutter(clutter, board, Room().Interior(), options.seed);
}

Props Person(const Eigen::Vector3d& feet_m, double azimuth_rad) {
  const Eigen::Vector3d left(-std::sin(azimuth_rad), std::cos(azimuth_rad), 0.0);
  const Eigen::Vector3d ahead(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Props props;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d hip_m = feet_m + 0.85 * up + side * 0.10 * left;
    const Eigen::Vector3d shoulder_m = feet_m + 1.40 * up + side * 0.23 * left;
    const Eigen::Vector3d hand_m = feet_m + 1.05 * up + side * 0.28 * left + 0.25 * ahead;
    props.tubes.push_back({feet_m + side * 0.12 * left, hip_m, 0.08, Material::kCloth});
    props.tubes.push_back({shoulder_m, hand_m, 0.05, Material::kCloth});
  }
  props.tubes.push_back({feet_m + 0.80 * up, feet_m + 1.48 * up, 0.17, Material::kCloth});
  props.tubes.push_back({feet_m + 1.48 * up, feet_m + 1.78 * up, 0.09, Material::kSkin});
  return props;
}

Props DrawClutter(const ClutterOptions& options,
                  const BoardSpec& board,
                  const Box& hall,
                  std::uint32_t seed) {
  Props clutter;
  int thing = 0;
  const auto draw = [&] { return Draw(options, hall, seed, thing++); };
  for (int i = 0; i < options.num_people; ++i) {
    Draw person = draw();
    clutter.Append(Person(person.PlaceM(), person.Between(-M_PI, M_PI)));
  }
  for (int i = 0; i < options.num_tripods; ++i) {
    Draw tripod = draw();
    clutter.Append(Tripod(&tripod));
  }
  for (int i = 0; i < options.num_doors; ++i) {
    Draw door = draw();
    clutter.Append(OpenDoor(&door));
  }
  for (int i = 0; i < options.num_furniture; ++i) {
    Draw furniture = draw();
    clutter.Append(Furniture(&furniture));
  }
  if (options.second_board_scale > 0) {
    Draw second = draw();
    clutter.Append(SecondBoard(options, board, hall, &second));
  }
  return clutter;
}

}  // namespace voqcal
