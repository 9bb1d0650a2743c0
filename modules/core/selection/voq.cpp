#include "core/selection/voq.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "core/median.hpp"
#include "core/selection/best_sets.hpp"
#include "core/units.hpp"

namespace voqcal {
namespace {

constexpr double kLeastKappa = 3.0;  // of any 3x3 matrix: ||N||_F ||N^-1||_F >= trace(I)

// A determinant of three unit vectors below this is rounding: kappa would exceed about 1e6.
constexpr double kSingularDeterminant = 1e-12;

// What VOQ needs of one sample.
struct RankedPose {
  int sample = 0;
  double dimension_error_mm = 0.0;
  Eigen::Vector3d normal_lidar, normal_camera;
};

// e_dim by what was measured, and so much for each edge that was not.
double RankingErrorMm(const std::array<double, 4>& edge_lengths_m, const BoardSpec& board) {
  constexpr double kOpenEdgeMm = 50.0;
  const std::array<double, 4> true_lengths_m = board.EdgeLengthsM();
  double sum_m = 0.0;
  int num_open = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::isnan(edge_lengths_m[i])) {
      ++num_open;
    } else {
      sum_m += std::abs(edge_lengths_m[i] - true_lengths_m[i]);
    }
  }
  return kMmPerM * sum_m + kOpenEdgeMm * num_open;
}

// The samples, best first. The lower bound of the search relies on this order.
std::vector<RankedPose> RankByDimensionError(const std::vector<BoardSample>& samples,
                                             const BoardSpec& board) {
  std::vector<RankedPose> ranked;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double error_mm = RankingErrorMm(samples[i].lidar.edge_lengths_m, board);
    ranked.push_back({static_cast<int>(i),
                      error_mm,
                      samples[i].lidar.pose.normal,
                      samples[i].camera.pose.normal});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedPose& a, const RankedPose& b) {
    return a.dimension_error_mm < b.dimension_error_mm;
  });
  return ranked;
}

// The members in ascending order of their samples, so that every sum is taken in one order however
// the search came here.
ScoredTriple Score(const RankedPose& p0, const RankedPose& p1, const RankedPose& p2) {
  std::array<const RankedPose*, 3> p = {&p0, &p1, &p2};
  std::sort(p.begin(), p.end(), [](const RankedPose* a, const RankedPose* b) {
    return a->sample < b->sample;
  });
  const double kappa = std::max(
      NormalConditionNumber(p[0]->normal_lidar, p[1]->normal_lidar, p[2]->normal_lidar),
      NormalConditionNumber(p[0]->normal_camera, p[1]->normal_camera, p[2]->normal_camera));
  const double board_error_mm =
      (p[0]->dimension_error_mm + p[1]->dimension_error_mm + p[2]->dimension_error_mm) / 3.0;
  return {{p[0]->sample, p[1]->sample, p[2]->sample}, kappa + board_error_mm};
}

// False if no set with this e_be can be among the best any more.
bool CanEnter(const BestSets& best, double board_error_mm) {
  constexpr double kRoundingMargin = 1e-6;
  return kLeastKappa + board_error_mm <= best.Limit() + kRoundingMargin;
}

// Branch and bound over all combinations: kappa is never below 3 and e_dim ascends, so once 3 +
// e_be exceeds the worst set kept, so do all later sets of the same loop.
std::vector<ScoredTriple> LowestVoq(const std::vector<RankedPose>& ranked, int num_sets) {
  const auto error_mm = [&ranked](std::size_t i) { return ranked[i].dimension_error_mm; };
  BestSets best(num_sets);
  for (std::size_t i = 0; i + 2 < ranked.size(); ++i) {
    if (!CanEnter(best, (error_mm(i) + error_mm(i + 1) + error_mm(i + 2)) / 3.0)) break;
    for (std::size_t j = i + 1; j + 1 < ranked.size(); ++j) {
      if (!CanEnter(best, (error_mm(i) + error_mm(j) + error_mm(j + 1)) / 3.0)) break;
      for (std::size_t k = j + 1; k < ranked.size(); ++k) {
        if (!CanEnter(best, (error_mm(i) + error_mm(j) + error_mm(k)) / 3.0)) break;
        const ScoredTriple set = Score(ranked[i], ranked[j], ranked[k]);
        if (std::isfinite(set.score)) best.Offer(set);
      }
    }
  }
  return std::move(best).Sorted();
}

}  // namespace

