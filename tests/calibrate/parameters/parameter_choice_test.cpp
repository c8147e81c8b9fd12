// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/problem/options.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

std::set<std::string> names_in(const ParameterSet& set) {
  std::set<std::string> names;
  for (const Parameter& parameter : set.parameters) names.insert(parameter.name);
  return names;
}

PoseSet one_row() {
  PoseSet data;
  data.joints = MatrixXd::Zero(6, 1);
  return data;
}

PoseSet with_point(int target = -1) {
  PoseSet data = one_row();
  data.points.push_back({.row = 0, .target = target, .position = Vec3::Zero(), .sd = {}});
  return data;
}

Chain urdf_robot() {
  Chain chain;
  for (int j = 0; j < 3; ++j) {
    Joint joint{.name = "u" + std::to_string(j + 1), .parent = j - 1};
    joint.link = UrdfLink{.origin = {.xyz = Vec3(0.1, 0.0, 0.4)}, .axis = j == 1 ? Vec3::UnitY() : Vec3::UnitZ()};
    chain.joints.push_back(joint);
  }
  chain.joints[2].type = JointType::prismatic;
  return chain;
}

using Names = std::set<std::string>;

TEST(FrameParameters, AreThoseThatTheMeasurementsDependOn) {
  const Chain chain = test::er20();
  EXPECT_TRUE(frame_parameters(chain, one_row()).parameters.empty());
  const Names base{"base_x", "base_y", "base_z", "base_rx", "base_ry", "base_rz"};
  Names expected = base;
  expected.insert({"tool_x", "tool_y", "tool_z"});
  EXPECT_EQ(names_in(frame_parameters(chain, with_point())), expected) << "one point tells no orientation of the tool";
  PoseSet posed = with_point();
  posed.orientations.push_back({});
  expected.insert({"tool_rx", "tool_ry", "tool_rz"});
  EXPECT_EQ(names_in(frame_parameters(chain, posed)), expected);
  for (const Parameter& parameter : frame_parameters(chain, posed).parameters)
    EXPECT_TRUE(std::isinf(parameter.prior_sd)) << parameter.name << " is found from the data alone";
}

TEST(FrameParameters, TheVerticalIsFreeWhereTiltsMeetAnotherInstrument) {
  const Chain chain = test::er20();
  PoseSet tilted = one_row();
  tilted.tilts.push_back({});
  EXPECT_FALSE(names_in(frame_parameters(chain, tilted)).contains("gravity_x"));
  tilted.points = with_point().points;
  const Names names = names_in(frame_parameters(chain, tilted));
  EXPECT_TRUE(names.contains("gravity_x") && names.contains("gravity_y"));
  EXPECT_FALSE(names.contains("gravity_z")) << "its size is known";
}

TEST(GeometricParameters, HaveBetaOnlyWhereTwoAxesAreNearlyParallel) {
  const ParameterSet set = geometric_parameters(test::er20(), with_point(), {});
  Names betas;
  for (const std::string& parameter : names_in(set))
    if (parameter.starts_with("beta")) betas.insert(parameter);
  EXPECT_EQ(betas, (Names{"beta3"})) << "axes 2 and 3; the base takes the place of the first row";
  EXPECT_EQ(set.find("gain1"), nullptr) << "a revolute joint's gain is a model term";
  Chain slide = test::er20();
  slide.joints[2].type = JointType::prismatic;
  EXPECT_NE(geometric_parameters(slide, with_point(), {}).find("gain3"), nullptr);
}

TEST(GeometricParameters, EveryJointParameterHasItsTolerance) {
  const Tolerances tolerances{.length = 1e-3, .angle = 2e-3};
  const ParameterSet set = geometric_parameters(test::er20(), with_point(), tolerances);
  for (const Parameter& parameter : set.parameters) {
    if (!is_joint_parameter(parameter.at)) continue;
    EXPECT_DOUBLE_EQ(parameter.prior_sd, parameter.quantity == Quantity::length ? 1e-3 : 2e-3) << parameter.name;
  }
}

TEST(OffsetParameters, AreOneForEachDrivenJoint) {
  const Names names = names_in(joint_offset_parameters(test::er20(), with_point(), {}));
  for (const char* theta : {"theta1", "theta2", "theta3", "theta4", "theta5", "theta6"})
    EXPECT_TRUE(names.contains(theta)) << theta;
  EXPECT_FALSE(names.contains("a2"));
  EXPECT_TRUE(names.contains("base_x") && names.contains("tool_z"));
  Chain slide = test::er20();
  slide.joints[2].type = JointType::prismatic;
  slide.joints[4].is_active = false;
  const Names other = names_in(joint_offset_parameters(slide, with_point(), {}));
  EXPECT_TRUE(other.contains("d3"));
  EXPECT_FALSE(other.contains("theta3") || other.contains("theta5"));
}

