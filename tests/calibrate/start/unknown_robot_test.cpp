// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/unknown_robot.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/start/local_poe.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/kinematics/dh_conversion.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/words/calibration/unknown_robot.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

/// Random frames, every third joint prismatic, gains other than 1.
Chain random_chain(int joints, Rng rng) {
  Chain chain = make_serial_chain(std::vector<JointType>(joints, JointType::revolute));
  for (int i = 0; i < joints; ++i) {
    auto& joint = chain.joints[i];
    const Vec3 axis = normal_vector(rng).normalized();
    const Vec3 xyz = normal_vector(rng), turn = normal_vector(rng);
    UrdfLink link;
    link.origin = Frame::from_pose({exp_so3(turn), xyz});
    link.axis = axis;
    joint.link = link;
    joint.type = i % 3 == 1 ? JointType::prismatic : JointType::revolute;
    joint.gain = 1.0 + 0.1 * i;
  }
  chain.tool.xyz = {0.1, 0.2, 0.3};
  return chain;
}

Chain unknown_scara() {
  Chain chain = test::er20();
  chain.joints.resize(4);
  const double a[] = {0, 0.4, 0.3, 0}, alpha[] = {0, 0, 180, 0}, d[] = {0.35, 0, 0, 0};
  for (int i = 0; i < 4; ++i) {
    MdhLink link;
    link.a = a[i], link.alpha = alpha[i] * degree, link.d = d[i];
    chain.joints[i].link = link;
    chain.joints[i].lower = -2.5, chain.joints[i].upper = 2.5;
  }
  chain.joints[2].type = JointType::prismatic;
  chain.joints[2].lower = 0.0, chain.joints[2].upper = 0.25;
  chain.tool.xyz = {0.06, 0.01, 0.03};
  return chain;
}

void expect_same_poses(const Chain& a, const Chain& b) {
  Rng rng(5);
  for (int i = 0; i < 20; ++i) {
    VectorXd q(dof(a));
    for (double& value : q) value = rng.uniform(-2, 2);
    const Pose p = forward(a, q), r = forward(b, q);
    EXPECT_LT((p.position - r.position).norm(), 1e-9);
    EXPECT_LT((p.rotation - r.rotation).norm(), 1e-9);
  }
}

class SameMachine : public ::testing::TestWithParam<int> {};

TEST_P(SameMachine, HasTheSamePosesAsMdhAndAsDh) {
  Chain chain = GetParam() == 0   ? test::with_table3_errors(test::er20())
                : GetParam() == 1 ? unknown_scara()
                                  : random_chain(GetParam(), Rng(GetParam()));
  if (GetParam() == 7) {
    Joint fixed = chain.joints[3];
    fixed.type = JointType::fixed, fixed.is_active = false, fixed.name = "flange";
    fixed.parent = 6;
    chain.joints.push_back(fixed);
  }
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({1, 2, 3}, {0.1, 0.2, 0.3}));
  ASSERT_TRUE(as_mdh(chain) && as_dh(chain));
  expect_same_poses(chain, *as_mdh(chain));
  expect_same_poses(chain, *as_dh(chain));
}
INSTANTIATE_TEST_SUITE_P(DhConversion, SameMachine, ::testing::Values(0, 1, 2, 3, 5, 6, 7));

TEST(DhConversion, RowsStayNearTheNominalOnesWithParallelAxes) {
  const Chain mdh = *as_mdh(test::with_table3_errors(test::er20()));
  const auto& second = std::get<MdhLink>(mdh.joints[2].link);  // J2 and J3 are 0.005° from parallel
  EXPECT_NEAR(second.a, 0.7823, 1e-3);
  EXPECT_NEAR(second.d, 0.0, 1e-3);
  EXPECT_LT(std::abs(second.beta), 0.02 * degree);
}

TEST(DhConversion, CoupledJointsAreNotStraight) {
  Chain chain = test::er20();
  chain.joints[2].couplings.push_back({1, 1.0});
  EXPECT_FALSE(as_mdh(chain).has_value());
}

TEST(UnknownRobot, JointTypesAreParsedAndInvalidTextIsRefused) {
  EXPECT_EQ(parse_joint_types("6R")->size(), 6u);
  EXPECT_EQ(*parse_joint_types("R2PR"), (std::vector<JointType>{JointType::revolute, JointType::prismatic,
                                                                JointType::prismatic, JointType::revolute}));
  for (const char* wrong : {"", "6", "0R", "RXR", "r", "21R", "R-1P"}) EXPECT_FALSE(parse_joint_types(wrong)) << wrong;
}

