#include "kinfer/identify/loose_hinge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/estimate/ins_motion.hpp"
#include "kinfer/identify/ordered_motion.hpp"
#include "kinfer/identify/refine.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

/// amplitude sin(2π frequency t + phase) with its first two derivatives.
std::array<double, 3> wave(double amplitude, double frequency, double phase, double t) {
  const double w = 2.0 * std::numbers::pi * frequency, at = w * t + phase;
  return {amplitude * std::sin(at), amplitude * w * std::cos(at), -amplitude * w * w * std::sin(at)};
}

JointReading readings(const std::array<std::array<double, 3>, 3>& waves) {
  JointReading q;
  for (std::size_t order = 0; order < 3; ++order) q[order] = Vec3(waves[0][order], waves[1][order], waves[2][order]);
  return q;
}

/// A root moved by hand, a hinge, and a hinge whose axis strays by 0.05 rad (rms); all shaken at 6 Hz.
struct HandMovedChain {
  InsBodies bodies{{.sensor = 0},
                   turning_body(0, 1, exp_so3(Vec3(0.2, 0.1, -0.3)), exp_so3(Vec3(-0.1, 0.3, 0.2))),
                   ball_body(1, 2, exp_so3(Vec3(0.1, -0.2, 0.3)))};
  InsRecording recording;

  HandMovedChain() {
    bodies[1].point_in_parent = Vec3(0.25, 0.02, -0.03);
    bodies[1].point_in_child = Vec3(-0.15, 0.04, 0.02);
    bodies[2].point_in_parent = Vec3(0.2, 0.0, -0.02);
    bodies[2].point_in_child = Vec3(-0.18, 0.02, 0.03);
    recording.loggers = {{.name = "log", .time = {}}};
    for (const char* name : {"a", "b", "c"})
      recording.sensors.push_back({.name = name, .acceleration = {}, .rate = {}, .field = {}, .faults = {}});
    Rng rng(4);
    for (int row = 0; row < 1500; ++row) {
      const double t = 0.02 * row;
      recording.loggers[0].time.push_back(t);
      const auto states = states_at(t);
      for (std::size_t s = 0; s < 3; ++s) put(recording.sensors[s], states[s], rng);
    }
  }

  std::vector<InsState> states_at(double t) const {
    // The root turns by exp(φ) and shifts: ω of a rotation vector is that of a ball on a body at rest.
    InsState ground;
    ground.force = Vec3(0.0, 0.0, 9.81);
    InsBody hand = ball_body(0, 0, Mat3::Identity());
    JointReading turn = readings({wave(0.5, 0.45, 0.0, t), wave(0.6, 0.37, 1.0, t), wave(0.7, 0.29, 2.0, t)});
    const JointReading shake = readings({wave(0.03, 6.0, 0.0, t), wave(0.0, 1.0, 0.0, t), wave(0.02, 5.3, 0.0, t)});
    for (std::size_t order = 0; order < 3; ++order) turn[order] += shake[order];
    const JointReading shift = readings({wave(0.3, 0.6, 0.4, t), wave(0.2, 0.5, 0.0, t), wave(0.2, 0.7, 0.9, t)});
    ground.force += shift[2];
    std::vector<InsState> states{carried(hand, turn, ground)};
    states.push_back(carried(bodies[1], readings({wave(0.8, 0.41, 0.3, t), {}, {}}), states[0]));
    states.push_back(carried(
        bodies[2], readings({wave(0.9, 0.52, 1.3, t), wave(0.05, 0.23, 1.0, t), wave(0.05, 0.31, 0.0, t)}), states[1]));
    return states;
  }

  static void put(InsSensor& sensor, const InsState& state, Rng& rng) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Index>(k);
      sensor.rate.axis[k].push_back(static_cast<float>(state.rate[i] + 1e-3 * rng.normal()));
      sensor.acceleration.axis[k].push_back(static_cast<float>(state.force[i] + 1e-2 * rng.normal()));
    }
    sensor.faults.push_back(0);
  }
};

Refinement refined(const InsRecording& recording, int threads) {
  const auto ordered = ordered_motion(recording, {}, "a", threads);
  EXPECT_TRUE(ordered);
  std::vector<JointStart> starts;
  for (std::size_t i = 1; i < ordered->tree.order.size(); ++i)
    starts.push_back(joint_start(ordered->motion, ordered->tree, *ordered->tree.parent[ordered->tree.order[i]],
                                 ordered->tree.order[i], FoundJointType::revolute));
  auto result = refine(recording, ordered->motion, ordered->tree, starts, {.fit = {.threads = threads}});
  EXPECT_TRUE(result);
  return *result;
}

double across(const Vec3& error, const Vec3& axis) {
  return (error - axis * axis.dot(error)).norm();
}

