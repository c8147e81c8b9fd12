// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/parameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

std::vector<std::string> names(const ParameterSet& set) {
  std::vector<std::string> list;
  for (const Parameter* p : set.free()) list.push_back(p->name);
  return list;
}

TEST(Parameters, RowsAreCountedFromOneAndFramesNamedByTheirOwner) {
  Chain chain = laws::scara();
  chain.joints.resize(3);
  EXPECT_THAT(names(all_parameters(chain, {})),
              ElementsAre("base_x", "base_y", "base_z", "base_rx", "base_ry", "base_rz",    //
                          "a1", "alpha1", "d1", "theta1", "beta1", "gain1", "compliance1",  //
                          "a2", "alpha2", "d2", "theta2", "beta2", "gain2", "compliance2",  //
                          "a3", "alpha3", "d3", "theta3", "beta3", "gain3",  // a prismatic joint has no compliance
                          "tool_x", "tool_y", "tool_z", "tool_rx", "tool_ry", "tool_rz"));
}

TEST(Parameters, UrdfJointsHaveTheNumbersOfTheirOrigin) {
  const auto list = names(all_parameters(laws::urdf_arm(), {}));
  for (const char* name : {"x4", "y4", "z4", "rx4", "ry4", "rz4", "gain4", "x1", "compliance2"}) {
    EXPECT_THAT(list, Contains(name));
  }
  EXPECT_THAT(list, Not(Contains("gain1")));        // fixed
  EXPECT_THAT(list, Not(Contains("compliance4")));  // prismatic
}

TEST(Parameters, OnlyJointsBetweenBaseAndTipAreListed) {
  const auto list = names(all_parameters(laws::two_arms(), {}));
  EXPECT_THAT(list, AllOf(Contains("a4"), Not(Contains("a5")), Not(Contains("a6"))));
}

TEST(Parameters, AMimicJointHasNoGain) {
  EXPECT_THAT(names(all_parameters(laws::coupled(), {})), AllOf(Contains("compliance7"), Not(Contains("gain7"))));
}

TEST(Parameters, ScaleAndPriorAreTheToleranceOfTheOwnerAndQuantity) {
  Tolerances t;
  t.length = 1, t.angle = 2, t.base_length = 3, t.base_angle = 4, t.tool_length = 5, t.tool_angle = 6, t.gain = 7;
  t.compliance = 8;
  const ParameterSet set = all_parameters(laws::er20(), t);
  const auto has = [&](const char* name, double tolerance, std::string_view si) {
    const Parameter* p = set.find(name);
    ASSERT_TRUE(p) << name;
    EXPECT_EQ(p->scale, tolerance) << name;
    EXPECT_EQ(p->prior_sd, tolerance) << name;
    EXPECT_EQ(unit(p->quantity), si) << name;
  };
  has("d2", 1, "m"), has("beta3", 2, "rad"), has("base_y", 3, "m"), has("base_rz", 4, "rad");
  has("tool_z", 5, "m"), has("tool_rx", 6, "rad"), has("gain6", 7, "1"), has("compliance1", 8, "rad/(N m)");
}

TEST(Parameters, FreeingSomeFixesAllOthers) {
  const ParameterSet set = with_only_free(all_parameters(laws::er20(), {}), {"tool_x", "a6", "theta2"});
  EXPECT_THAT(names(set), ElementsAre("theta2", "a6", "tool_x"));  // in the order of the list, not of the request
  EXPECT_EQ(set.free_count(), 3);
  EXPECT_DEATH(with_only_free(set, {"a7"}), "no parameter is called a7");
}

TEST(Parameters, FixedParametersKeepTheNominalValue) {
  const Chain chain = laws::er20();
  const ParameterSet set = with_only_free(all_parameters(chain, {}), {"a2", "base_rx", "gain5"});
  const Chain changed = unpack(set, chain, (VectorXd(3) << 0.01, 0.2, 1.1).finished());
  EXPECT_EQ(changed.base.small_rotation.x(), 0.01);  // the order of the list: the base comes first
  EXPECT_EQ(std::get<MdhLink>(changed.joints[1].link).a, 0.2);
  EXPECT_EQ(changed.joints[4].gain, 1.1);
  EXPECT_EQ(std::get<MdhLink>(changed.joints[2].link).a, 0.782270);
  EXPECT_DEATH(unpack(set, chain, VectorXd::Zero(4)), "4 values for 3 free parameters");
}

TEST(Parameters, AnAddressOfAMissingNumberStopsTheProgram) {
  EXPECT_DEATH(value_at(laws::er20(), JointNumber{6, Field::a}), "joint 6 of 6");
  EXPECT_DEATH(value_at(laws::er20(), JointNumber{1, Field::rx}), "a DH row has no rx");
  EXPECT_DEATH(value_at(laws::urdf_arm(), FrameNumber{SetupFrame::base, Field::alpha}), "a frame has no alpha");
}

TEST(Parameters, AParameterOfAnotherBranchMovesNothing) {
  const Chain chain = laws::two_arms();
  ParameterSet set;
  set.parameters.push_back({.name = "a6", .at = JointNumber{5, Field::a}});
  set.parameters.push_back({.name = "a2", .at = JointNumber{1, Field::a}});
  Twists twists;
  PoseEvaluator(chain, set).pose_and_derivative(laws::random_q(chain, Rng(1)), {}, twists);
  EXPECT_EQ(twists.col(0).norm(), 0.0);
  EXPECT_NEAR(twists.col(1).norm(), 1.0, 1e-15);
}

TEST(Parameters, TheGainOfAPassiveJointStopsTheProgram) {
  const Chain chain = laws::coupled();
  ParameterSet set;
  set.parameters.push_back({.name = "gain7", .at = JointNumber{6, Field::gain}});
  EXPECT_DEATH(PoseEvaluator(chain, set), "gain of joint 6, which has no joint position");
}

}  // namespace
}  // namespace kinfer
