// SPDX-License-Identifier: Apache-2.0
// Laws of the whole parameter list of a chain with everything around it: mountings, targets, anchors, sockets, planes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinfer/kinematics/parameters.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Chain in_a_cell(Chain chain) {
  chain.mountings = {{.name = "left", .base = Frame{}, .tool = Frame{}, .tip = -1},
                     {.name = "right", .base = {}, .tool = Frame{}, .tip = -1}};
  chain.targets = {{"ball", Vec3(0.1, 0.2, 0.3)}};
  chain.fixtures.anchors = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  chain.fixtures.sockets = {{"seat", Vec3(7, 8, 9)}};
  chain.fixtures.planes = {{.name = "table", .offset = 0.5}};
  return chain;
}

ParameterSet whole_list(const Chain& chain) {
  ParameterSet set = all_parameters(chain, {});
  const ParameterSet around = setup_parameters(chain, {});
  set.parameters.insert(set.parameters.end(), around.parameters.begin(), around.parameters.end());
  return set;
}

TEST(SetupParameters, AreNamedByWhatTheyBelongTo) {
  std::vector<std::string> names;
  for (const Parameter& p : setup_parameters(in_a_cell(laws::er20()), {}).parameters) names.push_back(p.name);
  EXPECT_THAT(names,
              ::testing::ElementsAre(
                  "base_x@left", "base_y@left", "base_z@left", "base_rx@left", "base_ry@left", "base_rz@left",  //
                  "tool_x@left", "tool_y@left", "tool_z@left", "tool_rx@left", "tool_ry@left", "tool_rz@left",  //
                  "tool_x@right", "tool_y@right", "tool_z@right", "tool_rx@right", "tool_ry@right",
                  "tool_rz@right",                                    // this one has the chain's base
                  "target_ball_x", "target_ball_y", "target_ball_z",  //
                  "anchor1_x", "anchor1_y", "anchor1_z", "anchor2_x", "anchor2_y", "anchor2_z",  //
                  "socket_seat_x", "socket_seat_y", "socket_seat_z",                             //
                  "plane_table_rx", "plane_table_ry", "plane_table_offset"));
}

TEST(SetupParameters, SocketsAndPlanesHaveNoPrior) {
  Tolerances tolerances;
  tolerances.anchor = 0.7, tolerances.tool_length = 0.3, tolerances.base_angle = 0.2;
  const ParameterSet set = setup_parameters(in_a_cell(laws::er20()), tolerances);
  EXPECT_EQ(set.find("anchor2_y")->prior_sd, 0.7);
  EXPECT_EQ(set.find("anchor2_y")->nominal, 5.0);
  EXPECT_EQ(set.find("target_ball_z")->prior_sd, 0.3);
  EXPECT_EQ(set.find("base_rx@left")->prior_sd, 0.2);
  for (const char* name : {"socket_seat_x", "plane_table_rx", "plane_table_offset"}) {
    EXPECT_EQ(set.find(name)->prior_sd, infinite) << name;
    EXPECT_GT(set.find(name)->scale, 0.0) << name;
  }
  EXPECT_EQ(set.find("plane_table_offset")->nominal, 0.5);
  EXPECT_EQ(unit(set.find("plane_table_offset")->quantity), "m");
  EXPECT_EQ(unit(set.find("plane_table_ry")->quantity), "rad");
  EXPECT_EQ(set.find("anchor3_x"), nullptr);
}

TEST(ParameterList, EveryParameterIsANumberOfItsOwn) {
  for (const Chain& example : laws::examples()) {
    const Chain chain = in_a_cell(example);
    const ParameterSet set = whole_list(chain);
    for (const Parameter& changed : set.parameters) {
      Chain other = chain;
      set_value_at(other, changed.at, 42.0);
      for (const Parameter& p : set.parameters)
        EXPECT_EQ(value_at(other, p.at), p.name == changed.name ? 42.0 : p.nominal) << p.name << " by " << changed.name;
    }
  }
}

TEST(ParameterList, AParameterByItsAddressIsThatOfTheList) {
  const Chain chain = in_a_cell(laws::coupled());
  for (const Parameter& p : whole_list(chain).parameters) {
    const Parameter again = parameter_at(chain, p.at, 0.125);
    EXPECT_EQ(again.name, p.name);
    EXPECT_EQ(again.quantity, p.quantity) << p.name;
    EXPECT_EQ(again.nominal, p.nominal) << p.name;
    EXPECT_EQ(again.scale, 0.125) << p.name;
    EXPECT_EQ(again.prior_sd, 0.125) << p.name;
    EXPECT_TRUE(again.at == p.at);
    EXPECT_TRUE(again.free);
  }
}

TEST(ParameterList, JointsOnTheWayToTheTipOfAMountingAreListedToo) {
  Chain chain = laws::two_arms();
  EXPECT_EQ(all_parameters(chain, {}).find("a6"), nullptr);
  chain.mountings = {{.name = "other arm", .base = {}, .tool = Frame{}, .tip = 5}};
  const ParameterSet set = all_parameters(chain, {});
  EXPECT_NE(set.find("a6"), nullptr);
  EXPECT_NE(set.find("a4"), nullptr);
}

TEST(ParameterList, CouplingsAreNamedByBothJoints) {
  const ParameterSet set = all_parameters(laws::coupled(), {});
  ASSERT_NE(set.find("coupling6_5"), nullptr);
  EXPECT_EQ(set.find("coupling6_5")->nominal, -0.25);
  EXPECT_EQ(set.find("coupling7_1")->nominal, -0.7);
  EXPECT_EQ(unit(set.find("coupling7_1")->quantity), "1");
}

TEST(Priors, AreOneOverTheStandardDeviationOfEachFreeParameter) {
  ParameterSet set = with_only_free(all_parameters(laws::er20(), {}), {"a2", "d3", "theta4"});
  set.parameters[static_cast<std::size_t>(set.find("d3") - set.parameters.data())].prior_sd = infinite;
  const MatrixXd root = prior_sqrt_information_of(set);
  ASSERT_EQ(root.rows(), 3);
  const Tolerances tolerances;
  EXPECT_TRUE(root.isApprox(
      VectorXd(Vec3(1 / tolerances.length, 0.0, 1 / tolerances.angle)).asDiagonal().toDenseMatrix(), 1e-14));
  EXPECT_EQ(nominal_of(set), pack(set, laws::er20()));
}

TEST(Priors, AJointOneReplacesTheOthersUntilOtherParametersAreFreed) {
  ParameterSet set = with_only_free(all_parameters(laws::er20(), {}), {"a2", "d3"});
  set.prior_sqrt_information = (MatrixXd(2, 2) << 3, 1, 0, 2).finished();
  EXPECT_EQ(prior_sqrt_information_of(set), set.prior_sqrt_information);
  EXPECT_EQ(with_only_free(set, {"a2"}).prior_sqrt_information.size(), 0);
  set.parameters.front().free = true;
  EXPECT_DEATH(prior_sqrt_information_of(set), "a prior of 2 parameters for 3 free ones");
}

}  // namespace
}  // namespace kinfer
