#include "core/simulation/board_contact.hpp"

#include <array>
#include <stdexcept>

#include "core/simulation/keyed_noise.hpp"

namespace voqcal {
namespace {

/// One edge: its middle, outwards and along, in the board's frame.
struct Edge {
  Eigen::Vector3d middle_m;
  Eigen::Vector3d outward;
  Eigen::Vector3d along;
  double length_m;
  double depth_m;  ///< Of the board, from this edge to the one opposite.
};

Edge EdgeOf(const BoardSpec& board, std::size_t edge) {
  const std::array<Eigen::Vector3d, 4> outline = board.OutlineBoardM();
  const Eigen::Vector3d begin_m = outline[edge];
  const Eigen::Vector3d end_m = outline[(edge + 1) % 4];
  const Eigen::Vector3d middle_m = (begin_m + end_m) / 2;
  const std::array<double, 4> lengths_m = board.EdgeLengthsM();
  return {middle_m,
          middle_m.normalized(),
          (end_m - begin_m).normalized(),
          lengths_m[edge],
          lengths_m[(edge + 1) % 4]};
}

/// A rectangle with its centre and axes in the board's frame.
Panel PanelAt(const Eigen::Isometry3d& T_lidar_board,
              const Eigen::Vector3d& centre_m,
              const Eigen::Vector3d& x,
              double width_m,
              const Eigen::Vector3d& y,
              double height_m,
              Material material) {
  Eigen::Isometry3d T_board_panel = Eigen::Isometry3d::Identity();
  T_board_panel.linear() << x, y, x.cross(y);
  T_board_panel.translation() = centre_m;
  return {T_lidar_board * T_board_panel, width_m, height_m, material};
}

Props Ground(const Eigen::Isometry3d& T_lidar_board, const Edge& edge) {
  constexpr double kSizeM = 2.0;
  Props props;
  props.panels.push_back(PanelAt(T_lidar_board,
                                 edge.middle_m,
                                 edge.along,
                                 kSizeM,
                                 Eigen::Vector3d::UnitZ(),
                                 kSizeM,
                                 Material::kFloor));
  return props;
}

Props Frame(const Eigen::Isometry3d& T_lidar_board, const Edge& edge) {
  constexpr double kBarM = 0.05;
  constexpr double kPostM = 0.08;
  constexpr double kPostLengthM = 0.6;
  const auto bar = [&](double from_m, double length_m, double width_m) {
    return PanelAt(T_lidar_board,
                   edge.middle_m + (from_m + length_m / 2) * edge.outward,
                   edge.along,
                   width_m,
                   edge.outward,
                   length_m,
                   Material::kMetal);
  };
  Props props;
  props.panels.push_back(bar(0.0, kBarM, edge.length_m));
  props.panels.push_back(bar(kBarM, kPostLengthM, kPostM));
  return props;
}

Props Hands(const Eigen::Isometry3d& T_lidar_board, const Edge& edge) {
  constexpr double kOverM = 0.04;    // fingers lie so far on the face
  constexpr double kBehindM = 0.35;  // the trunk
  Props props;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d grip_m = edge.middle_m - (side + 1) / 2 * edge.depth_m * edge.outward;
    const Eigen::Vector3d outward = -side * edge.outward;
    const Eigen::Vector3d fingers_m = grip_m - kOverM * outward + 0.02 * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d wrist_m = grip_m + 0.06 * outward;
    const Eigen::Vector3d elbow_m = grip_m + 0.15 * outward - kBehindM * Eigen::Vector3d::UnitZ();
    props.tubes.push_back(
        {T_lidar_board * fingers_m, T_lidar_board * wrist_m, 0.04, Material::kSkin});
    props.tubes.push_back(
        {T_lidar_board * wrist_m, T_lidar_board * elbow_m, 0.05, Material::kCloth});
  }
  props.panels.push_back(PanelAt(T_lidar_board,
                                 -kBehindM * Eigen::Vector3d::UnitZ(),
                                 edge.outward,
                                 0.45,
                                 -edge.along,
                                 1.6,
                                 Material::kCloth));
  return props;
}

Props Door(const Eigen::Isometry3d& T_lidar_board, const Edge& edge) {
  constexpr double kWidthM = 0.9;
  constexpr double kHeightM = 2.0;
  Props props;
  props.panels.push_back(PanelAt(T_lidar_board,
                                 edge.middle_m + kWidthM / 2 * edge.outward,
                                 edge.along,
                                 kHeightM,
                                 edge.outward,
                                 kWidthM,
                                 Material::kDoor));
  return props;
}

Props Table(const Eigen::Isometry3d& T_lidar_board, const Edge& edge) {
  constexpr double kNearer = 0.15;  // of the way to the lidar
  constexpr double kSizeM = 1.2;
  const Eigen::Vector3d lidar_m = T_lidar_board.inverse().translation();
  const Eigen::Vector3d hidden_m = edge.middle_m - edge.depth_m / 3 * edge.outward;
  const Eigen::Vector3d rim_m = hidden_m + kNearer * (lidar_m - hidden_m);
  Props props;
  props.panels.push_back(PanelAt(T_lidar_board,
                                 rim_m + kSizeM / 2 * edge.outward,
                                 edge.along,
                                 kSizeM,
                                 edge.outward,
                                 kSizeM,
                                 Material::kTable));
  return props;
}

}  // namespace

const std::vector<BoardContact>& AllBoardContacts() {
  static const std::vector<BoardContact> all = {BoardContact::kGround,
                                                BoardContact::kFrame,
                                                BoardContact::kHands,
                                                BoardContact::kDoor,
                                                BoardContact::kTable};
  return all;
}

std::string ToString(BoardContact contact) {
  switch (contact) {
    case BoardContact::kGround:
      return "ground";
    case BoardContact::kFrame:
      return "frame";
    case BoardContact::kHands:
      return "hands";
    case BoardContact::kDoor:
      return "door";
    case BoardContact::kTable:
      return "table";
  }
  throw std::logic_error("ToString: unknown BoardContact");
}

Props ContactProps(BoardContact contact,
                   std::size_t edge,
                   const Eigen::Isometry3d& T_lidar_board,
                   const BoardSpec& board) {
  const Edge at = EdgeOf(board, edge);
  switch (contact) {
    case BoardContact::kGround:
      return Ground(T_lidar_board, at);
    case BoardContact::kFrame:
      return Frame(T_lidar_board, at);
    case BoardContact::kHands:
      return Hands(T_lidar_board, at);
    case BoardContact::kDoor:
      return Door(T_lidar_board, at);
    case BoardContact::kTable:
      return Table(T_lidar_board, at);
  }
  throw std::logic_error("ContactProps: unknown BoardContact");
}

std::size_t ContactEdge(const Eigen::Isometry3d& T_lidar_board,
                        const BoardSpec& board,
                        std::uint32_t seed) {
  const Eigen::Vector3d lidar_m = T_lidar_board.inverse().translation();
  const KeyedNoise noise(seed, NoiseUse::kClutter, -1);
  auto edge = static_cast<std::size_t>(4 * noise.Uniform(0)) % 4;
  // Seen from outside, what is square to the board along the edge would hide it.
  const Edge drawn = EdgeOf(board, edge);
  if (drawn.outward.dot(lidar_m - drawn.middle_m) > -0.3) edge = (edge + 2) % 4;
  return edge;
}

}  // namespace voqcal
