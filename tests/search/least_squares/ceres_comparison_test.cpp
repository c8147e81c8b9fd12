// SPDX-License-Identifier: Apache-2.0
// Ceres as independent reference: it solves the same residuals and must end at the same optimum.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "search/standard_problems.hpp"

namespace kinfer {
namespace {

/// Rows first .. first + count − 1 of a problem as one residual block of Ceres.
class Rows : public ceres::CostFunction {
 public:
  Rows(const Residuals& problem, Eigen::Index first, int count) : problem_(problem), first_(first) {
    set_num_residuals(count);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.unknowns));
  }

  bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    VectorXd r(problem_.rows);
    MatrixXd j(problem_.rows, problem_.unknowns);
    problem_.evaluate(Eigen::Map<const VectorXd>(x[0], problem_.unknowns), r, jacobians ? &j : nullptr);
    Eigen::Map<VectorXd>(residuals, num_residuals()) = r.segment(first_, num_residuals());
    if (jacobians && jacobians[0])
      Eigen::Map<RowMajor>(jacobians[0], num_residuals(), problem_.unknowns) = j.middleRows(first_, num_residuals());
    return r.allFinite();
  }

 private:
  const Residuals& problem_;
  Eigen::Index first_;
};

std::unique_ptr<ceres::LossFunction> ceres_loss(Loss loss, double limit) {
  switch (loss) {
    case Loss::none:
      return nullptr;
    case Loss::huber:
      return std::make_unique<ceres::HuberLoss>(limit);
    case Loss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(limit);
    case Loss::tukey:
      return std::make_unique<ceres::TukeyLoss>(limit);
  }
  return nullptr;
}

struct CeresFit {
  VectorXd x;
  double cost;  // without the 1/2 that Ceres has
};

CeresFit ceres_fit(const Residuals& problem, const VectorXd& start, Loss loss = Loss::none, double loss_scale = 1.0) {
  ceres::Problem peer;
  CeresFit fit{start, 0.0};
  Eigen::Index row = 0;
  for (const int size : problem.blocks) {
    peer.AddResidualBlock(new Rows(problem, row, size), ceres_loss(loss, loss_scale * std::sqrt(size)).release(),
                          fit.x.data());
    row += size;
  }
  if (row < problem.rows)
    peer.AddResidualBlock(new Rows(problem, row, static_cast<int>(problem.rows - row)), nullptr, fit.x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 2000;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-15;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &peer, &summary);
  fit.cost = 2.0 * summary.final_cost;
  return fit;
}

TEST(CeresComparison, StandardProblemsHaveTheSameOptimum) {
  for (const auto& problem : testing::standard_problems()) {
    const auto ours = least_squares(problem.residuals, problem.start, {.max_iterations = 500});
    const auto theirs = ceres_fit(problem.residuals, problem.start);
    EXPECT_LE(ours.cost, theirs.cost * (1 + 1e-10) + 1e-24) << problem.name;
    // The optimum of Powell's function is flat to fourth order, so its position is determined to the fourth root only.
    const double place = problem.name == "powell_singular" ? 1e-5 : 1e-6 * theirs.x.norm();
    EXPECT_LT((ours.x - theirs.x).norm(), place) << problem.name;
  }
}

TEST(CeresComparison, EveryLossGivesTheSameLineThroughOutliers) {
  const Residuals problem = testing::line_with_outliers();
  for (const Loss loss : testing::losses) {
    for (const double scale : {1.0, 3.0}) {
      const VectorXd start = Eigen::Vector2d(2.1, -1.1);  // tukey has other optima far away
      const auto ours = least_squares(problem, start, {.loss = loss, .loss_scale = scale});
      const auto theirs = ceres_fit(problem, start, loss, scale);
      EXPECT_TRUE(converged(ours.stop)) << name(ours.stop);
      EXPECT_NEAR(ours.cost, theirs.cost, 1e-9 * theirs.cost) << "loss " << int(loss) << " scale " << scale;
      EXPECT_LT((ours.x - theirs.x).norm(), 1e-6) << "loss " << int(loss) << " scale " << scale;
    }
  }
}

TEST(CeresComparison, EveryLossGivesTheSamePoseWithBlocksOfTwoRowsAndAPrior) {
  const Residuals problem = testing::planar_pose_with_outliers();
  for (const Loss loss : testing::losses) {
    const VectorXd start = Eigen::Vector3d(0.49, 1.01, 1.99);
    const auto ours = least_squares(problem, start, {.loss = loss, .loss_scale = 3.0});
    const auto theirs = ceres_fit(problem, start, loss, 3.0);
    EXPECT_TRUE(converged(ours.stop)) << name(ours.stop);
    EXPECT_NEAR(ours.cost, theirs.cost, 1e-9 * theirs.cost) << "loss " << int(loss);
    EXPECT_LT((ours.x - theirs.x).norm(), 1e-6) << "loss " << int(loss);
  }
}

}  // namespace
}  // namespace kinfer
