// SPDX-License-Identifier: Apache-2.0
// Poses of many rows by the kernels, judged by PoseEvaluator, which finds them one by one.
#include "kinfer/kinematics/poses/batch_poses.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "laws/example_chains.hpp"
#include "support/kernels.hpp"
#include "support/random_field.hpp"

namespace kinfer {
namespace {

/// Every effect beyond geometry in every joint that can have it.
Chain with_all_effects(Chain chain) {
  Rng rng(11);
  const std::vector<int> q_index = active_joint_indices(chain);
  for (std::size_t j = 0; j < chain.joints.size(); ++j) {
    Joint& joint = chain.joints[j];
    if (!has_position(joint.type)) continue;
    joint.gain *= 1.01;
    if (rotates(joint.type)) joint.compliance = 1e-5, joint.torque_compliance = 2e-5;
    if (q_index[j] < 0) continue;
    joint.backlash = 1e-3;
    if (j % 2 == 0)
      for (int order = 0; order < 9; ++order) {
        const double sine = 1e-3 * rng.normal(), cosine = 1e-3 * rng.normal();
        joint.harmonics.push_back({static_cast<double>(order), sine, cosine});
      }
    joint.harmonics.push_back({17.5, 1e-3, -2e-3});
    chain.masses.push_back({static_cast<int>(j), Vec3(0.1, -0.2, 0.05), 4.0});
  }
  chain.expansion = 1e-4;
  return chain;
}

/// Rows with loads, which it owns.
class LoadedRows {
 public:
  LoadedRows(const Chain& chain, int count) : poses(count), twists(count) {
    const auto dofs = static_cast<std::size_t>(dof(chain));
    for (int i = 0; i < count; ++i) {
      Rng rng(100 + i);
      q_.push_back(laws::random_q(chain, Rng(i)));
      std::vector<double>&torque = torques_.emplace_back(), &approach = approach_.emplace_back();
      for (std::size_t k = 0; k < dofs; ++k) {
        torque.push_back(rng.index(5) == 0 ? std::numeric_limits<double>::quiet_NaN() : 20.0 * rng.normal());
        approach.push_back(rng.index(2) == 0 ? 1.0 : -1.0);
      }
      loads_.push_back({.payload = i % 3 == 0 ? 0.0 : 5.0, .temperature_rise = 10.0 * rng.normal()});
    }
    for (std::size_t i = 0; i < loads_.size(); ++i) loads_[i].torques = torques_[i], loads_[i].approach = approach_[i];
  }

  std::vector<PoseRow> rows(bool derivatives) {
    std::vector<PoseRow> rows;
    for (std::size_t i = 0; i < q_.size(); ++i)
      rows.push_back({q_[i].data(), loads_[i], &poses[i], derivatives ? &twists[i] : nullptr});
    return rows;
  }
  const VectorXd& q(std::size_t i) const { return q_[i]; }
  Load& load(std::size_t i) { return loads_[i]; }
  std::size_t size() const { return q_.size(); }

  std::vector<Pose> poses;
  std::vector<Twists> twists;

 private:
  std::vector<VectorXd> q_;
  std::vector<std::vector<double>> torques_, approach_;
  std::vector<Load> loads_;
};

void expect_equal(const Pose& found, const Pose& expected, const std::string& where) {
  EXPECT_LT((found.position - expected.position).norm(), 1e-12) << where;
  EXPECT_LT((found.rotation - expected.rotation).norm(), 1e-12) << where;
}

void expect_those_of_the_evaluator(const Chain& chain, const ParameterSet& set, int count) {
  const PoseEvaluator evaluator(chain, set);
  for (const batch::Kernels* kernels : test::kernels_to_run()) {
    const BatchPoses batch(chain, set, *kernels);
    BatchPoses::Scratch scratch;
    LoadedRows at(chain, count);
    batch.evaluate(at.rows(false), scratch);
    for (std::size_t i = 0; i < at.size(); ++i)
      expect_equal(at.poses[i], evaluator.pose(at.q(i), at.load(i)), chain.name + " " + kernels->name);
    batch.evaluate(at.rows(true), scratch);
    for (std::size_t i = 0; i < at.size(); ++i) {
      Twists expected;
      expect_equal(at.poses[i], evaluator.pose_and_derivative(at.q(i), at.load(i), expected), chain.name);
      ASSERT_EQ(at.twists[i].cols(), expected.cols());
      EXPECT_LT((at.twists[i] - expected).cwiseAbs().maxCoeff(), 1e-11 * (1.0 + expected.cwiseAbs().maxCoeff()))
          << chain.name << " " << kernels->name;
    }
  }
}

TEST(BatchPoses, AreThoseOfTheEvaluatorWithAllEffectsOfAllMachines) {
  for (const Chain& example : laws::examples()) {
    const Chain chain = with_all_effects(example);
    expect_those_of_the_evaluator(chain, all_parameters(chain, {}), 9);
  }
}

TEST(BatchPoses, AreThoseOfTheEvaluatorAtAnyNumberOfRows) {
  const Chain chain = with_all_effects(laws::coupled());
  const ParameterSet set = with_only_free(all_parameters(chain, {}), {"a2", "gain3", "tool_rx"});
  for (const int rows : {1, 2, 3, 4, 7, 8, 15, 16, 17}) expect_those_of_the_evaluator(chain, set, rows);
}

TEST(BatchPoses, WithAFieldAreThoseOfTheEvaluator) {
  Chain chain = laws::er20_with_errors();
  chain.field = test::random_field(dof(chain), 7, Rng(3));
  expect_those_of_the_evaluator(chain, all_parameters(chain, {}), 5);
}

TEST(BatchPoses, OfARigidChainAreThoseOfTheEvaluator) {
  for (const Chain& chain : laws::examples()) expect_those_of_the_evaluator(chain, all_parameters(chain, {}), 3);
}

TEST(BatchPoses, GivenGravityTorquesTakeThePlaceOfThoseOfTheMasses) {
  const Chain chain = with_all_effects(laws::compliant());
  const std::array<double, 6> torques{100, -200, 50, 30, -20, 10};
  const PoseEvaluator evaluator(chain, {});
  LoadedRows at(chain, 4);
  for (std::size_t i = 0; i < at.size(); ++i) at.load(i).gravity = torques;
  BatchPoses::Scratch scratch;
  BatchPoses(chain, {}).evaluate(at.rows(false), scratch);
  for (std::size_t i = 0; i < at.size(); ++i)
    expect_equal(at.poses[i], evaluator.pose(at.q(i), at.load(i)), chain.name);
}

TEST(BatchPoses, OfNoRowsAreNone) {
  BatchPoses::Scratch scratch;
  EXPECT_NO_FATAL_FAILURE(BatchPoses(laws::er20(), {}).evaluate({}, scratch));
}

}  // namespace
}  // namespace kinfer