TEST(LooseHinge, AStrayingHingeOnAShakenChainIsFoundAsOneAndItsLeversStayRight) {
  const HandMovedChain chain;
  const Refinement found = refined(chain.recording, 0);
  ASSERT_EQ(found.joints.size(), 2u);
  EXPECT_GT(found.cutoff, 0.0);
  const RefinedJoint &sound = found.joints[0], &loose = found.joints[1];
  EXPECT_NEAR(loose.stray, 0.05, 0.01);
  EXPECT_LT(sound.stray, 0.01);
  EXPECT_EQ(loose.found.type, FoundJointType::revolute);
  const Vec3 axis = Vec3::UnitX();  // of the straying hinge, in the parent
  EXPECT_LT(loose.found.axis_in_parent.cross(axis).norm(), 0.02);
  EXPECT_LT(across(loose.found.point_in_parent - chain.bodies[2].point_in_parent, axis), 2e-3);
  const Vec3 in_child = chain.bodies[2].child_R_axis * axis;
  EXPECT_LT(across(loose.found.point_in_child - chain.bodies[2].point_in_child, in_child), 2e-3);
  const Vec3 other = chain.bodies[1].parent_R_axis.col(2);
  const double lever = across(sound.found.point_in_parent - chain.bodies[1].point_in_parent, other);
  EXPECT_LT(lever, 4e-3);
  EXPECT_LT(lever, 2.5 * std::hypot(sound.found.sd.point_in_parent[0], sound.found.sd.point_in_parent[1]));
  EXPECT_LT(sound.found.axis_in_parent.cross(other).norm(), 0.01);
}

TEST(LooseHinge, ABallInItsPlaceMovesTheSame) {
  Rng rng(2);
  InsProblem problem;
  problem.grid = {0.0, 0.1, 10};
  problem.sensors.resize(3);
  InsUnknowns x;
  x.bodies = {{.sensor = 0},
              turning_body(0, 1, exp_so3(Vec3(0.3, -0.2, 0.1)), exp_so3(Vec3(0.1, 0.5, -0.4))),
              turning_body(1, 2, exp_so3(Vec3(-0.3, 0.2, 0.7)), exp_so3(Vec3(0.4, 0.1, 0.2)))};
  for (std::size_t b = 1; b < 3; ++b) {
    x.bodies[b].point_in_parent = Vec3(0.3, 0.1, 0.2);
    x.bodies[b].point_in_child = Vec3(-0.2, 0.2, 0.1);
  }
  x.root_force = Vec3(1.0, 2.0, 9.0);
  x.errors.resize(3);
  x.band.resize(2, problem.grid.coefficients());
  for (Index i = 0; i < x.band.size(); ++i) x.band.data()[i] = rng.normal();
  const InsLayout layout = layout_of(problem, x.bodies);
  InsUnknowns ball = x;
  loosen(ball, layout, 1);
  const InsLayout loose = layout_of(problem, ball.bodies);
  for (const double u : {0.1, 0.7}) {
    const auto is = body_states(problem, loose, ball, 3, spline_basis(u, 0.1)),
               ought = body_states(problem, layout, x, 3, spline_basis(u, 0.1));
    for (std::size_t b = 1; b < 3; ++b) {
      EXPECT_LT((is[b].rate - ought[b].rate).norm(), 1e-9);
      EXPECT_LT((is[b].force - ought[b].force).norm(), 1e-7);
    }
  }
}

TEST(LooseHinge, TheAxisIsTheDirectionThatStaysPutAndTheStrayItsScatter) {
  const Vec3 a = Vec3(1.0, 0.2, -0.1).normalized(), b = Vec3(0.3, 1.0, 0.2).normalized();
  const Mat3 in_parent = frame_along(a), in_child = frame_along(b);
  std::vector<Mat3> rotations;
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.02 * i;
    const Vec3 stray(wave(0.04, 0.9, 0.0, t)[0], wave(0.04, 1.1, 1.0, t)[0], 0.0);
    rotations.push_back(in_parent * exp_so3(stray) * rot_z(wave(1.0, 0.2, 0.5, t)[0]) * in_child.transpose());
  }
  const LooseHinge hinge = loose_hinge(ball_body(0, 1, Mat3::Identity()), rotations, MatrixXd::Identity(6, 6), 1e-3);
  EXPECT_LT(hinge.body.parent_R_axis.col(2).cross(a).norm(), 0.004);
  EXPECT_LT(hinge.body.child_R_axis.col(2).cross(b).norm(), 0.004);
  EXPECT_NEAR(hinge.stray, 0.04, 0.003);
  EXPECT_GT(std::sqrt(hinge.covariance(0, 0)), 1e-3);
  EXPECT_LT(std::sqrt(hinge.covariance(0, 0)), 0.015);
}

TEST(LooseHinge, TheSlowFitIsTheSameForAnyNumberOfThreads) {
  HandMovedChain chain;
  chain.recording.loggers[0].time.resize(400);
  for (InsSensor& sensor : chain.recording.sensors) {
    for (std::size_t k = 0; k < 3; ++k) sensor.rate.axis[k].resize(400), sensor.acceleration.axis[k].resize(400);
    sensor.faults.resize(400);
  }
  const Refinement one = refined(chain.recording, 1);
  EXPECT_GT(one.cutoff, 0.0);
  for (const int threads : {2, 7}) {
    const Refinement many = refined(chain.recording, threads);
    for (std::size_t i = 0; i < one.joints.size(); ++i) {
      EXPECT_EQ(one.joints[i].found.point_in_parent, many.joints[i].found.point_in_parent);
      EXPECT_EQ(one.joints[i].found.sd.point_in_child, many.joints[i].found.sd.point_in_child);
    }
  }
}

}  // namespace
}  // namespace kinfer
