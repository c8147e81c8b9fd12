// SPDX-License-Identifier: Apache-2.0
// The normal equations summed chunk by chunk are those of the whole Jacobian.
#include "kinfer/estimate/poses/pose_normal_equations.hpp"

#include <gtest/gtest.h>

#include "kinfer/estimate/poses/point_fit.hpp"
#include "kinfer/linalg/products.hpp"
#include "support/differences.hpp"
#include "support/instruments.hpp"

namespace kinfer {
namespace {

using namespace test;

Chain soft_robot() {
  Chain chain = with_table3_errors(er20());
  chain.tool.xyz = Vec3(0.03, 0.02, 0.1);
  chain.masses = {{2, Vec3(0.4, 0, 0), 120.0}, {4, Vec3(0, 0, 0.1), 60.0}};
  chain.joints[1].compliance = 2e-6, chain.joints[2].compliance = 3e-6;
  chain.fixtures.sockets = {{"a", Vec3(1.0, 0.2, 0.5)}, {"b", Vec3(0.9, 0.4, 0.5)}};
  chain.fixtures.socket_distances = {{0, 1, 0.2, 1e-4}};
  return chain;
}

PoseSet simulated_poses(const Chain& chain, int poses) {
  PoseSet set = measured(chain, paper2_poses(poses, tracker));
  for (int row = 0; row < poses; row += 2)
    set.orientations.push_back({row, Quat(rot_x(0.02) * true_poses(chain, set)[row].rotation), Vec3(1e-3, 2e-3, 3e-3)});
  for (std::size_t i = 0; i < set.orientations.size(); i += 3)  // correlated errors of point and orientation
    set.orientations[i].covariance_with_point = 3e-8 * rot_x(0.1 * static_cast<double>(i));
  set.contacts = {{0, 0}, {1, 1}, {7, 0}};
  return set;
}

ParameterSet all_of(const Chain& chain) {
  ParameterSet set = all_parameters(chain, {});
  const ParameterSet around = setup_parameters(chain, {});
  set.parameters.insert(set.parameters.end(), around.parameters.begin(), around.parameters.end());
  return set;
}

/// Reference: from the Jacobian of all rows, weighted block by block.
double by_all_rows(const Residuals& problem, ConstVectorRef x, const BlockLoss& loss, NormalEquations& normal) {
  VectorXd r(problem.rows);
  MatrixXd jacobian(problem.rows, problem.unknowns);
  problem.evaluate(x, r, &jacobian);
  double cost = 0.0;
  Eigen::Index row = 0;
  for (const int size : problem.blocks) {
    const auto [rho, weight] =
        loss_value(loss.loss, r.segment(row, size).squaredNorm(), loss.scale * std::sqrt(static_cast<double>(size)));
    cost += rho;
    r.segment(row, size) *= std::sqrt(weight), jacobian.middleRows(row, size) *= std::sqrt(weight);
    row += size;
  }
  cost += r.tail(r.size() - row).squaredNorm();
  normal.matrix = gram(jacobian).triangularView<Eigen::Lower>();
  normal.gradient = jacobian.transpose() * r;
  return cost;
}

void expect_the_same(const Chain& chain, const ParameterSet& set, const PoseSet& data, ConstVectorRef x) {
  const Weights weights = weights_of(data, Instrument{.sigma = 1e-4, .sigma_angle = 1e-3, .ppm = 10});
  for (const BlockLoss loss : {BlockLoss{}, BlockLoss{Loss::cauchy, 2.0}, BlockLoss{Loss::huber, 0.5}}) {
    NormalEquations slow, quick;
    const double cost = by_all_rows(pose_residuals(chain, set, data, weights), x, loss, slow);
    const NormalProblem problem = pose_normal_problem(chain, set, data, weights, loss);
    EXPECT_NEAR(problem.linearise(x, quick), cost, 1e-10 * cost);
    EXPECT_NEAR(problem.cost(x), cost, 1e-10 * cost);
    EXPECT_LT((quick.matrix - slow.matrix).norm(), 1e-10 * slow.matrix.norm());
    EXPECT_LT((quick.gradient - slow.gradient).norm(), 1e-9 * slow.gradient.norm());
  }
}

TEST(PoseNormalEquations, ChunksOfAnyInstrumentsAddUpToTheWhole) {
  const Chain chain = soft_robot();
  for (const int poses : {9, 64, 150})
    expect_the_same(chain, all_of(chain), simulated_poses(chain, poses), pack(all_of(chain), chain));
}

TEST(PoseNormalEquations, KernelsHandlePointsAloneWithARobustLoss) {
  const Chain chain = with_table3_errors(er20());
  const PoseSet data = measured(chain, paper2_poses(70, tracker));
  ParameterSet set = all_parameters(er20(), {});
  std::erase_if(set.parameters, [](const Parameter& p) { return field_of(p.at) == Field::compliance; });
  ASSERT_TRUE(has_only_points(er20(), set, data));
  expect_the_same(er20(), set, data, pack(set, er20()));
}

TEST(PoseNormalEquations, KernelsHandlePointsWithFullCovariances) {
  const Chain chain = with_table3_errors(er20());
  PoseSet data = measured(chain, paper2_poses(70, tracker));
  ParameterSet set = all_parameters(er20(), {});
  std::erase_if(set.parameters, [](const Parameter& p) { return field_of(p.at) == Field::compliance; });
  for (std::size_t i = 0; i < data.points.size(); i += 2)
    data.points[i].sd = Vec3(1e-5, 2e-5, 4e-5), data.points[i].axes = rot_x(0.1 * static_cast<double>(i));
  ASSERT_TRUE(has_only_points(er20(), set, data));
  const VectorXd x = pack(set, er20());
  expect_the_same(er20(), set, data, x);
  const Weights weights = weights_of(data, Instrument{.sigma = 1e-4});
  PoseSet mixed = data;  // a second kind of measurement keeps the kernels away
  mixed.orientations.push_back({.row = 0, .orientation = Quat::Identity()});
  VectorXd r, slow;
  MatrixXd jacobian, slow_jacobian;
  pose_residuals(er20(), set, data, weights).evaluate(x, r, &jacobian);
  pose_residuals(er20(), set, mixed, weights_of(mixed, Instrument{.sigma = 1e-4})).evaluate(x, slow, &slow_jacobian);
  EXPECT_LT((r.head(210) - slow.head(210)).norm(), 1e-9 * slow.head(210).norm());
  EXPECT_LT((jacobian.topRows(210) - slow_jacobian.topRows(210)).norm(), 1e-9 * slow_jacobian.topRows(210).norm());
}

void expect_no_digit_to_depend_on_threads(const Chain& chain, const ParameterSet& set, const PoseSet& data) {
  const Weights weights = weights_of(data, Instrument{.sigma = 1e-4, .sigma_angle = 1e-3, .ppm = 10});
  const VectorXd x = pack(set, chain);
  for (const BlockLoss loss : {BlockLoss{}, BlockLoss{Loss::cauchy, 2.0}}) {
    NormalEquations alone;
    const NormalProblem one = pose_normal_problem(chain, set, data, weights, loss, 1);
    const double cost = one.linearise(x, alone);
    const double cost_alone = one.cost(x);
    for (const int threads : {2, 7}) {
      NormalEquations shared;
      const NormalProblem problem = pose_normal_problem(chain, set, data, weights, loss, threads);
      EXPECT_EQ(problem.linearise(x, shared), cost);
      EXPECT_EQ(problem.cost(x), cost_alone);
      EXPECT_EQ(shared.matrix, alone.matrix);
      EXPECT_EQ(shared.gradient, alone.gradient);
    }
  }
}

TEST(PoseNormalEquations, NoDigitDependsOnTheNumberOfThreads) {
  const Chain soft = soft_robot();
  expect_no_digit_to_depend_on_threads(soft, all_of(soft), simulated_poses(soft, 1300));
  const Chain chain = with_table3_errors(er20());
  const PoseSet data = measured(chain, paper2_poses(2500, tracker));  // three parts of the kernels
  ParameterSet set = all_parameters(er20(), {});
  std::erase_if(set.parameters, [](const Parameter& p) { return field_of(p.at) == Field::compliance; });
  ASSERT_TRUE(has_only_points(er20(), set, data));
  expect_no_digit_to_depend_on_threads(er20(), set, data);
  const Weights weights = weights_of(data, Instrument{.sigma = 1e-4});
  const VectorXd x = pack(set, er20());
  VectorXd r;
  pose_residuals(er20(), set, data, weights).evaluate(x, r, nullptr);
  const double whole = r.squaredNorm();
  EXPECT_NEAR(pose_normal_problem(er20(), set, data, weights, {}, 2).cost(x), whole, 1e-10 * whole);
}

/// Half the gradient of the cost is Jᵀr, with compliance too: torques are held constant, so the derivative is exact.
TEST(PoseNormalEquations, TheGradientOfACompliantRobotIsTheSlopeOfTheCost) {
  const Chain chain = soft_robot();
  const PoseSet data = simulated_poses(chain, 20);
  const ParameterSet set = all_of(chain);
  const Weights weights = weights_of(data, Instrument{.sigma = 1e-3, .sigma_angle = 1e-3});
  const NormalProblem problem = pose_normal_problem(chain, set, data, weights, {Loss::cauchy, 2.0});
  VectorXd x = pack(set, chain);
  Rng rng(5);
  for (Eigen::Index k = 0; k < x.size(); ++k) x[k] += 0.1 * set.free()[k]->scale * rng.normal();
  NormalEquations normal;
  problem.linearise(x, normal);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double step = 1e-4 * set.free()[k]->scale;
    VectorXd up = x, down = x;
    up[k] += step, down[k] -= step;
    const double slope = (problem.cost(up) - problem.cost(down)) / (4.0 * step);
    EXPECT_NEAR(normal.gradient[k], slope, 1e-5 * (1.0 / set.free()[k]->scale + std::abs(slope)))
        << set.free()[k]->name;
  }
}

}  // namespace
}  // namespace kinfer
