#include "core/guidance/best_design.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/synthetic_samples.hpp"

namespace voqcal {
namespace {

constexpr double kNumPoses = 12.0;

// Each candidate tells of one parameter alone.
std::vector<Eigen::MatrixXd> OneEach(const Vector6d& information) {
  std::vector<Eigen::MatrixXd> candidates(6, Eigen::MatrixXd::Zero(6, 6));
  for (int i = 0; i < 6; ++i) candidates[static_cast<std::size_t>(i)](i, i) = information[i];
  return candidates;
}

Eigen::MatrixXd Nothing(Eigen::Index size) { return 1e-9 * Eigen::MatrixXd::Identity(size, size); }

// Of sum f_i / (a_i w_i) with sum w_i = n: w_i ~ sqrt(f_i / a_i), by Lagrange's condition.
TEST(BestDesign, IsTheClosedFormOfSeparateParameters) {
  Vector6d information;
  information << 1, 2, 3, 4, 5, 6;
  Vector6d form;
  form << 4, 1, 9, 1, 2, 3;
  const Design design =
      BestDesign(Nothing(6), OneEach(information), {Matrix6d(form.asDiagonal())}, kNumPoses);
  const Vector6d roots = form.cwiseQuotient(information).cwiseSqrt();
  // The error is within 1 % of the least, so a share of times within about its root, 10 %.
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(design.times[i], kNumPoses * roots[i] / roots.sum(), 0.3);
  }
  const double least = roots.sum() / std::sqrt(kNumPoses);
  EXPECT_NEAR(design.worst_error, least, 0.01 * least);
  EXPECT_LE(design.least_error, least);
}

TEST(BestDesign, BalancesTheWorstOfSeveralPoints) {
  // Two points that each see one parameter: the worst is least where both are alike.
  const std::vector<Matrix6d> forms = {Matrix6d(Vector6d::Unit(0).asDiagonal()),
                                       Matrix6d(4.0 * Matrix6d(Vector6d::Unit(1).asDiagonal()))};
  const Design design = BestDesign(Nothing(6), OneEach(Vector6d::Ones()), forms, 10.0);
  EXPECT_NEAR(design.times[0], 2.0, 0.2);
  EXPECT_NEAR(design.times[1], 8.0, 0.2);
}

TEST(BestDesign, IsNoWorseThanAnyOther) {
  constexpr Eigen::Index kSize = 9;  // of them three faults
  test::Random random(1);
  std::vector<Eigen::MatrixXd> candidates;
  for (int i = 0; i < 40; ++i) {
    const Eigen::MatrixXd rows = Eigen::MatrixXd::NullaryExpr(
        3, kSize, [&](Eigen::Index, Eigen::Index) { return random.Normal(); });
    candidates.push_back(rows.transpose() * rows);
  }
  std::vector<Matrix6d> forms;
  for (int i = 0; i < 5; ++i) {
    const Matrix6d root =
        Matrix6d::NullaryExpr([&](Eigen::Index, Eigen::Index) { return random.Normal(); });
    forms.push_back(root * root.transpose());
  }
  const Eigen::MatrixXd known = Eigen::MatrixXd::Identity(kSize, kSize);
  const Design design = BestDesign(known, candidates, forms, kNumPoses);
  EXPECT_NEAR(design.times.sum(), kNumPoses, 1e-9);
  EXPECT_GE(design.times.minCoeff(), 0.0);
  EXPECT_LE(design.least_error, design.worst_error);
  for (int draw = 0; draw < 200; ++draw) {
    Eigen::MatrixXd information = known;
    for (int i = 0; i < static_cast<int>(kNumPoses); ++i) {
      information += candidates[random.Index(candidates.size())];
    }
    const Matrix6d covariance = information.inverse().topLeftCorner<6, 6>();
    double worst = 0.0;
    for (const Matrix6d& form : forms) worst = std::max(worst, (form * covariance).trace());
    EXPECT_GE(std::sqrt(worst), design.least_error);
  }
}

TEST(BestDesign, NeedsSomethingToChooseFrom) {
  EXPECT_THROW(BestDesign(Nothing(6), {}, {Matrix6d::Identity()}, kNumPoses),
               std::invalid_argument);
}

}  // namespace
}  // namespace voqcal
