// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/model/chain_measurement.hpp"

#include <gtest/gtest.h>

#include <type_traits>

#include "support/differences.hpp"
#include "support/random_tracked_tree.hpp"

namespace kinfer::track {
namespace {

using kinfer::testing::numeric_jacobian;
using test::random_state;
using test::random_tree;
using test::random_turn;
using test::random_vector;

TEST(ChainMeasurement, DerivativesByTheErrorStateAgreeWithDifferences) {
  Rng rng(3);
  const FilterModel model = filter_model(random_tree(rng));
  const ChainState state = random_state(model, rng);
  ChainEvaluator evaluator(model);
  evaluator.evaluate(model, state);
  const FilterLayout& layout = model.layout;
  EXPECT_LT((evaluator.result().value - predicted_measurement(model, state)).norm(), 1e-12);
  const MatrixXd numeric = numeric_jacobian(
      [&](const VectorXd& step) {
        ChainState moved = state;
        retract(model, step, moved);
        FilterModel other = model;
        for (std::size_t b = 1; b < model.bodies.size(); ++b)
          other.bodies[b] = kinfer::retract(
              model.bodies[b], step.segment(layout.first_geometry + layout.geometry[b], model.bodies[b].unknowns()));
        return predicted_measurement(other, moved);
      },
      VectorXd::Zero(layout.size));
  const ChainMeasurement& m = evaluator.result();
  EXPECT_LT((m.by_fast - numeric.leftCols(layout.fast)).norm(), 1e-6);
  MatrixXd error = m.by_geometry - numeric.rightCols(layout.size - layout.first_unseen);
  // A limb turns about its segment's axis as the model has it.
  const InsBody& segment = model.bodies[model.unknown_turns.front().segment];
  const Index own = layout.unseen() + layout.geometry[model.unknown_turns.front().segment];
  error.middleCols(own + 2, 2).setZero();
  error.middleCols<3>(own + segment.unknowns() - 3).setZero();
  EXPECT_LT(error.norm(), 1e-6);
  for (std::size_t s = 0; s < model.sensors.size(); ++s) {
    const auto row = sensor_rows * static_cast<Index>(s), own = layout.sensor_state(static_cast<Index>(s));
    for (Index k = 0; k < 3; ++k) {
      const Vec3 rate = numeric.row(row + k).segment<3>(own + SensorIndex::gyroscope_scale + 3 * k),
                 force = numeric.row(row + 3 + k).segment<3>(own + SensorIndex::accelerometer_scale + 3 * k);
      EXPECT_LT((rate - m.angular_velocity[s]).norm(), 1e-6);
      EXPECT_LT((force - m.force[s]).norm(), 1e-6);
      EXPECT_NEAR(numeric(row + k, own + SensorIndex::gyroscope_bias + k), 1.0, 1e-6);
      EXPECT_NEAR(numeric(row + 3 + k, own + SensorIndex::accelerometer_bias + k), 1.0, 1e-6);
    }
  }
}

/// Smooth motion of everything, and the poses that the tracking model's formulas give.
struct Trajectory {
  const TrackingModel& model;
  VectorXd amplitude, frequency;
  Vec3 turn, sweep, push;

  double q(Index i, double t) const { return amplitude[i] * std::sin(frequency[i] * t + static_cast<double>(i)); }

  Mat3 ball(double t) const { return exp_so3(std::sin(t) * turn) * exp_so3(0.7 * t * sweep); }

