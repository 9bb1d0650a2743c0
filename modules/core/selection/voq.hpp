#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/board/board_sample.hpp"
#include "core/board/board_spec.hpp"

namespace voqcal {

/// One set of three poses and its Variability of Quality (Tsai et al. 2021, arXiv:2103.12287, whose
/// equations are numbered here in their order: 2 kappa, 3 kappa_LC, 4 e_dim, 5 e_be, 6 VOQ).
struct VoqSet {
  std::array<int, 3> samples{};  ///< Indices into the samples, ascending.
  double kappa_lidar = 0.0;      ///< ||N^-1||_F ||N||_F of the three lidar normals; at least 3.
  double kappa_camera = 0.0;
  double board_error_mm = 0.0;  ///< e_be: mean over the poses of e_dim.
  double voq = 0.0;             ///< max(kappa_lidar, kappa_camera) + e_be, as published.
};

struct VoqOptions {
  int num_sets = 50;  ///< How many sets of lowest VOQ are kept.

  /// One line for each broken constraint, with its value; empty if the options are usable.
  std::vector<std::string> Problems() const;
};

/// e_dim, Eq. 4: sum over the 4 edges of |measured - true|,
/// millimetres.
double BoardDimensionErrorMm(const std::array<double, 4>& edge_lengths_m, const BoardSpec& board);

/// Eq. 2, kappa(N) = ||N^-1||_F ||N||_F of the matrix whose rows are the unit normals; infinite if
/// singular. (The paper prints ||N^-1 N||; its text and its authors' code take the Frobenius
/// condition number.)
double NormalConditionNumber(const Eigen::Vector3d& n0,
                             const Eigen::Vector3d& n1,
                             const Eigen::Vector3d& n2);

/// The sets of lowest VOQ over all combinations of three, best first; ties by index. Fewer than
/// `num_sets` if there are fewer combinations; empty for fewer than three samples.
/// Sets with an infinite condition number are left out.
std::vector<VoqSet> SelectByVoq(const std::vector<BoardSample>& samples,
                                const BoardSpec& board,
                                const VoqOptions& options);

}  // namespace voqcal
