// SPDX-License-Identifier: Apache-2.0
// Limits of joint positions, and which joints are more than their geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

TEST(JointLimits, AreThoseOfTheActiveJointsInTheOrderOfQ) {
  Chain chain = laws::urdf_arm();
  for (std::size_t j = 0; j < chain.joints.size(); ++j)
    chain.joints[j].lower = -1.0 - static_cast<double>(j), chain.joints[j].upper = 10.0 + static_cast<double>(j);
  const JointLimits limits = joint_limits(chain);
  const std::vector<int> active = active_joints(chain);
  ASSERT_EQ(limits.lower.size(), static_cast<Eigen::Index>(active.size()));
  for (std::size_t k = 0; k < active.size(); ++k) {
    EXPECT_EQ(limits.lower[static_cast<Eigen::Index>(k)], -1.0 - active[k]);
    EXPECT_EQ(limits.upper[static_cast<Eigen::Index>(k)], 10.0 + active[k]);
  }
}

TEST(JointLimits, ClampingIsTheNearestPointInsideAndTwiceIsOnce) {
  Chain chain = laws::er20();
  Rng rng(2);
  for (Joint& joint : chain.joints) {
    joint.lower = rng.uniform(-1.0, 0.0);
    joint.upper = rng.uniform(0.0, 1.0);
  }
  chain.joints[3].lower = -std::numeric_limits<double>::infinity();
  const JointLimits limits = joint_limits(chain);
  for (std::uint64_t i = 0; i < 50; ++i) {
    const VectorXd q = laws::random_q(chain, Rng(i)), clamped = limits.clamped(q);
    EXPECT_EQ(limits.clamped(clamped), clamped);
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      EXPECT_GE(clamped[k], limits.lower[k]);
      EXPECT_LE(clamped[k], limits.upper[k]);
      const bool is_inside = q[k] >= limits.lower[k] && q[k] <= limits.upper[k];
      EXPECT_EQ(clamped[k] == q[k], is_inside);
    }
  }
}

TEST(JointLimits, OfAMachineWithoutAnyLeaveAllAsItIs) {
  for (const Chain& chain : {laws::dh_6r(), laws::coupled(), laws::two_arms()}) {
    const VectorXd q = 1e6 * laws::random_q(chain, Rng(1));
    EXPECT_EQ(joint_limits(chain).clamped(q), q) << chain.name;
  }
}

/// What makes a joint more than its geometry, and conditions under which it shows in the pose.
struct NonGeometricTerm {
  const char* name;
  std::function<void(Joint&)> add;
};

TEST(NonGeometricTerms, AreThoseThatMakeAPoseDependOnLoadApproachOrTurns) {
  const NonGeometricTerm terms[] = {{"compliance", [](Joint& j) { j.compliance = 1e-4; }},
                                    {"torque compliance", [](Joint& j) { j.torque_compliance = 1e-4; }},
                                    {"backlash", [](Joint& j) { j.backlash = 1e-3; }},
                                    {"harmonic", [](Joint& j) {
                                       j.harmonics = {{2.0, 1e-3, 0.0}};
                                     }}};
  const Chain rigid = laws::er20();
  EXPECT_FALSE(has_non_geometric_terms(rigid));
  const VectorXd q = laws::random_q(rigid, Rng(5));
  const std::vector<double> torques(6, 10.0), approach(6, 1.0);
  const Load load{.payload = 5.0, .torques = torques, .approach = approach};
  EXPECT_LT((forward(rigid, q, load).position - forward(rigid, q).position).norm(), 1e-15);
  for (const NonGeometricTerm& term : terms) {
    Chain chain = rigid;
    term.add(chain.joints[1]);
    EXPECT_TRUE(has_non_geometric_terms(chain.joints[1])) << term.name;
    EXPECT_TRUE(has_non_geometric_terms(chain)) << term.name;
    EXPECT_FALSE(has_non_geometric_terms(chain.joints[2])) << term.name;
    EXPECT_GT((forward(chain, q, load).position - forward(rigid, q, load).position).norm(), 1e-6) << term.name;
  }
  Chain warm = rigid;
  warm.expansion = 1e-5;
  EXPECT_TRUE(has_non_geometric_terms(warm));
  EXPECT_FALSE(has_non_geometric_terms(warm.joints[0])) << "it is the whole robot that grows";
  Chain geared = rigid;
  geared.joints[2].gain = 0.99, geared.joints[2].couplings = {{1, 0.5}};
  EXPECT_FALSE(has_non_geometric_terms(geared)) << "gains and couplings are linear in q";
}

TEST(NonGeometricTerms, BacklashOfTheOtherSignIsApproachFromTheOtherSide) {
  Chain chain = laws::er20(), mirrored = chain;
  for (std::size_t j = 0; j < 6; ++j) {
    chain.joints[j].backlash = 1e-3 * static_cast<double>(j + 1);
    mirrored.joints[j].backlash = -chain.joints[j].backlash;
  }
  const std::vector<double> up{1, -1, 0, 1, 1, -1}, down{-1, 1, 0, -1, -1, 1};
  const VectorXd q = laws::random_q(chain, Rng(6));
  const Pose a = forward(chain, q, {.approach = up}), b = forward(mirrored, q, {.approach = down});
  EXPECT_LT((a.position - b.position).norm() + (a.rotation - b.rotation).norm(), 1e-14);
  EXPECT_GT((a.position - forward(chain, q, {.approach = down}).position).norm(), 1e-4);
}

TEST(NonGeometricTerms, HarmonicsOfWholeOrderReturnAfterATurn) {
  Chain chain = laws::er20_with_errors();
  for (Joint& joint : chain.joints) joint.gain = 1.0, joint.harmonics = {{1.0, 2e-3, 1e-3}, {3.0, -1e-3, 4e-3}};
  const VectorXd q = laws::random_q(chain, Rng(7));
  const Pose before = forward(chain, q), after = forward(chain, q.array() + 2.0 * std::numbers::pi);
  EXPECT_LT((after.position - before.position).norm() + (after.rotation - before.rotation).norm(), 1e-12);
  chain.joints[0].harmonics = {{1.5, 2e-3, 1e-3}};
  EXPECT_GT((forward(chain, q.array() + 2.0 * std::numbers::pi).position - forward(chain, q).position).norm(), 1e-5);
}

TEST(PointColumns, AreTheSlopeOfAPointFixedInTheTool) {
  for (const Chain& chain : {laws::er20_with_errors(), laws::urdf_arm(), laws::coupled()}) {
    const VectorXd q = laws::random_q(chain, Rng(8));
    const Vec3 in_tool(0.3, -0.2, 0.5);
    const auto point = [&](const VectorXd& at) {
      const Pose pose = forward(chain, at);
      return Vec3(pose.rotation * in_tool + pose.position);
    };
    const auto columns = point_columns(jacobian(chain, q), forward(chain, q).rotation * in_tool);
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const VectorXd step = 1e-6 * VectorXd::Unit(q.size(), k);
      const Vec3 slope = (point(q + step) - point(q - step)) / 2e-6;
      EXPECT_LT((columns.col(k) - slope).norm(), 1e-8) << chain.name << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace kinfer
