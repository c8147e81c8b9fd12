// SPDX-License-Identifier: Apache-2.0
// The order of elementary motions of each convention, against the printed matrices; and their compiled form.
#include "kinfer/kinematics/elementary_motions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/kinematics/poses/pose_program.hpp"
#include "laws/example_chains.hpp"
#include "laws/slow_chain.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using elementary::Factor;
using elementary::Motion;

Pose random_pose(Rng& rng) {
  const Mat3 rotation = exp_so3(test::random_vector(rng));
  return {rotation, test::random_vector(rng)};
}

double largest_difference(const Pose& a, const Pose& b) {
  return std::max((a.position - b.position).norm(), (a.rotation - b.rotation).norm());
}

TEST(ElementaryMotion, RotatesAboutAndMovesAlongTheFramesOwnAxes) {
  Rng rng(1);
  for (int axis = 0; axis < 3; ++axis)
    for (const double value : {0.0, 0.7, -2.9, 3.2}) {
      const Pose start = random_pose(rng);
      const Vec3 unit = Vec3::Unit(axis);
      Pose turned = start, applied = start, moved = start;
      elementary::rotate(turned, axis, std::cos(value), std::sin(value));
      elementary::apply(applied, Motion::rotation, axis, value);
      elementary::apply(moved, Motion::translation, axis, value);
      const Pose rotation{Eigen::AngleAxisd(value, unit).toRotationMatrix(), Vec3::Zero()};
      EXPECT_LT(largest_difference(turned, start * rotation), 1e-15);
      EXPECT_LT(largest_difference(applied, start * rotation), 1e-15);
      EXPECT_LT(largest_difference(moved, start * Pose{Mat3::Identity(), value * unit}), 1e-15);
    }
}

