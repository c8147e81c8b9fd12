// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/joint_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "kinfer/track/model/filter_model.hpp"
#include "support/random_tracked_tree.hpp"

namespace kinfer::track {
namespace {

using Eigen::Index;

struct Tree {
  explicit Tree(std::uint64_t seed) {
    Rng rng(seed);
    model = filter_model(test::random_tree(rng));
    state = test::random_state(model, rng);
    const MatrixXd root = MatrixXd::Random(rows(), rows());
    s = root * root.transpose() + 0.1 * MatrixXd::Identity(rows(), rows());
    innovation = VectorXd::Random(rows());
  }
  Index rows() const { return model.layout.rows(); }

  FilterModel model;
  ChainState state;
  MatrixXd s;
  VectorXd innovation;
};

constexpr std::size_t hinge = 0, universal = 1, slide = 2;

JointChanges examined(const Tree& tree, const MatrixXd& s, const VectorXd& innovation, bool is_base_still,
                      std::size_t doubted = 99) {
  JointChanges changes(tree.model);
  if (doubted < changes.size()) changes.doubt(doubted, true);
  ChainEvaluator evaluator(tree.model);
  evaluator.evaluate(tree.model, tree.state);
  changes.form(tree.model, evaluator, std::vector<bool>(static_cast<std::size_t>(tree.rows() / 3), true),
               is_base_still);
  const MatrixXd inverse = s.llt().matrixL().solve(MatrixXd::Identity(tree.rows(), tree.rows()));  // a second, slow way
  for (int i = 0; i < 200; ++i)
    for (const bool are_doubted : {true, false}) changes.examine(inverse, inverse * innovation, are_doubted);
  return changes;
}

/// Rows that a change of the first body beyond the joint brings about, by differences of the chain's own propagation:
/// that body's angular velocity and force are moved, and all beyond follow.
MatrixXd rows_by_differences(const Tree& tree, std::size_t joint) {
  const auto states_of = [&](Index component, double step) {
    const FilterModel& model = tree.model;
    std::vector<InsState> states{tree.state.base_state(model.gravity)};
    for (std::size_t b = 1; b < model.bodies.size(); ++b) {
      InsBody body = model.bodies[b];
      const ParentSide side = parent_side(model, tree.state, b);
      body.parent_R_axis = side.parent_R_axis;
      body.point_in_parent = side.point_in_parent;
      if (body.motion == JointMotion::spherical) body.parent_R_axis = body.parent_R_axis * tree.state.spherical[b];
      JointKinematicState q{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
      for (Index i = 0; i < degrees_of_freedom(body.motion); ++i)
        for (Index k = 0; k < position_states; ++k)
          q[static_cast<std::size_t>(k)][i] = tree.state.joints[position_states * (model.layout.position[b] + i) + k];
      states.push_back(propagated(body, q, states[static_cast<std::size_t>(body.parent)]));
      if (b != model.joints[joint].bodies.front()) continue;
      if (component < 3)
        states.back().angular_velocity[component] += step;
      else
        states.back().force[component - 3] += step;
    }
    VectorXd value = VectorXd::Zero(tree.rows());
    for (std::size_t s = 0; s < model.sensors.size(); ++s) {
      const InsState& at = states[static_cast<std::size_t>(model.sensors[s].body)];
      value.segment<3>(sensor_rows * static_cast<Index>(s)) = at.angular_velocity;
      value.segment<3>(sensor_rows * static_cast<Index>(s) + 3) = at.force;
    }
    return value;
  };
  MatrixXd rows(tree.rows(), 6);
  for (Index c = 0; c < 6; ++c) rows.col(c) = (states_of(c, 1e-6) - states_of(c, -1e-6)) / 2e-6;
  return rows;
}

TEST(JointChanges, TIsThatOfTheLikelihoodRatioWithDifferencesOfTheChain) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Tree tree(seed);
    const JointChanges changes = examined(tree, tree.s, tree.innovation, true);
    for (const std::size_t joint : {hinge, universal, slide}) {
      const MatrixXd f = rows_by_differences(tree, joint), weighted = tree.s.ldlt().solve(f);
      const VectorXd b = weighted.transpose() * tree.innovation;
      const MatrixXd a = f.transpose() * weighted;
      ASSERT_TRUE(changes.is_told(joint));
      EXPECT_NEAR(changes.distance(joint) / b.dot(a.ldlt().solve(b)), 1.0, 1e-5) << joint;
    }
  }
}

TEST(JointChanges, OfOneSensorOnASideAreNotTold) {
  const Tree tree(7);
  const JointChanges still = examined(tree, tree.s, tree.innovation, true),
                     moving = examined(tree, tree.s, tree.innovation, false);
  EXPECT_TRUE(still.is_told(hinge)) << "a base that is still stands for a sensor";
  EXPECT_FALSE(moving.is_told(hinge));
  for (const std::size_t joint : {std::size_t{3}, std::size_t{4}}) EXPECT_FALSE(still.is_told(joint)) << joint;
  EXPECT_TRUE(std::ranges::all_of(std::vector{3, 4}, [&](int j) { return still.distance(std::size_t(j)) == 0.0; }));
}

/// With a change of the slide that is far beyond S, the widened S expects just such a change.
TEST(JointChanges, WhatIsInDoubtIsExpectedToChange) {
  const Tree tree(3);
  const MatrixXd f = rows_by_differences(tree, slide);
  const VectorXd shaken = 1e-3 * tree.innovation + f.col(4) * 50.0;
  const JointChanges doubting = examined(tree, tree.s, shaken, true, slide);
  MatrixXd widened = tree.s;
  doubting.widen(widened);
  widened.triangularView<Eigen::StrictlyUpper>() = widened.transpose();
  const MatrixXd added = widened - tree.s;
  EXPECT_GT(doubting.distance(slide), 1000.0);
  EXPECT_EQ(Eigen::FullPivLU<MatrixXd>(added).setThreshold(1e-9).rank(), 3) << "its force, and not its rate";
  const JointChanges again = examined(tree, widened, shaken, true);
  EXPECT_LT(again.distance(slide), 6.0);
  EXPECT_GT(again.distance(slide), 0.5);
  MatrixXd unchanged = tree.s;
  examined(tree, tree.s, shaken, true).widen(unchanged);
  EXPECT_EQ(unchanged, tree.s);
}

}  // namespace
}  // namespace kinfer::track
