// SPDX-License-Identifier: Apache-2.0
// Motion of a tracked chain between two updates: the mean against its equations, the covariance against the mean.
#include "kinfer/track/model/chain_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/track/model/thresholds.hpp"
#include "support/differences.hpp"
#include "support/random_tracked_tree.hpp"

namespace kinfer::track {
namespace {

using kinfer::testing::numeric_jacobian;

struct MovingTree {
  FilterModel model;
  ChainState state;

  MovingTree(std::uint64_t seed, BaseMode base) {
    Rng rng(seed);
    model = filter_model(test::random_tree(rng));
    state = test::random_state(model, rng);
    state.base = base;
    if (base == BaseMode::still)
      state.rate = state.angular_acceleration = state.velocity = state.acceleration = Vec3::Zero();
  }
  ChainState after(double dt) const {
    ChainState moved = state;
    predict_mean(model, dt, moved);
    return moved;
  }
};

/// The error that leads from one state to another.
VectorXd error_between(const FilterModel& model, const ChainState& from, const ChainState& to) {
  const FilterLayout& layout = model.layout;
  VectorXd e = VectorXd::Zero(layout.size);
  e.segment<3>(BaseIndex::attitude) = log_so3(Mat3(from.world_R_base.transpose() * to.world_R_base));
  e.segment<3>(BaseIndex::rate) = to.rate - from.rate;
  e.segment<3>(BaseIndex::angular_acceleration) = to.angular_acceleration - from.angular_acceleration;
  e.segment<3>(BaseIndex::velocity) = to.velocity - from.velocity;
  e.segment<3>(BaseIndex::acceleration) = to.acceleration - from.acceleration;
  e.segment(base_states, from.joints.size()) = to.joints - from.joints;
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion == JointMotion::spherical) {
      const Vec3 turn = log_so3(Mat3(from.spherical[b].transpose() * to.spherical[b]));
      for (Index i = 0; i < 3; ++i) e[layout.joint_state(layout.position[b] + i)] = turn[i];
    }
  for (std::size_t s = 0; s < from.sensors.size(); ++s) {
    const Index own = layout.sensor_state(static_cast<Index>(s));
    e.segment<3>(own) = to.sensors[s].gyroscope_bias - from.sensors[s].gyroscope_bias;
    e.segment<3>(own + 3) = to.sensors[s].accelerometer_bias - from.sensors[s].accelerometer_bias;
    for (Index k = 0; k < 9; ++k) {
      e[own + 6 + k] = to.sensors[s].gyroscope_scale(k / 3, k % 3) - from.sensors[s].gyroscope_scale(k / 3, k % 3);
      e[own + 15 + k] =
          to.sensors[s].accelerometer_scale(k / 3, k % 3) - from.sensors[s].accelerometer_scale(k / 3, k % 3);
    }
  }
  for (const UnknownZero& zero : model.unknown_zeros)
    e[zero.state] = to.start[zero.position] - from.start[zero.position];
  for (const UnknownTurn& turn : model.unknown_turns)
    e[turn.state] = to.turned[static_cast<Index>(turn.body)] - from.turned[static_cast<Index>(turn.body)];
  for (const UnknownAxis& axis : model.unknown_axes)
    e.segment<2>(axis.state) = model.bodies[axis.body].parent_R_axis.leftCols<2>().transpose() *
                               log_so3(Mat3(from.tilted[axis.body].transpose() * to.tilted[axis.body]));
  for (const UnknownPoint& point : model.unknown_points)
    e.segment<3>(point.state) = to.moved[point.body] - from.moved[point.body];
  return e;
}

TEST(ChainStateRetract, TheErrorBetweenTwoStatesLeadsFromOneToTheOther) {
  const MovingTree tree(3, BaseMode::moving);
  VectorXd error = 0.1 * test::random_matrix(tree.model.layout.size, 1, 5);
  error.tail(tree.model.layout.size - tree.model.layout.first_geometry).setZero();
  ChainState moved = tree.state;
  retract(tree.model, error, moved);
  EXPECT_LT((error_between(tree.model, tree.state, moved) - error).norm(), 1e-12);
  for (const Mat3& ball : moved.spherical) EXPECT_LT((ball.transpose() * ball - Mat3::Identity()).norm(), 1e-13);
}

TEST(PredictMean, TheVelocityOfABaseStaysWhileNothingAcceleratesIt) {
  MovingTree tree(6, BaseMode::moving);
  tree.state.acceleration = Vec3::Zero();
  EXPECT_LT((tree.after(5.0).velocity - tree.state.velocity).norm(), 1e-12);
}

/// Beyond steps between means of rates, which take the velocity for linear.
TEST(PredictMean, TwoHalvesAreOneWholeForJointsOfOneAxis) {
  const MovingTree tree(4, BaseMode::still);
  ChainState halves = tree.after(0.04);
  predict_mean(tree.model, 0.05, halves);
  const ChainState whole = tree.after(0.09);
  for (std::size_t b = 1; b < tree.model.bodies.size(); ++b) {
    if (degrees_of_freedom(tree.model.bodies[b].motion) != 1) continue;
    const Index at = position_states * tree.model.layout.position[b];
    EXPECT_LT((halves.joints - whole.joints).segment<3>(at).norm(), 1e-13);
  }
  EXPECT_NEAR(halves.time, whole.time, 1e-15);
  EXPECT_EQ(whole.world_R_base, tree.state.world_R_base) << "a base at rest stays";
}

TEST(PredictMean, IsTheIntegralOfItsOwnVelocity) {
  const MovingTree tree(5, BaseMode::moving);
  constexpr double h = 1e-5, t = 0.05;
  const ChainState before = tree.after(t - h), now = tree.after(t), after = tree.after(t + h);
  for (std::size_t b = 1; b < tree.model.bodies.size(); ++b) {
    const Index dof = degrees_of_freedom(tree.model.bodies[b].motion), first = tree.model.layout.position[b];
    for (Index i = 0; i < dof; ++i) {
      const Index at = position_states * (first + i);
      if (dof == 1) {
        EXPECT_NEAR((after.joints[at] - before.joints[at]) / (2 * h), now.joints[at + 1], 1e-8);
      }
      EXPECT_NEAR((after.joints[at + 1] - before.joints[at + 1]) / (2 * h), now.joints[at + 2], 1e-8);
      EXPECT_NEAR(
          now.joints[at + 2],
          tree.state.joints[at + 2] * std::exp(-t / tree.model.positions[static_cast<std::size_t>(first + i)].time),
          1e-12);
    }
  }
  EXPECT_LT(((after.rate - before.rate) / (2 * h) - now.angular_acceleration).norm(), 1e-8);
  EXPECT_LT((after.world_R_base.transpose() * after.world_R_base - Mat3::Identity()).norm(), 1e-13);
}

/// Whether a state's noise depends on how steps are divided: that of a joint whose acceleration counts as linear within
/// a step, however long it is, and a position whose velocity does.
bool is_bridged(const FilterModel& model, Index state, ShownMeans means) {
  const Index position = (state - base_states) / position_states;
  if (state < base_states || position >= model.layout.positions) return false;
  return model.positions[static_cast<std::size_t>(position)].is_measured ||
         (means == ShownMeans::rates && (state - base_states) % position_states == 0);
}

/// With the noise taken off, F P Fᵀ with F by differences of the mean.
TEST(PredictCovariance, CarriesErrorsAsTheMeanCarriesThem) {
  for (const BaseMode base : {BaseMode::still, BaseMode::moving}) {
    const MovingTree tree(6, base);
    const Index n = tree.model.layout.size;
    constexpr double dt = 0.01;
    const ChainState after = tree.after(dt);
    const MatrixXd f = numeric_jacobian(
        [&](const VectorXd& error) {
          ChainState moved = tree.state;
          retract(tree.model, error, moved);
          predict_mean(tree.model, dt, moved);
          VectorXd e = error_between(tree.model, after, moved);
          e.tail(n - tree.model.layout.first_geometry) = error.tail(n - tree.model.layout.first_geometry);
          return e;
        },
        VectorXd::Zero(n));
    const MatrixXd root = test::random_matrix(n, n, 7) / std::sqrt(static_cast<double>(n));
    MatrixXd p = times_transposed(root, root), noise = MatrixXd::Zero(n, n);
    const MatrixXd carried = f * p * f.transpose();
    predict_covariance(tree.model, tree.state, dt, noise);
    predict_covariance(tree.model, tree.state, dt, p);
    EXPECT_LT((p - p.transpose()).cwiseAbs().maxCoeff(), 1e-14);
    MatrixXd error = (p - noise - carried).cwiseAbs();
    EXPECT_LT(error.maxCoeff(), 3e-4) << "attitudes of the base and of balls are carried to first order in dt";
    const auto leave_out = [&](Index state) { error.row(state).setZero(), error.col(state).setZero(); };
    for (Index i = 0; i < 3; ++i) {
      leave_out(BaseIndex::attitude + i);
      leave_out(tree.model.layout.joint_state(tree.model.layout.position[5] + i));  // the ball
    }
    EXPECT_LT(error.maxCoeff(), 1e-7);
    EXPECT_GE(symmetric_eigen(noise).values[0], -1e-12);
  }
}

TEST(PredictCovariance, NoiseOfManyShortStepsIsThatOfOneLongOne) {
  const MovingTree tree(8, BaseMode::still);
  const Index n = tree.model.layout.size;
  for (const ShownMeans means : {ShownMeans::rates, ShownMeans::accelerations}) {
    MatrixXd once = MatrixXd::Zero(n, n), often = once;
    predict_covariance(tree.model, tree.state, 0.02, once, means);
    ChainState state = tree.state;
    for (int i = 0; i < 20; ++i) {
      predict_covariance(tree.model, state, 0.001, often, means);
      predict_mean(tree.model, 0.001, state);
    }
    for (Index i = 0; i < n; ++i)
      if (!is_bridged(tree.model, i, means)) EXPECT_NEAR(often(i, i), once(i, i), 0.06 * once(i, i) + 1e-15) << i;
    const Index bias = tree.model.layout.sensor_state(0);
    EXPECT_NEAR(once(bias, bias), 0.02 * tree.model.bias_walk.rate, 1e-18);
  }
}

/// Means of the rate over steps tell the change of position exactly.
TEST(PredictCovariance, AMeasuredRateLeavesNothingOfThePositionToChance) {
  MovingTree tree(8, BaseMode::still);
  const auto turning = std::ranges::find_if(tree.model.positions, [](const auto& p) { return !p.is_measured; });
  ASSERT_NE(turning, tree.model.positions.end());
  const Index at = tree.model.layout.joint_state(turning - tree.model.positions.begin());
  const auto position_given_velocity = [&](double dt, ShownMeans means) {
    MatrixXd p = MatrixXd::Zero(tree.model.layout.size, tree.model.layout.size);
    predict_covariance(tree.model, tree.state, dt, p, means);
    EXPECT_NEAR(p(at + 1, at + 1), turning->density() * dt * dt * dt / 3.0, 1e-12);
    return p(at, at) - square(p(at, at + 1)) / p(at + 1, at + 1);
  };
  EXPECT_NEAR(position_given_velocity(0.02, ShownMeans::rates), 0.0, 1e-18);
  for (const auto& [dt, means] : {std::pair{0.02, ShownMeans::accelerations}, std::pair{0.1, ShownMeans::rates}})
    EXPECT_NEAR(position_given_velocity(dt, means), turning->density() * std::pow(dt, 5) * (1.0 / 20.0 - 3.0 / 64.0),
                1e-12)
        << "a gap, or a sensor that is lost";
}

/// An acceleration that decays within a step took it further, by 1e-4 s of the velocity in all.
TEST(PredictMean, BetweenTwoMeansOfRatesThePositionIsTheirTrapezoid) {
  MovingTree tree(8, BaseMode::still);
  const auto body = std::ranges::find(tree.model.bodies, JointMotion::revolute, &InsBody::motion);
  ASSERT_NE(body, tree.model.bodies.end());
  const Index position = tree.model.layout.position[static_cast<std::size_t>(body - tree.model.bodies.begin())];
  const auto missing = [&](double dt, ShownMeans means) {
    ChainState state = tree.state;
    double* x = state.joints.data() + position_states * position;
    x[2] = 30.0;
    const double q = x[0], rate = x[1];
    predict_mean(tree.model, dt, state, means);
    return x[0] - q - 0.5 * dt * (rate + x[1]);
  };
  EXPECT_NEAR(missing(0.02, ShownMeans::rates), 0.0, 1e-12);
  for (const auto& [dt, means] : {std::pair{0.02, ShownMeans::accelerations}, std::pair{0.1, ShownMeans::rates}}) {
    const double time = tree.model.positions[static_cast<std::size_t>(position)].time;
    EXPECT_NEAR(missing(dt, means), 30.0 * dt * dt * dt / (12.0 * time), 0.2 * 30.0 * dt * dt * dt / (12.0 * time));
  }
}

/// Means of the acceleration over steps tell the change of velocity exactly, so that only what no mean tells (a gap) is
/// left to chance.
TEST(PredictCovariance, AMeasuredAccelerationLeavesNothingOfTheVelocityToChance) {
  MovingTree tree(8, BaseMode::still);
  const auto measured = std::ranges::find_if(tree.model.positions, &AccelerationProcess::is_measured);
  ASSERT_NE(measured, tree.model.positions.end());
  const Index at = tree.model.layout.joint_state(measured - tree.model.positions.begin());
  const auto velocity_given_acceleration = [&](double dt) {
    MatrixXd p = MatrixXd::Zero(tree.model.layout.size, tree.model.layout.size);
    predict_covariance(tree.model, tree.state, dt, p);
    return p(at + 1, at + 1) - square(p(at + 1, at + 2)) / p(at + 2, at + 2);
  };
  EXPECT_NEAR(velocity_given_acceleration(0.02), 0.0, 1e-18);
  const double gap = 0.1;
  EXPECT_NEAR(velocity_given_acceleration(gap), measured->density() * gap * gap * gap / 12.0, 1e-12);
}

/// Of a drive that is livelier than that of the identification no acceleration is excluded; a gentler one changes
/// nothing.
TEST(PredictCovariance, AJointMayMoveAsItHasMovedLately) {
  MovingTree tree(8, BaseMode::still);
  const auto turning = std::ranges::find_if_not(tree.model.positions, &AccelerationProcess::is_measured);
  ASSERT_NE(turning, tree.model.positions.end());
  const Index position = turning - tree.model.positions.begin(), at = tree.model.layout.joint_state(position);
  const double dt = 0.02;
  const auto variance = [&](double acceleration) {
    ChainState state = tree.state;
    for (double t = 0.0; t < 60.0; t += dt) {
      state.joints[position_states * position + 2] = acceleration;
      predict_mean(tree.model, dt, state);
    }
    MatrixXd p = MatrixXd::Zero(tree.model.layout.size, tree.model.layout.size);
    predict_covariance(tree.model, state, dt, p);
    return p(at + 2, at + 2);
  };
  EXPECT_DOUBLE_EQ(variance(0.9 * turning->sd), variance(0.0));
  EXPECT_NEAR(variance(5.0 * turning->sd), 25.0 * variance(0.0), 1e-3 * variance(0.0));
}

TEST(ChainStateOf, ABaseAtRestFeelsGravityAlone) {
  const MovingTree tree(9, BaseMode::still);
  const InsState base = tree.state.base_state(9.8);
  EXPECT_NEAR(base.force.norm(), 9.8, 1e-12);
  EXPECT_LT((tree.state.world_R_base * base.force - Vec3(0, 0, 9.8)).norm(), 1e-12);
  EXPECT_EQ(initial_state(tree.model).joints.size(), position_states * tree.model.layout.positions);
}

}  // namespace
}  // namespace kinfer::track