TEST(OffsetParameters, OfAUrdfJointTurnsOrShiftsItsOriginAboutItsAxis) {
  PoseSet data = with_point();
  data.joints = MatrixXd::Zero(3, 1);
  Names joints;
  for (const Parameter& parameter : joint_offset_parameters(urdf_robot(), data, {}).parameters)
    if (is_joint_parameter(parameter.at)) joints.insert(parameter.name);
  EXPECT_EQ(joints, (Names{"rz1", "ry2", "z3"}));
}

TEST(PaperParameters, AreFourForEachJointAndNoneOfAUrdf) {
  const auto paper = paper_dh_parameters(test::er20(), {});
  ASSERT_TRUE(paper);
  EXPECT_EQ(paper->free_count(), 24);
  EXPECT_TRUE(names_in(*paper).contains("alpha6"));
  EXPECT_FALSE(names_in(*paper).contains("base_x"));
  EXPECT_FALSE(paper_dh_parameters(urdf_robot(), {}));
}

TEST(NamedParameters, AreThoseAloneAndAnUnknownOneListsTheKnownOnes) {
  const auto some = named_parameters(test::er20(), {}, {"a2", "theta4"});
  ASSERT_TRUE(some);
  EXPECT_EQ(some->free_count(), 2);
  const auto unknown = named_parameters(test::er20(), {}, {"a2", "a9"});
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().what.find("a9"), std::string::npos);
  EXPECT_NE(unknown.error().what.find("theta6"), std::string::npos);
}

TEST(RestrictedToData, LeavesOutWhatNoRowRefersTo) {
  Chain chain = test::er20();
  chain.targets = {{.name = "near"}, {.name = "far"}};
  chain.fixtures.anchors = {Vec3::Zero(), Vec3::UnitX()};
  PoseSet data = with_point(1);
  data.distances.push_back({.row = 0, .anchor = 0, .distance = 1.0});
  ParameterSet all = all_parameters(chain, {});
  const ParameterSet fixtures = setup_parameters(chain, {});
  all.parameters.insert(all.parameters.end(), fixtures.parameters.begin(), fixtures.parameters.end());
  std::set<std::string> left;
  for (const Parameter& parameter : restricted_to_data(all, data).parameters)
    if (is_object_parameter(parameter.at)) left.insert(name_of(chain, parameter.at));
  EXPECT_EQ(left, (std::set<std::string>{"anchor1_x", "anchor1_y", "anchor1_z", "target_far_x", "target_far_y",
                                         "target_far_z"}));
}

TEST(PriorMeans, AreThoseOfTheGivenChain) {
  Chain earlier = test::er20();
  std::get<MdhLink>(earlier.joints[2].link).a += 2e-3;
  const ParameterSet set = geometric_parameters(test::er20(), with_point(), {});
  const ParameterSet moved = with_prior_means_at(set, earlier);
  EXPECT_NEAR(moved.find("a3")->nominal - set.find("a3")->nominal, 2e-3, 1e-12);
  EXPECT_EQ(moved.find("a2")->nominal, set.find("a2")->nominal);
  EXPECT_EQ(moved.find("a3")->prior_sd, set.find("a3")->prior_sd);
}

TEST(ModelChoice, TermsNeedTheCompleteGeometricSet) {
  EXPECT_TRUE(allows_model_terms({}));
  EXPECT_FALSE(allows_model_terms({.parameters = PaperDhParameters{}}));
  EXPECT_FALSE(allows_model_terms({.parameters = JointOffsetParameters{}}));
  EXPECT_FALSE(allows_model_terms({.swarm_search = SwarmSearchOptions{}}));
  const auto refused = check_options({.nominal = test::er20()},
                                     {.model = FixedModel{{Term::gain}}, .swarm_search = SwarmSearchOptions{}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "model terms need the complete geometric set and a least-squares fit");
}

TEST(SwarmOptions, EverySearchHasAMethodItsParticlesAndABudget) {
  const std::pair<SearchOptions, SearchMethod> searches[] = {{PsoOptions{.particles = 31}, SearchMethod::pso},
                                                             {QpsoOptions{.particles = 32}, SearchMethod::qpso},
                                                             {BpnnPsoOptions{}, SearchMethod::bpnn_pso}};
  for (auto [search, expected] : searches) {
    EXPECT_EQ(method(search), expected);
    EXPECT_GT(particles(search), 0);
    budget(search).max_iterations = 7;
    const SearchOptions& fixed = search;
    EXPECT_EQ(budget(fixed).max_iterations, 7);
  }
  EXPECT_EQ(particles(searches[0].first), 31);
}

}  // namespace
}  // namespace kinfer