double BoardDimensionErrorMm(const std::array<double, 4>& edge_lengths_m, const BoardSpec& board) {
  const std::array<double, 4> true_lengths_m = board.EdgeLengthsM();
  double sum_m = 0.0;
  int num_measured = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (std::isnan(edge_lengths_m[i])) continue;
    sum_m += std::abs(edge_lengths_m[i] - true_lengths_m[i]);
    ++num_measured;
  }
  if (num_measured == 4) return kMmPerM * sum_m;
  return kMmPerM * sum_m * 4 / num_measured;  // NaN if none was
}

double MedianBoardDimensionErrorMm(const std::vector<BoardSample>& samples,
                                   const BoardSpec& board) {
  std::vector<double> errors_mm;
  for (const BoardSample& sample : samples) {
    const double error_mm = BoardDimensionErrorMm(sample.lidar.edge_lengths_m, board);
    if (std::isfinite(error_mm)) errors_mm.push_back(error_mm);
  }
  return Median(std::move(errors_mm));
}

double NormalConditionNumber(const Eigen::Vector3d& n0,
                             const Eigen::Vector3d& n1,
                             const Eigen::Vector3d& n2) {
  // The columns of N^-1 are the cross products of N's rows over the determinant.
  const Eigen::Vector3d n12 = n1.cross(n2);
  const Eigen::Vector3d n20 = n2.cross(n0);
  const Eigen::Vector3d n01 = n0.cross(n1);
  const double determinant = std::abs(n0.dot(n12));
  if (!(determinant > kSingularDeterminant)) return std::numeric_limits<double>::infinity();
  const double squared_norm = n0.squaredNorm() + n1.squaredNorm() + n2.squaredNorm();
  const double squared_adjugate_norm = n12.squaredNorm() + n20.squaredNorm() + n01.squaredNorm();
  return std::sqrt(squared_norm * squared_adjugate_norm) / determinant;
}

double NormalConditionNumber(const std::vector<Eigen::Vector3d>& normals) {
  if (normals.size() == 3) return NormalConditionNumber(normals[0], normals[1], normals[2]);
  // ||N||_F^2 and ||N^+||_F^2 are the sums of the eigenvalues of N^T N and of their inverses.
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& normal : normals) gram += normal * normal.transpose();
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(eigenvalues[0] > kSingularDeterminant)) return std::numeric_limits<double>::infinity();
  return std::sqrt(eigenvalues.sum() * eigenvalues.cwiseInverse().sum());
}

VoqSet ScoreVoq(const std::vector<BoardSample>& samples,
                const std::vector<int>& poses,
                const BoardSpec& board) {
  VoqSet set;
  set.samples = poses;
  std::vector<Eigen::Vector3d> normals_lidar, normals_camera;
  double sum_mm = 0.0;
  for (const int pose : poses) {
    const BoardSample& sample = samples.at(static_cast<std::size_t>(pose));
    normals_lidar.push_back(sample.lidar.pose.normal);
    normals_camera.push_back(sample.camera.pose.normal);
    sum_mm += RankingErrorMm(sample.lidar.edge_lengths_m, board);
  }
  set.kappa_lidar = NormalConditionNumber(normals_lidar);
  set.kappa_camera = NormalConditionNumber(normals_camera);
  set.board_error_mm = sum_mm / static_cast<double>(poses.size());
  set.voq = std::max(set.kappa_lidar, set.kappa_camera) + set.board_error_mm;
  return set;
}

std::vector<VoqSet> SelectByVoq(const std::vector<BoardSample>& samples,
                                const BoardSpec& board,
                                int num_sets) {
  if (num_sets < 1) {
    throw std::invalid_argument("num_sets must be at least 1, is " + std::to_string(num_sets));
  }
  std::vector<VoqSet> sets;
  for (const ScoredTriple& best : LowestVoq(RankByDimensionError(samples, board), num_sets)) {
    sets.push_back(ScoreVoq(samples, {best.poses.begin(), best.poses.end()}, board));
  }
  return sets;
}

}  // namespace voqcal
