// SPDX-License-Identifier: Apache-2.0
// What a user sees of the filter: joint positions and the tool, with standard deviations.
#include "kinfer/track/readout/readout.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/linalg/products.hpp"
#include "support/differences.hpp"
#include "support/random_tracked_tree.hpp"

namespace kinfer::track {
namespace {

using kinfer::testing::numeric_jacobian;

struct CarriedTool {
  TrackingModel tracking;
  FilterModel model;
  ChainState state;
  MatrixXd covariance;

  explicit CarriedTool(std::uint64_t seed, int body) {
    Rng rng(seed);
    tracking = test::random_tree(rng);
    tracking.tool = {body, {test::random_turn(rng), test::random_vector(rng)}, Vec3::Zero()};
    model = filter_model(tracking);
    state = test::random_state(model, rng);
    const Index n = model.layout.size;
    const MatrixXd root = 1e-2 * test::random_matrix(n, n, seed);
    covariance = times_transposed(root, root);
  }

  /// base_T_tool by the formulas of a tracking model, body by body, after a change of all states.
  Pose tool(const VectorXd& error) const {
    ChainState moved = state;
    retract(model, error, moved);
    std::vector<Pose> base_T_body{Pose{}};
    for (std::size_t b = 1; b < model.bodies.size(); ++b) {
      const Index first = model.layout.first_geometry + model.layout.geometry[b];
      const InsBody body = kinfer::retract(model.bodies[b], error.segment(first, model.bodies[b].unknowns()));
      const double q =
          degrees_of_freedom(body.motion) == 1 ? moved.joints[position_states * model.layout.position[b]] : 0.0;
      const bool is_slide = body.motion == JointMotion::prismatic;
      Mat3 turn = Mat3::Identity();
      if (body.motion == JointMotion::revolute) turn = rot_z(q);
      if (body.motion == JointMotion::spherical) turn = moved.spherical[b];
      FilterModel changed = model;
      changed.bodies[b] = body;
      const auto [parent_R_axis, point_in_parent, turned] = parent_side(changed, moved, b);
      const Mat3 rotation = parent_R_axis * turn * body.child_R_axis.transpose();
      Vec3 position = point_in_parent - rotation * body.point_in_child;
      if (is_slide) position += q * parent_R_axis.col(2);
      base_T_body.push_back(base_T_body[static_cast<std::size_t>(body.parent)] * Pose{rotation, position});
    }
    return base_T_body[static_cast<std::size_t>(tracking.tool.body)] * tracking.tool.body_T_tool;
  }
};

/// On the fixed segment beyond the slide, on the ball, and on the universal joint.
class ToolSpreadOf : public ::testing::TestWithParam<int> {};

TEST_P(ToolSpreadOf, IsTheProductOfTheBodiesAndItsSpreadThatOfDifferences) {
  const CarriedTool t(21, GetParam());
  ToolSpread spread(t.model, t.tracking.tool);
  spread.spread(t.model, t.state, t.covariance);
  const VectorXd none = VectorXd::Zero(t.model.layout.size);
  const Pose expected = t.tool(none);
  EXPECT_LT((spread.tool().position - expected.position).norm(), 1e-12);
  EXPECT_LT((spread.tool().rotation - expected.rotation).norm(), 1e-12);
  const MatrixXd by_state = numeric_jacobian(
      [&](const VectorXd& error) {
        const Pose moved = t.tool(error);
        VectorXd twist(6);
        twist << moved.position - expected.position, log_so3(Mat3(moved.rotation * expected.rotation.transpose()));
        return twist;
      },
      none);
  const VectorXd sd = (by_state * t.covariance * by_state.transpose()).diagonal().cwiseSqrt();
  EXPECT_LT((spread.position_sd() - sd.head<3>()).norm(), 1e-6 * sd.head<3>().norm());
  EXPECT_LT((spread.rotation_sd() - sd.tail<3>()).norm(), 1e-6 * sd.tail<3>().norm());
}

INSTANTIATE_TEST_SUITE_P(Bodies, ToolSpreadOf, ::testing::Values(1, 3, 4, 5, 6));

TEST(ToolSpread, TheToolsOwnUncertaintyTurnsWithItsBody) {
  CarriedTool t(22, 3);
  t.tracking.tool.sd = {0.003, 0.0, 0.0};
  ToolSpread spread(t.model, t.tracking.tool);
  spread.spread(t.model, t.state, 0.0 * t.covariance);
  EXPECT_NEAR(spread.position_sd().norm(), 0.003, 1e-15) << "a length does not depend on axes";
  EXPECT_EQ(spread.rotation_sd().norm(), 0.0);
}

TEST(ToolSpread, AnUnknownHeadingOfABallTurnsTheToolAboutTheVertical) {
  const CarriedTool t(22, 5);
  ToolSpread spread(t.model, t.tracking.tool);
  std::vector<double> unknown(t.model.bodies.size(), 0.0);
  unknown[5] = 1.5;
  spread.spread(t.model, t.state, 0.0 * t.covariance, unknown);
  const Vec3 expected = 1.5 * (t.state.world_R_base.transpose() * Vec3::UnitZ()).cwiseAbs();
  EXPECT_LT((spread.rotation_sd() - expected).norm(), 1e-12);
}

TEST(ReadOut, PositionsOfOneAxisAreThoseOfTheFilterWithItsStandardDeviations) {
  const CarriedTool t(23, 6);
  TrackState out = unknown_state(t.tracking);
  EXPECT_TRUE(out.q.array().isNaN().all());
  read_out(t.tracking, t.model, t.state, t.covariance, out);
  EXPECT_FALSE(out.q.hasNaN() || out.qd.hasNaN() || out.sd_q.hasNaN() || out.sd_qd.hasNaN());
  const Index expected[] = {0, 1, 2, 3};  // hinge, both axes of the universal joint, slide
  for (const Index i : expected) {
    const Index at = t.model.layout.joint_state(i);
    EXPECT_EQ(out.q[i], t.state.joints[position_states * i] - t.state.start[i]);
    EXPECT_EQ(out.qd[i], t.state.joints[position_states * i + 1]);
    const UnknownZero* zero = t.model.unknown_zero(i);  // of the hinge, which counts from its start
    VectorXd since_start = VectorXd::Unit(t.covariance.rows(), at);
    if (zero) since_start[zero->state] = -1.0;
    EXPECT_NEAR(out.sd_q[i], std::sqrt(since_start.dot(t.covariance * since_start)), 1e-15);
    EXPECT_NEAR(out.sd_qd[i], std::sqrt(t.covariance(at + 1, at + 1)), 1e-15);
  }
  EXPECT_LT((out.world_q_base.toRotationMatrix() - t.state.world_R_base).norm(), 1e-12);
}

/// exp(φ) = Rx(q₁) Ry(q₂) Rz(q₃), and its rates are those of the ball.
TEST(ReadOut, AnglesOfABallAreItsRotationAndTheirRatesItsAngularVelocity) {
  const CarriedTool t(24, 5);
  TrackState out = unknown_state(t.tracking);
  read_out(t.tracking, t.model, t.state, t.covariance, out);
  const auto ball_of = [](const Vec3& q) { return Mat3(rot_x(q.x()) * rot_y(q.y()) * rot_z(q.z())); };
  const Vec3 q = out.q.segment<3>(4), qd = out.qd.segment<3>(4);
  EXPECT_LT((ball_of(q) - t.state.spherical[5]).norm(), 1e-12);
  constexpr double h = 1e-6;
  const Vec3 turning = log_so3(Mat3(ball_of(q - h * qd).transpose() * ball_of(q + h * qd))) / (2 * h);
  const Index first = t.model.layout.position[5];
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(turning[i], t.state.joints[position_states * (first + i) + 1], 1e-6);
}

TEST(ReadOut, AnglesOfABallGoOnBeyondHalfATurn) {
  CarriedTool t(25, 5);
  TrackState out = unknown_state(t.tracking);
  t.state.spherical[5] = Mat3::Identity();
  for (double angle = 0.0; angle < 9.0; angle += 0.3) {
    t.state.spherical[5] = rot_z(angle);
    read_out(t.tracking, t.model, t.state, t.covariance, out);
    EXPECT_NEAR(out.q[6], angle, 1e-9);
  }
}

}  // namespace
}  // namespace kinfer::track
