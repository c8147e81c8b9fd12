// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/frame_motion.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

constexpr double step = 2e-3;  // [s], of the five-point differences
constexpr double slope_accuracy = 1e-7, curvature_accuracy = 1e-6;

/// A smooth motion of all joint positions and its derivatives.
struct SineMotion {
  Eigen::Index n;
  VectorXd wave(double t, double phase, int power) const {
    VectorXd q(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double frequency = 1.0 + 0.3 * double(k);
      q[k] = std::pow(frequency, power) * std::sin(frequency * t + 0.7 * double(k) + phase);
    }
    return q;
  }
  VectorXd q(double t) const { return wave(t, 0.0, 0); }
  VectorXd qd(double t) const { return wave(t, 90 * degree, 1); }
  VectorXd qdd(double t) const { return wave(t, 180 * degree, 2); }
};

template <class F>
Vec3 slope(F&& f) {
  return (8.0 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12.0 * step);
}

template <class F>
Vec3 curvature(F&& f) {
  return (16.0 * (f(step) + f(-step)) - (f(2 * step) + f(-2 * step)) - 30.0 * f(0.0)) / (12.0 * step * step);
}

void expect_is_the_derivative(const FrameMotion& now, const auto& at, const std::string& what) {
  EXPECT_LT((slope([&](double h) { return at(h).pose.position; }) - now.velocity).norm(), slope_accuracy) << what;
  EXPECT_LT((curvature([&](double h) { return at(h).pose.position; }) - now.acceleration).norm(), curvature_accuracy)
      << what;
  const auto turned = [&](double h) { return log_so3(at(h).pose.rotation * now.pose.rotation.transpose()); };
  EXPECT_LT((slope(turned) - now.omega).norm(), slope_accuracy) << what;
  EXPECT_LT((slope([&](double h) { return at(h).omega; }) - now.alpha).norm(), slope_accuracy) << what;
}

TEST(FrameMotion, OfEveryFrameAgreesWithDifferencesOfItsPose) {
  for (const Chain& chain : laws::examples()) {
    const SineMotion motion{dof(chain)};
    for (const double t : {0.0, 0.9, 4.1}) {
      const auto motions = [&](double h) {
        return joint_motions(chain, motion.q(t + h), motion.qd(t + h), motion.qdd(t + h));
      };
      const std::vector<FrameMotion> now = motions(0.0);
      ASSERT_EQ(now.size(), chain.joints.size());
      for (std::size_t j = 0; j < now.size(); ++j) {
        expect_is_the_derivative(
            now[j], [&](double h) { return motions(h)[j]; }, fmt::format("{} {}", chain.name, j));
      }
    }
  }
}

TEST(FrameMotion, OfAnAttachedFrameAgreesWithDifferencesOfItsPose) {
  const Chain chain = laws::er20_with_errors();
  const SineMotion motion{dof(chain)};
  const Pose sensor = Pose::from_xyz_rpy({0.1, -0.2, 0.3}, {0.4, 0.5, 0.6});
  const auto at = [&](double h) {
    return attached_frame_motion(joint_motions(chain, motion.q(2 + h), motion.qd(2 + h), motion.qdd(2 + h)).back(),
                                 sensor);
  };
  expect_is_the_derivative(at(0.0), at, "sensor");
}

TEST(FrameMotion, PosesAreThoseOfTheRigidChain) {
  Chain chain = laws::compliant();
  const VectorXd q = laws::random_q(chain, Rng(4)), still = VectorXd::Zero(q.size());
  const std::vector<FrameMotion> motions = joint_motions(chain, q, still, still);
  for (Joint& joint : chain.joints) joint.compliance = 0.0;
  const std::vector<Pose> frames = joint_frames(chain, q);
  for (std::size_t j = 0; j < frames.size(); ++j) {
    EXPECT_LT((motions[j].pose.position - frames[j].position).norm(), 1e-14);
    EXPECT_EQ(motions[j].acceleration.norm(), 0.0);
  }
}

TEST(FrameMotion, APointOnASteadyTurntableAcceleratesTowardsTheAxis) {
  Chain turntable;
  turntable.joints = {laws::revolute<MdhLink>(0, 0, 0)};
  const VectorXd rate = VectorXd::Constant(1, 3.0), zero = VectorXd::Zero(1);
  const FrameMotion rim =
      attached_frame_motion(joint_motions(turntable, zero, rate, zero)[0], {Mat3::Identity(), {0.5, 0, 0.2}});
  EXPECT_LT((rim.velocity - Vec3(0, 1.5, 0)).norm(), 1e-15);
  EXPECT_LT((rim.acceleration - Vec3(-4.5, 0, 0)).norm(), 1e-15);  // ω² r
}

}  // namespace
}  // namespace kinfer
