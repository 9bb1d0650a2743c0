#pragma once

#include <array>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"

namespace voqcal {

/// A set of poses and its Variability of Quality (Tsai et al. 2021, arXiv:2103.12287, whose
/// equations are numbered here in their order: 2 kappa, 3 kappa_LC, 4 e_dim, 5 e_be, 6 VOQ).
struct VoqSet {
  std::vector<int> samples;  ///< Indices into the samples, ascending: three, as published, or more.
  double kappa_lidar = 0.0;  ///< Condition number of the lidar's normals; at least 3.
  double kappa_camera = 0.0;    ///< Of the camera's.
  double board_error_mm = 0.0;  ///< e_be: mean over the poses of e_dim.
  double voq = 0.0;             ///< max(kappa_lidar, kappa_camera) + e_be, as published.
};

/// e_dim, Eq. 4: sum over the 4 edges of |measured - true|, millimetres. Edges that were not
/// measured (NaN) are taken to err as the others do; NaN if none was.
double BoardDimensionErrorMm(const std::array<double, 4>& edge_lengths_m, const BoardSpec& board);

/// Its median over samples, those without it left out; NaN if none has it.
double MedianBoardDimensionErrorMm(const std::vector<BoardSample>& samples, const BoardSpec& board);

/// Eq. 2, kappa(N) = ||N^-1||_F ||N||_F of the matrix whose rows are the unit normals; infinite if
/// singular. (The paper prints ||N^-1 N||; its text and its authors' code take the Frobenius
/// condition number.)
double NormalConditionNumber(const Eigen::Vector3d& n0,
                             const Eigen::Vector3d& n1,
                             const Eigen::Vector3d& n2);

/// The same of any number of normals, with the pseudo-inverse: equal to Eq. 2 for three.
double NormalConditionNumber(const std::vector<Eigen::Vector3d>& normals);

/// The VOQ of the set of these poses (indices, ascending).
VoqSet ScoreVoq(const std::vector<BoardSample>& samples,
                const std::vector<int>& poses,
                const BoardSpec& board);

/// The sets of lowest VOQ over all combinations of three, best first; ties by index. Fewer than
/// `num_sets` if there are fewer combinations; empty for fewer than three samples. Sets whose VOQ
/// is not finite are left out. An edge that was not measured adds 50 mm to e_dim here, more than a
/// good one errs: whole sightings come first, others where there are too few of them.
///
/// Exact for any number of samples, and fast: kappa is never below 3, so 3 + e_be bounds the VOQ,
/// and most combinations need no look.
/// @throws std::invalid_argument if `num_sets` is below 1.
std::vector<VoqSet> SelectByVoq(const std::vector<BoardSample>& samples,
                                const BoardSpec& board,
                                int num_sets);

}  // namespace voqcal