  std::vector<Pose> poses(double t) const {
    std::vector<Pose> world{{exp_so3(std::cos(t) * sweep) * exp_so3(t * turn), std::sin(1.3 * t) * push}};
    Index at = 0;
    for (std::size_t b = 1; b < model.bodies.size(); ++b) {
      const TrackingBody& body = model.bodies[b];
      Pose step{body.parent_R_axis * body.child_R_axis.transpose(), body.point_in_parent};
      if (body.motion == TrackingMotion::revolute)
        step.rotation = body.parent_R_axis * rot_z(q(at++, t)) * body.child_R_axis.transpose();
      if (body.motion == TrackingMotion::prismatic) step.position += q(at++, t) * body.parent_R_axis.col(2);
      if (body.motion == TrackingMotion::spherical) {
        step.rotation = body.parent_R_axis * ball(t) * body.child_R_axis.transpose();
        at += 3;
      }
      step.position -= step.rotation * body.point_in_child;
      world.push_back(world[static_cast<std::size_t>(body.parent)] * step);
    }
    return world;
  }
};

constexpr double h = 1e-3;

template <class F>
std::invoke_result_t<F, double> first_difference(const F& f, double t) {
  return (f(t + h) - f(t - h)) / (2.0 * h);
}
template <class F>
std::invoke_result_t<F, double> second_difference(const F& f, double t) {
  return (f(t + h) - 2.0 * f(t) + f(t - h)) / (h * h);
}

template <class Rotation>
Vec3 body_rate(const Rotation& rotation, double t) {
  return log_so3(Mat3(rotation(t - h).transpose() * rotation(t + h))) / (2.0 * h);
}

TEST(ChainMeasurement, IsThatOfPosesAlongATrajectory) {
  Rng rng(4);
  TrackingModel tracking = random_tree(rng);
  for (TrackingSensor& sensor : tracking.sensors) sensor = {.name = "s", .body = sensor.body};
  const FilterModel model = filter_model(tracking);
  const auto n = model.layout.positions;
  const Trajectory path{tracking,           VectorXd::Constant(n, 0.8), VectorXd::LinSpaced(n, 0.7, 1.9),
                        random_vector(rng), random_vector(rng),         random_vector(rng)};
  constexpr double t0 = 0.4;
  ChainState state = initial_state(model);
  state.base = BaseMode::moving;
  const auto base_rotation_at = [&](double t) { return path.poses(t)[0].rotation; };
  const auto base_rate_at = [&](double t) { return body_rate(base_rotation_at, t); };
  state.world_R_base = base_rotation_at(t0);
  state.rate = base_rate_at(t0);
  state.angular_acceleration = first_difference(base_rate_at, t0);
  state.acceleration = second_difference([&](double t) { return path.poses(t)[0].position; }, t0);
  for (Index i = 0; i < n; ++i) {
    const auto q = [&](double t) { return path.q(i, t); };
    state.joints.segment<3>(position_states * i) << q(t0), first_difference(q, t0), second_difference(q, t0);
  }
  const auto ball_rate = [&](double t) { return body_rate([&](double at) { return path.ball(at); }, t); };
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion == JointMotion::spherical) {
      state.spherical[b] = path.ball(t0);
      const Vec3 rate = ball_rate(t0), change = first_difference(ball_rate, t0);
      for (Index k = 0; k < 3; ++k)
        state.joints.segment<3>(position_states * (model.layout.position[b] + k)) << 0.0, rate[k], change[k];
    }
  const VectorXd value = predicted_measurement(model, state);
  for (std::size_t s = 0; s < model.sensors.size(); ++s) {
    const auto body = static_cast<std::size_t>(model.sensors[s].body);
    const Vec3 rate = body_rate([&](double t) { return path.poses(t)[body].rotation; }, t0);
    const Vec3 acceleration = second_difference([&](double t) { return path.poses(t)[body].position; }, t0);
    const Vec3 force = path.poses(t0)[body].rotation.transpose() * Vec3(acceleration + Vec3(0, 0, model.gravity));
    EXPECT_LT((value.segment<3>(sensor_rows * static_cast<Index>(s)) - rate).norm(), 1e-4) << s;
    EXPECT_LT((value.segment<3>(sensor_rows * static_cast<Index>(s) + 3) - force).norm(), 1e-3) << s;
  }
}

/// The covariance's transition is the derivative of the mean's.
TEST(ChainState, CovarianceMovesAsTheMeanDoes) {
  Rng rng(5);
  FilterModel model = filter_model(random_tree(rng));
  model.bias_walk = {};
  const ChainState state = random_state(model, rng);
  constexpr double dt = 0.01;
  const FilterLayout& layout = model.layout;
  const auto moved = [&](const VectorXd& step) {
    ChainState other = state;
    retract(model, step, other);
    predict_mean(model, dt, other);
    return other;
  };
  const ChainState there = moved(VectorXd::Zero(layout.size));
  const auto difference = [&](const ChainState& other) {
    VectorXd d = VectorXd::Zero(layout.fast);
    d.segment<3>(BaseIndex::attitude) = log_so3(there.world_R_base.transpose() * other.world_R_base);
    d.segment<3>(BaseIndex::rate) = other.rate - there.rate;
    d.segment<3>(BaseIndex::angular_acceleration) = other.angular_acceleration - there.angular_acceleration;
    d.segment<3>(BaseIndex::velocity) = other.velocity - there.velocity;
    d.segment<3>(BaseIndex::acceleration) = other.acceleration - there.acceleration;
    d.segment(base_states, there.joints.size()) = other.joints - there.joints;
    for (std::size_t b = 1; b < model.bodies.size(); ++b)
      if (model.bodies[b].motion == JointMotion::spherical) {
        const Vec3 turn = log_so3(there.spherical[b].transpose() * other.spherical[b]);
        for (Index k = 0; k < 3; ++k) d[layout.joint_state(layout.position[b] + k)] = turn[k];
      }
    return d;
  };
  const MatrixXd numeric =
      numeric_jacobian([&](const VectorXd& step) { return difference(moved(step)); }, VectorXd::Zero(layout.size));
  MatrixXd root = MatrixXd::Zero(layout.size, layout.size);
  for (Index i = 0; i < root.size(); ++i) root.data()[i] = random_vector(rng).x();
  MatrixXd covariance = root * root.transpose(), without = MatrixXd::Zero(layout.size, layout.size);
  MatrixXd transition = MatrixXd::Identity(layout.size, layout.size);
  transition.topRows(layout.fast) = numeric;
  const MatrixXd expected = transition * covariance * transition.transpose();
  predict_covariance(model, state, dt, covariance);
  predict_covariance(model, state, dt, without);  // the process noise alone
  EXPECT_LT((covariance - without - expected).cwiseAbs().maxCoeff(), 2e-3 * expected.cwiseAbs().maxCoeff());
  EXPECT_LT((covariance - covariance.transpose()).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace kinfer::track