TEST(UnknownRobot, AxesAreDescribedInWords) {
  const std::vector<std::string> sentences = words::axis_sentences(axis_geometry(test::er20()));
  const auto said = [&](const std::string& text) {
    return std::any_of(sentences.begin(), sentences.end(),
                       [&](const auto& w) { return w.find(text) != std::string::npos; });
  };
  EXPECT_TRUE(said("J2 and J3 are parallel (0.000 deg), 782.27 mm apart"));
  EXPECT_TRUE(said("J1 and J2 pass each other 166.6"));
  EXPECT_TRUE(said("J4, J5 and J6 meet in one point: a wrist"));
}

struct Machine {
  std::string name, types;
  Chain truth;
  int poses;
  double limit;  // [m]
};
void PrintTo(const Machine& machine, std::ostream* out) {
  *out << machine.name;
}

class UnknownMachine : public ::testing::TestWithParam<Machine> {};

TEST_P(UnknownMachine, IsFoundFromPointsAloneAndValidatedOnHeldOutRows) {
  const Machine& machine = GetParam();
  Chain truth = machine.truth;
  truth.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.4}, {0.1, -0.2, 2.0}));
  const PoseSet data =
      simulate_pose_set(truth, {.poses = machine.poses, .space = {}, .instrument = test::tracker}, Rng(3)).value();
  const CalibrationTask task{.nominal = {},
                             .instrument = test::tracker,
                             .data = data,
                             .joint_types = parse_joint_types(machine.types).value()};
  const Calibration calibration = calibrate_robot(task, {}, Rng(1)).value();
  ASSERT_TRUE(calibration.unknown_robot.has_value());
  EXPECT_EQ(calibration.reason, CalibrationReason::generalises);
  EXPECT_LT(calibration.after.position.holdout.mean, machine.limit);  // noise alone: 40 µm
}
INSTANTIATE_TEST_SUITE_P(UnknownRobot, UnknownMachine,
                         ::testing::Values(Machine{"er20", "6R",
                                                   [] {
                                                     Chain c = test::with_table3_errors(test::er20());
                                                     c.tool.xyz = {0.03, -0.02, 0.1};
                                                     return c;
                                                   }(),
                                                   60, 1e-4},
                                           Machine{"scara", "RRPR", unknown_scara(), 60, 1e-4},
                                           Machine{"two_axes", "2R",
                                                   [] {
                                                     Chain c = test::er20();
                                                     c.joints.resize(2);
                                                     c.tool.xyz = {0.3, 0.1, 0.2};
                                                     return c;
                                                   }(),
                                                   30, 1e-4}),
                         [](const auto& test) { return test.param.name; });

TEST(UnknownRobot, PointsOfAnotherMachineAreRefused) {
  const PoseSet data =
      simulate_pose_set(test::er20(), {.poses = 60, .space = {}, .instrument = test::tracker}, Rng(3)).value();
  PoseSet shuffled = data;
  for (int row = 0; row < 60; ++row) shuffled.points[row].position = data.points[(7 * row) % 60].position;
  const auto found = estimate_unknown_robot(
      *parse_joint_types("2P"),
      [&] {
        PoseSet two = data;
        two.joints = data.joints.topRows(2);
        two.joint_names.resize(2);
        return two;
      }(),
      0, Rng(1));
  ASSERT_FALSE(found.has_value());
  EXPECT_NE(found.error().what.find("no robot with these joint types"), std::string::npos);
}

TEST(UnknownRobot, TooFewPointsAreRefused) {
  const PoseSet data =
      simulate_pose_set(test::er20(), {.poses = 8, .space = {}, .instrument = test::tracker}, Rng(3)).value();
  EXPECT_NE(estimate_unknown_robot(*parse_joint_types("6R"), data, 0, Rng(1)).error().what.find("too few"),
            std::string::npos);
}

TEST(UnknownRobot, SameChainForAnyNumberOfThreads) {
  Chain truth = test::er20();
  truth.joints.resize(3);
  truth.tool.xyz = {0.2, 0.1, 0.1};
  const PoseSet data =
      simulate_pose_set(truth, {.poses = 30, .space = {}, .instrument = test::tracker}, Rng(3)).value();
  const auto with = [&](int threads) {
    return forward(fit_local_poe(*parse_joint_types("3R"), data, threads, Rng(1)).value().chain, VectorXd::Ones(3))
        .position;
  };
  const Vec3 one = with(1);
  EXPECT_EQ(one, with(2));
  EXPECT_EQ(one, with(7));
}

}  // namespace
}  // namespace kinfer
