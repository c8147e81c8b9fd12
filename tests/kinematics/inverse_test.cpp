#include "kinfer/kinematics/inverse.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <set>

#include "laws/example_chains.hpp"

namespace kinfer {

/// What GoogleTest says of an ending.
void PrintTo(Reach reach, std::ostream* out) {
  *out << sentence(reach);
}

namespace {

/// Two links of 1 m in the world's xy plane.
Chain planar() {
  Chain chain;
  chain.joints = {laws::revolute<DhLink>(1, 0, 0), laws::revolute<DhLink>(1, 0, 0)};
  chain.joints[1].parent = 0;
  return chain;
}

VectorXd readings(double a, double b) {
  return (VectorXd(2) << a, b).finished();
}

void expect_reached(const Chain& chain, const Pose& target, const InverseSolution& s, const Load& load = {}) {
  EXPECT_EQ(s.reach, Reach::reached) << chain.name;
  const Pose pose = forward(chain, s.q, load);
  EXPECT_LT((pose.position - target.position).norm(), 1.01e-9);
  EXPECT_LT(angle_between(pose.rotation, target.rotation), 1.01e-9);
}

TEST(Inverse, a_pose_near_the_start_is_reached_in_a_few_steps) {
  for (const Chain& chain : {laws::dh_6r(), laws::er20_with_errors(), laws::coupled(), laws::seven_r()}) {
    for (std::uint64_t k = 0; k < 50; ++k) {
      const VectorXd truth = laws::random_q(chain, Rng(8).stream(k));
      VectorXd start = truth;
      for (double& reading : start) reading += 0.01;
      const Pose target = forward(chain, truth);
      const InverseSolution s = inverse(chain, target, start);
      expect_reached(chain, target, s);
      EXPECT_LE(s.iterations, 25);
    }
  }
}

TEST(Inverse, a_far_pose_is_mostly_reached_and_what_is_said_is_true) {
  const Chain chain = laws::er20();
  int reached = 0;
  for (std::uint64_t k = 0; k < 100; ++k) {
    const Pose target = forward(chain, laws::random_q(chain, Rng(9).stream(k)));
    const InverseSolution s = inverse(chain, target, laws::random_q(chain, Rng(10).stream(k)));
    const Pose pose = forward(chain, s.q);
    EXPECT_NEAR((pose.position - target.position).norm(), s.position_error, 1e-12);
    if (s.reach != Reach::reached) continue;
    ++reached;
    expect_reached(chain, target, s);
  }
  EXPECT_GE(reached, 60);
}

TEST(Inverse, the_deflected_tool_arrives_under_its_load) {
  const Chain chain = laws::compliant();
  const Load load{.payload = 20.0};
  const VectorXd truth = (VectorXd(6) << 0.2, -0.8, 0.7, 0.4, 0.9, -0.3).finished();
  Chain rigid = chain;
  for (Joint& joint : rigid.joints) joint.compliance = 0.0;
  const Pose target = forward(rigid, truth);  // where the rigid machine would be
  const InverseSolution s = inverse(chain, target, truth, {}, load);
  expect_reached(chain, target, s, load);
  EXPECT_GT((s.q - truth).norm(), 1e-4);
}

TEST(Inverse, a_position_alone_is_reached_by_machines_of_few_joints) {
  for (const Chain& chain : {laws::scara(), laws::seven_r(), laws::two_arms()}) {
    VectorXd truth = VectorXd::Constant(dof(chain), 0.1);
    truth[1] = 0.9;
    const Vec3 target = forward(chain, truth).position;
    VectorXd start = truth;
    for (double& reading : start) reading += 0.05;
    const InverseSolution s = inverse_position(chain, target, start);
    EXPECT_EQ(s.reach, Reach::reached) << chain.name;
    EXPECT_LT((forward(chain, s.q).position - target).norm(), 1.01e-9);
    EXPECT_EQ(s.angle_error, 0.0);
  }
}

TEST(Inverse, a_point_beyond_the_reach_is_missed_by_the_distance_to_the_workspace) {
  const InverseSolution s = inverse_position(planar(), {0, 3, 0}, readings(0.4, 0.5));
  EXPECT_EQ(s.reach, Reach::not_reachable);
  EXPECT_NEAR(s.position_error, 1.0, 1e-6);
}

TEST(Inverse, a_point_off_the_plane_is_missed_by_its_height) {
  const InverseSolution s = inverse_position(planar(), {1.0, 0.8, 0.25}, readings(0.4, 0.5));
  EXPECT_EQ(s.reach, Reach::not_reachable);
  EXPECT_NEAR(s.position_error, 0.25, 1e-9);
}

TEST(Inverse, a_limit_is_kept_and_named) {
  Chain chain = planar();
  chain.joints[0].lower = -0.1, chain.joints[0].upper = 0.5;
  const InverseSolution s = inverse_position(chain, {-1.2, 1.2, 0}, readings(0.4, 0.5));
  EXPECT_EQ(s.reach, Reach::at_limit);
  EXPECT_EQ(s.q[0], 0.5);
}

TEST(Inverse, a_start_outside_the_limits_is_brought_inside) {
  Chain chain = planar();
  chain.joints[1].lower = 0.0, chain.joints[1].upper = 2.0;
  const InverseSolution s = inverse_position(chain, {1.0, 1.0, 0}, readings(0.0, -1.0));
  EXPECT_EQ(s.reach, Reach::reached);
  EXPECT_GE(s.q[1], 0.0);
}

TEST(Inverse, a_stretched_arm_finds_its_way_to_a_point_on_its_own_line) {
  const InverseSolution s = inverse_position(planar(), {1.2, 0, 0}, readings(0.0, 0.0));  // the slope vanishes here
  EXPECT_EQ(s.reach, Reach::reached);
}

TEST(Inverse, a_point_on_the_rim_of_the_workspace_is_reached) {
  const InverseSolution s = inverse_position(planar(), {0, 2, 0}, readings(0.4, 0.5));
  EXPECT_EQ(s.reach, Reach::reached);
}

TEST(Inverse, a_step_spent_by_an_aligned_wrist_is_said_to_be_near_singular) {
  Chain chain = laws::er20();
  const VectorXd start = (VectorXd(6) << 0.2, -0.8, 0.7, 0.4, 1e-6, -0.3).finished();
  Pose target = forward(chain, start);
  const Mat3 wrist = joint_frames(chain, start)[3].rotation;
  target.rotation = exp_so3(0.2 * wrist.col(0)) * target.rotation;  // across both of the wrist's axes, which coincide
  const InverseSolution s = inverse(chain, target, start, {.iterations = 1});
  EXPECT_EQ(s.reach, Reach::near_singular);
}

TEST(Inverse, steps_spent_elsewhere_are_said_to_be_spent) {
  const InverseSolution s = inverse_position(planar(), {-1.0, -1.0, 0}, readings(0.4, 0.9), {.iterations = 2});
  EXPECT_EQ(s.reach, Reach::out_of_steps);
}

TEST(Inverse, every_ending_has_a_sentence_of_its_own) {
  std::set<std::string_view> sentences;
  for (int i = 0; i <= static_cast<int>(Reach::out_of_steps); ++i) sentences.insert(sentence(static_cast<Reach>(i)));
  EXPECT_EQ(sentences.size(), 5u);
  EXPECT_FALSE(sentences.contains(""));
}

}  // namespace
}  // namespace kinfer
