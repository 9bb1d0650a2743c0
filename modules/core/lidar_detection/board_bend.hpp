#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace voqcal {

/// How far a board is from flat.
struct BoardBend {
  double bend_m = 0.0;   ///< From the lowest to the highest place of the board, about its plane.
  double sigma_m = 0.0;  ///< Its standard error.
};

/// Fits z = a + b u + c v + d u^2 + e u v + f v^2, u and v from -1 to 1 over the board, and takes
/// the height of the quadratic part. Its error follows from the residuals, those of one scan line
/// taken as one draw (a cluster-robust covariance: Liang and Zeger 1986, Biometrika 73(1), eq. 2),
/// as each laser has an offset of its own.
///
/// @param points_board_m  in the board's frame, z out of its face.
/// @param rings           scan line of each point, or empty: then each point is a draw of its own.
BoardBend MeasureBend(const std::vector<Eigen::Vector3d>& points_board_m,
                      const std::vector<std::uint16_t>& rings,
                      double width_m,
                      double height_m);

}  // namespace voqcal
