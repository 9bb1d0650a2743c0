#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/board/board_spec.hpp"
#include "core/simulation/props.hpp"

namespace voqcal {

/// What touches a board, or stands right before it.
enum class BoardContact {
  kGround,  ///< A floor or a wall along one edge, square to the board.
  kFrame,   ///< A post and a bar in the board's plane, as an easel has.
  kHands,   ///< Two hands at opposite edges, and the arms and trunk behind.
  kDoor,    ///< A large leaf in the board's plane along one edge.
  kTable,   ///< A board's third away from one edge, something stands before it.
};

const std::vector<BoardContact>& AllBoardContacts();
std::string ToString(BoardContact contact);  ///< "ground", "frame", ...

/// What it is made of, at edge `edge` of the board (BoardSpec's order). The lidar is the origin.
Props ContactProps(BoardContact contact,
                   std::size_t edge,
                   const Eigen::Isometry3d& T_lidar_board,
                   const BoardSpec& board);

/// An edge from which the lidar sees the board's face past what stands along it, drawn by `seed`.
std::size_t ContactEdge(const Eigen::Isometry3d& T_lidar_board,
                        const BoardSpec& board,
                        std::uint32_t seed);

}  // namespace voqcal
