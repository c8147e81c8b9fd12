// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/batch/batch_points.hpp"
#include "kinfer/kinematics/batch/batch_population.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/linalg/products.hpp"
#include "laws/example_chains.hpp"
#include "support/kernels.hpp"

namespace kinfer {
namespace {

constexpr int poses = 23;  // not a multiple of any number of lanes

Chain without_compliance(Chain chain) {
  for (Joint& joint : chain.joints) joint.compliance = 0.0;
  return chain;
}

std::vector<Chain> rigid_examples() {
  std::vector<Chain> list;
  for (const Chain& chain : laws::examples()) {
    list.push_back(without_compliance(chain));
    list.back().targets = {{"second", Vec3(0.01, 0.2, -0.03)}};
  }
  Chain on_axis = laws::er20();  // as in paper 2: base at the world origin, tool on the last axis
  on_axis.name = "ER20 on its axis", on_axis.base = {}, on_axis.tool = {};
  list.push_back(on_axis);
  return list;
}

/// Every geometric number and every gain is free.
ParameterSet everything(const Chain& chain) {
  ParameterSet set = all_parameters(chain, {});
  for (Parameter& p : set.parameters) p.free = field_of(p.at) != Field::compliance && field_of(p.at) != Field::coupling;
  return set;
}

ParameterSet links_only(const Chain& chain) {
  ParameterSet set = everything(chain);
  for (Parameter& p : set.parameters) {
    const std::optional<Field> field = field_of(p.at);
    const bool dh = field == Field::a || field == Field::alpha || field == Field::d || field == Field::theta;
    p.free = is_joint_parameter(p.at) && dh;
  }
  return set;
}

/// Base and tool, as in a fit that leaves the joints nominal: numbers between two joint motions are constant or absent.
ParameterSet frames_only(const Chain& chain) {
  ParameterSet set = everything(chain);
  for (Parameter& p : set.parameters) p.free = p.free && !is_joint_parameter(p.at);
  return set;
}

PointTable random_points(const Chain& chain, Rng rng) {
  PointTable table;
  table.joints = MatrixXd::NullaryExpr(dof(chain), poses, [&] { return rng.uniform(-2.5, 2.5); });
  table.measured = Eigen::Matrix3Xd::NullaryExpr(3, poses, [&] { return rng.normal(); });
  for (int i = 0; i < poses; ++i) table.target.push_back(chain.targets.empty() || i % 3 != 1 ? -1 : 0);
  return table;
}

MatrixXd candidates(const Chain& chain, const ParameterSet& set, int n, Rng rng) {
  return pack(set, chain).replicate(1, n).unaryExpr([&](double v) { return v + 0.02 * rng.normal(); });
}

Vec3 slow_error(const Chain& chain, const PointTable& table, int i) {
  const Vec3 on_tool = table.target[i] < 0 ? Vec3::Zero().eval() : chain.targets[table.target[i]].xyz;
  return Vec3(table.measured.col(i)) - forward(chain, table.joints.col(i)) * on_tool;
}

double slow_sum(const Chain& chain, const PointTable& table) {
  double sum = 0.0;
  for (int i = 0; i < poses; ++i) sum += slow_error(chain, table, i).squaredNorm();
  return sum;
}

class AnyRigidChain : public ::testing::TestWithParam<Chain> {};
INSTANTIATE_TEST_SUITE_P(Batch, AnyRigidChain, ::testing::ValuesIn(rigid_examples()));

TEST_P(AnyRigidChain, SumsOfPopulationsAreThoseOfSinglePoses) {
  const Chain chain = GetParam();
  const PointTable table = random_points(chain, Rng(1));
  for (const ParameterSet& set : {everything(chain), links_only(chain), frames_only(chain)}) {
    const MatrixXd x = candidates(chain, set, 19, Rng(2));
    for (const batch::Kernels* kernels : test::kernels_to_run()) {
      std::vector<double> sum(x.cols()), rough(x.cols());
      BatchPopulation<double>(chain, set, table, *kernels).sums(x, sum);
      BatchPopulation<float>(chain, set, table, *kernels).sums(x, rough);
      for (Eigen::Index i = 0; i < x.cols(); ++i) {
        const double slow = slow_sum(unpack(set, chain, x.col(i)), table);
        EXPECT_NEAR(sum[i], slow, 1e-12 * slow) << kernels->name;
        EXPECT_NEAR(rough[i], slow, 1e-5 * slow) << kernels->name;
      }
    }
  }
}

TEST_P(AnyRigidChain, ErrorsOfPointsAreThoseOfSinglePoses) {
  const Chain chain = GetParam();
  const PointTable table = random_points(chain, Rng(1));
  const ParameterSet set = everything(chain);
  const VectorXd x = candidates(chain, set, 1, Rng(2)).col(0);
  const Chain candidate = unpack(set, chain, x);
  for (const batch::Kernels* kernels : test::kernels_to_run()) {
    const BatchPoints points(chain, set, table, *kernels);
    Eigen::Matrix3Xd error;
    BatchPoints::Scratch scratch;
    points.errors(x, error, scratch);
    ASSERT_EQ(error.cols(), poses);
    for (int i = 0; i < poses; ++i) EXPECT_LT((error.col(i) - slow_error(candidate, table, i)).norm(), 1e-14 * 30);
  }
}

/// Residuals and Jacobian by PoseEvaluator, one pose after the other.
void slow_residuals(const Chain& chain, const ParameterSet& set, const PointTable& table,
                    const Eigen::Matrix3Xd& inverse_sd, VectorXd& r, MatrixXd& jacobian) {
  const PoseEvaluator evaluator(chain, set);
  r.resize(3 * poses), jacobian.resize(3 * poses, set.free_count());
  for (int i = 0; i < poses; ++i) {
    Twists twists;
    const Pose pose = evaluator.pose_and_derivative(table.joints.col(i), {}, twists);
    const Vec3 on_tool = table.target[i] < 0 ? Vec3::Zero().eval() : chain.targets[table.target[i]].xyz;
    const Vec3 arm = pose.rotation * on_tool, weight = inverse_sd.col(i);
    r.segment<3>(3 * i) = weight.cwiseProduct(slow_error(chain, table, i));
    jacobian.middleRows<3>(3 * i) = -(weight.asDiagonal() * (twists.topRows<3>() - skew(arm) * twists.bottomRows<3>()));
  }
}

TEST_P(AnyRigidChain, JacobianAndNormalEquationsAreThoseOfSinglePoses) {
  const Chain chain = GetParam();
  const PointTable table = random_points(chain, Rng(1));
  Rng rng(5);
  const Eigen::Matrix3Xd inverse_sd = Eigen::Matrix3Xd::NullaryExpr(3, poses, [&] { return rng.uniform(0.5, 2.0); });
  for (const ParameterSet& set : {everything(chain), links_only(chain), frames_only(chain)}) {
    const VectorXd x = candidates(chain, set, 1, Rng(2)).col(0);
    VectorXd slow_r, r, gradient;
    MatrixXd slow_jacobian, jacobian, matrix;
    slow_residuals(unpack(set, chain, x), set, table, inverse_sd, slow_r, slow_jacobian);
    for (const batch::Kernels* kernels : test::kernels_to_run()) {
      const BatchPoints points(chain, set, table, *kernels);
      const BatchPoints::Weights weights = points.weights(inverse_sd);
      BatchPoints::Scratch scratch;
      r.resize(slow_r.size()), jacobian.resizeLike(slow_jacobian);
      points.residuals(x, weights, r, jacobian, scratch);
      EXPECT_LT((r - slow_r).norm(), 1e-13 * slow_r.norm()) << kernels->name;
      EXPECT_LE((jacobian - slow_jacobian).norm(), 1e-13 * slow_jacobian.norm()) << kernels->name;
      const double cost = points.normal_equations(x, weights, matrix, gradient, scratch);
      EXPECT_NEAR(cost, slow_r.squaredNorm(), 1e-13 * cost) << kernels->name;
      EXPECT_LE((gradient - slow_jacobian.transpose() * slow_r).norm(), 1e-13 * slow_jacobian.norm() * slow_r.norm());
      const MatrixXd slow_matrix = gram(slow_jacobian).triangularView<Eigen::Lower>();
      EXPECT_LE((matrix - slow_matrix).norm(), 1e-13 * slow_matrix.norm()) << kernels->name;
    }
  }
}

TEST(Batch, ACandidatesSumDoesNotDependOnItsNeighbours) {
  const Chain chain = laws::er20_with_errors();
  const ParameterSet set = everything(chain);
  const PointTable table = random_points(chain, Rng(1));
  const MatrixXd x = candidates(chain, set, 37, Rng(2));
  const BatchPopulation<double> population(chain, set, table);
  std::vector<double> together(37), alone(37);
  population.sums(x, together);
  for (int i = 0; i < 37; ++i) population.sums(x.col(i), std::span(alone).subspan(i, 1));
  EXPECT_EQ(together, alone);
}

TEST(Batch, AnglesOfManyTurnsAreHandled) {
  const Chain chain = laws::er20();
  const ParameterSet set = links_only(chain);
  const PointTable table = random_points(chain, Rng(1));
  for (const double turns : {1.0, 1e3, 1e7}) {
    MatrixXd x = candidates(chain, set, 3, Rng(2));
    for (Eigen::Index k = 0; k < x.rows(); ++k)
      if (field_of(set.free()[k]->at) == Field::alpha) x.row(k).array() += 2.0 * 3.14159265358979323846 * turns;
    for (const batch::Kernels* kernels : test::kernels_to_run()) {
      std::vector<double> sum(3);
      BatchPopulation<double>(chain, set, table, *kernels).sums(x, sum);
      for (int i = 0; i < 3; ++i) {
        const double slow = slow_sum(unpack(set, chain, x.col(i)), table);
        EXPECT_NEAR(sum[i], slow, 1e-12 * slow) << kernels->name << ' ' << turns;
      }
    }
  }
}

TEST(Batch, ACompliantChainHasNoBatchForm) {
  EXPECT_FALSE(has_batch_form(laws::compliant(), everything(laws::compliant())));
  EXPECT_FALSE(has_batch_form(laws::er20(), all_parameters(laws::er20(), {})));
  EXPECT_TRUE(has_batch_form(laws::er20(), everything(laws::er20())));
  Chain coupled = laws::er20();
  coupled.joints[2].couplings = {{.joint = 1, .factor = 0.1}};
  ParameterSet set = everything(coupled);
  EXPECT_TRUE(has_batch_form(coupled, set));
  for (Parameter& p : set.parameters) p.free = p.free || field_of(p.at) == Field::coupling;
  EXPECT_FALSE(has_batch_form(coupled, set));
}

}  // namespace
}  // namespace kinfer
