// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/azimuth.hpp"

#include <gtest/gtest.h>

#include "identify/driven_machine.hpp"

#include <cmath>

#include "kinfer/identify/refinement/fits/joint_relaxation.hpp"

namespace kinfer {
using namespace identify;
namespace {

constexpr double axis_sd = 0.02, centre_sd = 0.05;  // [rad], [m] of every unknown

/// A body that rotates about its z, and a joint behind it with this axis, at `arm` from the first joint's point.
struct TwoJoints {
  InsBodies bodies{{.sensor = 0}, revolute_body(0, 1, Mat3::Identity(), Mat3::Identity())};
  InsLayout layout;
  MatrixXd covariance;

  TwoJoints(const Vec3& axis, const Vec3& arm, const Mat3& turn = Mat3::Identity()) {
    bodies[1].child_R_axis = turn;
    bodies[1].point_in_child = turn * Vec3(0.3, 0.1, -0.2);
    bodies.push_back(revolute_body(1, 2, turn * frame_with_z_along(axis), Mat3::Identity()));
    bodies[2].point_in_parent = bodies[1].point_in_child + turn * arm;
    estimate();
  }
  void estimate() {
    InsProblem problem;
    problem.sensors.resize(bodies.size());
    layout = layout_of(problem, bodies);
    covariance = MatrixXd::Zero(layout.global_parameters, layout.global_parameters);
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      const Eigen::Index turns = bodies[b].turns(), first = layout.body[b];
      covariance.diagonal().segment(first, turns).setConstant(axis_sd * axis_sd);
      covariance.diagonal().segment(first + turns, bodies[b].unknowns() - turns).setConstant(centre_sd * centre_sd);
    }
  }
  double sd(std::size_t body = 1) const { return azimuth_sd(layout, bodies, covariance, body); }
};

TEST(Azimuth, OfACrossedAxisIsThatOfTheAxis) {
  EXPECT_NEAR(TwoJoints(Vec3::UnitX(), Vec3::Zero()).sd(), axis_sd, 1e-12);
}

TEST(Azimuth, IsTheLessCertainTheMoreParallelTheAxesAre) {
  for (const double angle : {0.2, 0.7, 1.2})
    EXPECT_NEAR(TwoJoints(Vec3(std::sin(angle), 0.0, std::cos(angle)), Vec3(5.0, 0.0, 0.0)).sd(),
                axis_sd / std::sin(angle), 1e-12);
}

TEST(Azimuth, OfParallelAxesComesFromTheirDistance) {
  for (const double length : {0.5, 2.0})
    EXPECT_NEAR(TwoJoints(Vec3::UnitZ(), Vec3(0.0, length, 0.7)).sd(), centre_sd / length, 1e-12);
  EXPECT_EQ(TwoJoints(Vec3::UnitZ(), Vec3(0.0, 0.05, 0.7)).sd(), 0.0) << "one line has no azimuth";
}

TEST(Azimuth, DoesNotDependOnHowTheSensorIsMounted) {
  const Vec3 axis = Vec3(0.5, 0.3, 0.6).normalized(), arm(0.4, -0.2, 0.1);
  const double reference = TwoJoints(axis, arm).sd();
  EXPECT_GT(reference, axis_sd);
  for (const Vec3& turn : {Vec3(0.3, 1.2, -0.5), Vec3(-2.0, 0.4, 0.9)})
    EXPECT_NEAR(TwoJoints(axis, arm, exp_so3(turn)).sd(), reference, 1e-12);
}

TEST(Azimuth, IsTakenFromTheChildThatTellsMost) {
  TwoJoints joints(Vec3(std::sin(0.3), 0.0, std::cos(0.3)), Vec3::Zero());
  joints.bodies.push_back(revolute_body(1, 3, frame_with_z_along(Vec3::UnitY()), Mat3::Identity()));
  joints.estimate();
  EXPECT_NEAR(joints.sd(), axis_sd, 1e-12);
}

TEST(Azimuth, OfTheLastBodyAndOfAFixedChildIsZero) {
  TwoJoints joints(Vec3::UnitX(), Vec3::UnitX());
  EXPECT_EQ(joints.sd(2), 0.0);
  joints.bodies[2].free_parent_rotation = {};
  joints.estimate();
  EXPECT_EQ(joints.sd(), 0.0);
}

struct RelaxationCase {
  std::vector<double> gains;
  std::vector<std::size_t> relaxed;
  const char* why;
};

TEST(JointRelaxation, OnlyWhatStandsOutIsRelaxed) {
  const RelaxationCase cases[] = {
      {{}, {}, "no revolute joints"},
      {{1.9}, {}, "the two spline dimensions gain something by chance"},
      {{2.1}, {10}, "a single joint has no others to be compared with"},
      {{5.0, 0.2, 0.3}, {10}, "one imperfect joint"},
      {{5.0, 4.5, 4.8}, {}, "what all show comes from the mounts"},
      {{6.0, 0.1, 6.5, 0.2}, {10, 12}, "two imperfect joints among four"},
      {{1.5, 0.0, 0.0}, {}, "noticeable, but not significant"},
      {{3.0, 2.2}, {10}, "the better one by more than a third"},
  };
  for (const RelaxationCase& c : cases) {
    std::vector<std::size_t> hinges;
    for (std::size_t i = 0; i < c.gains.size(); ++i) hinges.push_back(10 + i);
    EXPECT_EQ(select_joints_to_relax(hinges, c.gains), c.relaxed) << c.why;
  }
}

/// A swing axis that is inclined by a few milliradians shows the azimuths of both limbs on its segment to some
/// hundredths of a radian. The pairs of sensors know nothing of them, so the fit begins anywhere on the circle.
TEST(Azimuth, OfEveryLimbIsFoundOnTheWholeCircleWithoutMagnetometers) {
  const Rng rng(3);
  const MujocoWorld world =
      std::move(*MujocoWorld::load(machine_mjcf("tree", {.mounting = Mounting::arbitrary}, rng.stream(1)).value()));
  const MachineMotion motion = world.prescribe(make_drive(world.machine(), {}, rng.stream(2)).value(), 100.0);
  const InsRecording recording = simulate_recording(world.machine(), motion, *sensor_grade("industrial"),
                                                    {.has_magnetometer = false}, rng.stream(3));
  const MachineTruth truth = machine_truth(world.machine(), motion);
  const Identification found = test::identified(recording);
  int told = 0;
  for (const JointEstimate& joint : found.joints) {
    if (joint.parent != "ins1") continue;
    const auto t = std::ranges::find_if(
        truth.joints, [&](const JointTruth& j) { return j.parent == joint.parent && j.child == joint.child; });
    ASSERT_NE(t, truth.joints.end());
    const double sense = joint.axis_in_child.dot(t->axis_in_child) < 0.0 ? -1.0 : 1.0;
    const double error = (sense * joint.axis_in_parent - t->axis_in_parent).norm();
    const double sd = std::hypot(joint.sd.axis_in_parent[0], joint.sd.axis_in_parent[1]);
    EXPECT_LT(error, 4.0 * sd) << joint.child;
    told += sd < 0.1;
  }
  EXPECT_EQ(told, 2) << "limbs whose azimuth is known";
}

}  // namespace
}  // namespace kinfer