TEST(ElementaryMotion, RotationToAnAxisMapsZToIt) {
  Rng rng(2);
  std::vector<Vec3> axes{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), -Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ()};
  axes.push_back(Vec3(1e-12, 0, 1).normalized());
  for (int k = 0; k < 20; ++k) axes.push_back(test::random_vector(rng).normalized());
  for (const Vec3& axis : axes) {
    const Mat3 r = elementary::rotation_to(axis);
    EXPECT_LT((r.col(2) - axis).norm(), 1e-14);
    EXPECT_LT((r * r.transpose() - Mat3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
  }
  EXPECT_EQ(elementary::rotation_to(Vec3::UnitZ()), Mat3::Identity());
}

/// Multiplies the factors and counts them.
struct ProductOfFactors {
  Pose product;
  double displacement = 0.0;
  int with_field = 0, moving = 0;

  void operator()(const Mat3& rotation) { product.rotation *= rotation; }
  void operator()(const Factor& factor) {
    with_field += factor.field.has_value();
    moving += factor.moves;
    elementary::apply(product, factor.motion, factor.axis, factor.value + (factor.moves ? displacement : 0.0));
  }
};

TEST(ElementaryMotion, FactorsOfEveryConventionMultiplyToItsPrintedMatrix) {
  for (const Chain& chain : laws::examples())
    for (Joint joint : chain.joints)
      for (const JointTypeTraits& row : joint_types) {
        joint.type = row.type;
        ProductOfFactors walk;
        walk.displacement = 0.37;
        elementary::for_each_factor(joint, walk);
        const laws::Mat4 printed =
            std::visit([&](const auto& link) { return laws::slow_link(link, row.type, 0.37); }, joint.link);
        const Pose expected{printed.topLeftCorner<3, 3>(), printed.topRightCorner<3, 1>()};
        EXPECT_LT(largest_difference(walk.product, expected), 1e-14) << chain.name << ' ' << joint.name;
        EXPECT_EQ(walk.with_field, std::holds_alternative<UrdfLink>(joint.link) ? 6 : 5);
        EXPECT_EQ(walk.moving, has_position(row.type) ? 1 : 0);
      }
}

TEST(ElementaryMotion, FactorsOfAFrameMultiplyToItsPose) {
  Rng rng(4);
  const Frame frame{test::random_vector(rng), exp_so3(test::random_vector(rng)), 0.1 * test::random_vector(rng)};
  ProductOfFactors walk;
  elementary::for_each_factor(frame, walk);
  EXPECT_LT(largest_difference(walk.product, frame.pose()), 1e-15);
  EXPECT_EQ(walk.with_field, 6);
}

/// Executes the steps one by one, with Eigen's own rotations.
Pose executed(const program::StepList& list, const VectorXd& displacement) {
  using Kind = program::Step::Kind;
  Pose pose;
  const auto turn = [&](int axis, double angle) {
    pose = pose * Pose{Eigen::AngleAxisd(angle, Vec3::Unit(axis)).toRotationMatrix(), Vec3::Zero()};
  };
  const auto shift = [&](int axis, double length) { pose = pose * Pose{Mat3::Identity(), length * Vec3::Unit(axis)}; };
  for (const program::Step& step : list.steps) {
    if (step.kind == Kind::rotate) turn(step.axis, std::atan2(step.b, step.a));
    if (step.kind == Kind::translate) shift(step.axis, step.a);
    if (step.kind == Kind::transform) pose = pose * list.constants[static_cast<std::size_t>(step.index)];
    if (step.kind == Kind::revolute_joint) turn(step.axis, step.a + displacement[step.index]);
    if (step.kind == Kind::prismatic_joint) shift(step.axis, step.a + displacement[step.index]);
  }
  return pose;
}

std::vector<program::Column> columns_of_all(const Chain& chain) {
  std::vector<program::Column> columns;
  for (const Parameter& parameter : all_parameters(chain, {}).parameters)
    columns.push_back({parameter.at, static_cast<int>(columns.size())});
  return columns;
}

long count_of_kind(const program::StepList& list, program::Step::Kind kind) {
  return std::count_if(list.steps.begin(), list.steps.end(), [&](const auto& step) { return step.kind == kind; });
}

TEST(PoseProgram, StepsExecutedOneByOneLeadToTheToolWhateverIsRecorded) {
  for (Chain chain : laws::examples()) {
    for (Joint& joint : chain.joints) joint.compliance = 0.0;
    const VectorXd q = laws::random_q(chain, Rng(5)), displacement = joint_displacements(chain, q);
    for (const auto& columns : {std::vector<program::Column>{}, columns_of_all(chain)}) {
      const program::StepList list = program::compile(chain, columns);
      EXPECT_LT(largest_difference(executed(list, displacement), forward(chain, q)), 1e-13) << chain.name;
    }
  }
}

TEST(PoseProgram, EveryColumnOnThePathIsRecordedAndNothingElse) {
  for (const Chain& chain : laws::examples()) {
    const auto columns = columns_of_all(chain);
    const program::StepList list = program::compile(chain, columns), bare = program::compile(chain, {});
    std::vector<int> records(columns.size(), 0);
    for (const program::Step& step : list.steps)
      if (step.kind == program::Step::Kind::record) ++records[static_cast<std::size_t>(step.index)];
    EXPECT_EQ(std::count(records.begin(), records.end(), 1), static_cast<long>(columns.size())) << chain.name;
    EXPECT_EQ(count_of_kind(bare, program::Step::Kind::record), 0);
    EXPECT_LE(bare.steps.size(), list.steps.size());
  }
}

TEST(PoseProgram, JointsAppearInTheOrderOfThePath) {
  const Chain chain = laws::two_arms();
  std::vector<int> joints;
  for (const program::Step& step : program::compile(chain, {}).steps)
    if (step.kind == program::Step::Kind::revolute_joint || step.kind == program::Step::Kind::prismatic_joint)
      joints.push_back(step.index);
  EXPECT_EQ(joints, path_to(chain, chain.tip_joint()));
}

TEST(PoseProgram, TheFlangeIsMarkedOnlyForAChainThatExpands) {
  Chain chain = laws::er20();
  EXPECT_EQ(count_of_kind(program::compile(chain, {}), program::Step::Kind::flange), 0);
  chain.expansion = 1e-5;
  EXPECT_EQ(count_of_kind(program::compile(chain, {}), program::Step::Kind::flange), 1);
}

}  // namespace
}  // namespace kinfer
