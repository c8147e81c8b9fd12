// SPDX-License-Identifier: Apache-2.0
// What the batch kernels are given, their sines, and the derivatives of many tool positions.
#include "kinfer/kinematics/batch/chain_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/batch/batch_points.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/poses/tool_derivatives.hpp"
#include "laws/example_chains.hpp"
#include "support/differences.hpp"
#include "support/kernels.hpp"

namespace kinfer {
namespace {

/// All numbers but compliances: of chains that do not yield this has a batch form.
ParameterSet without_compliances(const Chain& chain) {
  ParameterSet set = all_parameters(chain, {});
  for (Parameter& p : set.parameters) p.free = p.quantity != Quantity::compliance && p.name.find("coupling") != 0;
  return set;
}

TEST(Kernels, TheBestIsTheLastOfThoseThatRunAndThePortableIsFirst) {
  const auto kernels = test::kernels_to_run();
  ASSERT_FALSE(kernels.empty());
  EXPECT_EQ(kernels.front()->name, batch::portable_kernels.name);
  EXPECT_EQ(&batch::best_kernels(), kernels.back());
  for (std::size_t k = 1; k < kernels.size(); ++k) EXPECT_GT(kernels[k]->lanes, kernels[k - 1]->lanes);
}

TEST(Kernels, SinesAreRightToAFewUlpsForAnglesOfAnySize) {
  std::vector<double> angles{
      0.0, -0.0, 1e-300, 0.125, -0.125, 0.7853981633974483, 1.5707963267948966, 3.141592653589793};
  Rng rng(3);
  for (const double size : {0.1, 3.0, 100.0, 9e4, 1e8})
    for (int k = 0; k < 41; ++k) angles.push_back(rng.uniform(-size, size));  // not a multiple of any number of lanes
  for (const batch::Kernels* kernels : test::kernels_to_run()) {
    std::vector<double> c(angles.size()), s(angles.size());
    kernels->sines(angles.data(), static_cast<int>(angles.size()), c.data(), s.data());
    for (std::size_t k = 0; k < angles.size(); ++k) {
      EXPECT_NEAR(s[k], std::sin(angles[k]), 3e-16) << kernels->name << ' ' << angles[k];
      EXPECT_NEAR(c[k], std::cos(angles[k]), 3e-16) << kernels->name << ' ' << angles[k];
    }
    EXPECT_EQ(s[0], 0.0);
    EXPECT_EQ(c[0], 1.0);
    EXPECT_EQ(s[2], 1e-300);
  }
}

TEST(ChainPlan, PointsAreGroupedByTargetWithTheToolPointFirst) {
  Chain chain = laws::er20();
  chain.targets = {{"a", Vec3::UnitX()}, {"b", Vec3::UnitY()}, {"c", Vec3::UnitZ()}};
  PointTable table{MatrixXd::Zero(6, 6), Eigen::Matrix3Xd::Zero(3, 6), {2, -1, 0, 2, -1, 0}};
  const auto groups = batch::points_by_target(chain, table);
  ASSERT_EQ(groups.size(), 3u);  // nothing was measured on b
  EXPECT_EQ(groups[0].target, -1);
  EXPECT_EQ(groups[0].points, (std::vector<int>{1, 4}));
  EXPECT_EQ(groups[1].target, 0);
  EXPECT_EQ(groups[1].points, (std::vector<int>{2, 5}));
  EXPECT_EQ(groups[2].target, 2);
  EXPECT_EQ(groups[2].points, (std::vector<int>{0, 3}));
  table.target.clear();
  EXPECT_EQ(batch::points_by_target(chain, table).front().points.size(), 6u);
}

TEST(ChainPlan, AJointTakesCosineAndSineOrALengthAndItsPositionWhereTheGainIsFree) {
  const Chain chain = laws::scara();  // two turns, a slide, a turn
  const ParameterSet all = without_compliances(chain);
  const std::vector<std::string> lengths{"a1", "d1", "theta2"}, gains{"gain1", "gain3"};
  for (const auto& [names, slots] : {std::pair{lengths, 2 + 2 + 1 + 2}, {gains, 3 + 2 + 3 + 2}}) {
    const batch::ChainPlan plan = batch::plan_of(chain, with_only_free(all, names), batch::BaseSide::chain);
    EXPECT_EQ(plan.joint_motions.size(), 4u);
    EXPECT_EQ(batch::slots_of(plan.joint_motions), slots);
    int sum = 0;
    for (const batch::JointMotion& motion : plan.joint_motions) sum += motion.slots();
    EXPECT_EQ(sum, slots);
  }
  EXPECT_EQ(batch::slots_of({}), 0);
}

TEST(ChainPlan, ItemsHoldTheSinesOfTheJointPositionsAndTheMeasuredPoint) {
  const Chain chain = laws::scara();
  const auto plan =
      batch::plan_of(chain, with_only_free(all_parameters(chain, {}), {"a1", "gain3"}), batch::BaseSide::chain);
  PointTable table{MatrixXd(4, 1), Eigen::Matrix3Xd(3, 1), {}};
  table.joints << 0.1, 0.2, 0.3, 0.4;
  table.measured << 1, 2, 3;
  const Pose frame = Pose::from_xyz_rpy({0.5, 0.6, 0.7}, {0.1, 0.2, 0.3});
  const MatrixXd items = batch::items_of(plan.joint_motions, table, frame, batch::portable_kernels);
  ASSERT_EQ(items.rows(), 1);
  ASSERT_EQ(items.cols(), 9 + 3);
  const auto is = [&](int joint, int number) { return items(0, plan.joint_motions[joint].slot + number); };
  for (const int joint : {0, 1, 3}) {
    const double q = table.joints(joint, 0);
    EXPECT_NEAR(is(joint, 0), std::cos(q), 1e-15);
    EXPECT_NEAR(is(joint, 1), std::sin(q), 1e-15);
  }
  EXPECT_NEAR(is(2, 0), 0.98 * 0.3, 1e-15);  // the nominal gain
  EXPECT_NEAR(is(2, 1) + is(2, 2), 0.3, 1e-15);
  EXPECT_LT((items.rightCols<3>().transpose() - frame.inverse() * Vec3(1, 2, 3)).norm(), 1e-15);
}

TEST(ToolDerivatives, AreThePositionsAndTheirSlopesWithAndWithoutBatchForm) {
  for (Chain chain : laws::examples_with_joints()) {
    chain.masses.clear();
    const MatrixXd joints = (MatrixXd(dof(chain), 3) << laws::random_q(chain, Rng(1)), laws::random_q(chain, Rng(2)),
                             laws::random_q(chain, Rng(3)))
                                .finished();
    for (const double expansion : {0.0, 1e-5}) {  // an expanding chain has no batch form
      chain.expansion = expansion;
      const ParameterSet set = without_compliances(chain);
      const ToolDerivatives tool = tool_derivatives(chain, set, joints);
      ASSERT_EQ(tool.jacobian.rows(), 9);
      ASSERT_EQ(tool.jacobian.cols(), set.free_count());
      const MatrixXd slopes = testing::numeric_jacobian(
          [&](const VectorXd& x) {
            VectorXd positions(9);
            for (int i = 0; i < 3; ++i)
              positions.segment<3>(3 * i) = forward(unpack(set, chain, x), joints.col(i)).position;
            return positions;
          },
          pack(set, chain));
      EXPECT_LT((tool.jacobian - slopes).norm(), 1e-7 * (1.0 + slopes.norm())) << chain.name;
      for (int i = 0; i < 3; ++i)
        EXPECT_LT((tool.position.col(i) - forward(chain, joints.col(i)).position).norm(), 1e-13) << chain.name;
    }
  }
}

TEST(BatchPoints, NumbersInTheKernelsLayoutHaveTheSameSquares) {
  const Chain chain = laws::er20_with_errors();
  const ParameterSet set = without_compliances(chain);
  constexpr int count = 13;
  Rng rng(6);
  PointTable table{MatrixXd::NullaryExpr(6, count, [&] { return rng.uniform(-2, 2); }),
                   Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return rng.normal(); }),
                   {}};
  const Eigen::Matrix3Xd inverse_sd = Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return rng.uniform(1, 3); });
  const VectorXd x = pack(set, chain);
  for (const batch::Kernels* kernels : test::kernels_to_run()) {
    const BatchPoints points(chain, set, table, *kernels);
    EXPECT_EQ(points.points(), count);
    EXPECT_EQ(points.unknowns(), set.free_count());
    const auto weights = points.weights(inverse_sd);
    BatchPoints::Scratch scratch;
    Eigen::Matrix3Xd error;
    points.errors(x, error, scratch);
    const double cost = error.cwiseProduct(inverse_sd).squaredNorm();
    EXPECT_NEAR(points.cost(x, weights, scratch), cost, 1e-12 * cost) << kernels->name;
    const int numbers = 3 * kernels->lanes * ((count + kernels->lanes - 1) / kernels->lanes);
    const VectorXd lane_errors = VectorXd::Map(points.lane_errors(x, scratch), numbers);
    double weighted = 0.0;
    for (int k = 0; k < numbers; ++k) weighted += std::pow(lane_errors[k] * weights.data()[k], 2);
    EXPECT_NEAR(weighted, cost, 1e-12 * cost) << kernels->name;
    const MatrixXd lanes = MatrixXd::Map(points.lane_jacobian(x, weights, scratch), numbers, 1 + points.unknowns());
    VectorXd residual(3 * count);
    MatrixXd jacobian(3 * count, points.unknowns());
    points.residuals(x, weights, residual, jacobian, scratch);
    EXPECT_NEAR(lanes.col(0).squaredNorm(), cost, 1e-12 * cost) << kernels->name;
    for (Eigen::Index k = 0; k < points.unknowns(); ++k)
      EXPECT_NEAR(lanes.col(1 + k).norm(), jacobian.col(k).norm(), 1e-11 * (1.0 + jacobian.col(k).norm()));
  }
}

}  // namespace
}  // namespace kinfer
