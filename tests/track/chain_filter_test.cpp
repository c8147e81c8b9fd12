// SPDX-License-Identifier: Apache-2.0
// The filter on a chain against Kalman's equations with dense matrices.
#include "kinfer/track/filter/chain_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/track/faults/fit_monitor.hpp"
#include "kinfer/track/faults/replay.hpp"
#include "kinfer/track/model/thresholds.hpp"
#include "support/random_tracked_tree.hpp"

namespace kinfer::track {
namespace {

using test::random_matrix;
using test::random_vector;

/// A tree in a known posture, its geometry known to a centimetre; no soft constraints, so that sensors alone count.
struct TrackedTree {
  std::shared_ptr<FilterModel> model;
  ChainState state;
  MatrixXd fast;

  explicit TrackedTree(std::uint64_t seed) {
    Rng rng(seed);
    model = std::make_shared<FilterModel>(filter_model(test::random_tree(rng)));
    model->prismatic.clear();
    model->unknown_turns.clear();  // noise by tilts
    model->parameters = spread(model->layout.size - model->layout.fast, 1e-2);
    for (SensorSettings& s : model->sensors)
      s.white = {0.01, 0.1}, s.persistent = {0.002, 0.03}, s.slow = {0.02, 0.2}, s.sample_period = 0.005;
    state = test::random_state(*model, rng);
    state.base = BaseMode::still;
    fast = spread(model->layout.fast, 0.05);
  }

  /// A covariance of these many states with correlations among all of them.
  static MatrixXd spread(Index n, double sd) {
    const MatrixXd root = random_matrix(n, n, 77) * sd / std::sqrt(static_cast<double>(n));
    return times_transposed(root, root) + 0.1 * sd * sd * MatrixXd::Identity(n, n);
  }

  ChainFilter filter() const {
    ChainFilter made(model);
    made.start(state, fast);
    return made;
  }

  /// What the sensors measure in the state, and a little noise.
  BlockMeasurement block(std::uint64_t seed) const {
    Rng rng(seed);
    const VectorXd value = predicted_measurement(*model, filter().state());
    BlockMeasurement b{.time = 0.0, .length = 0.02, .sensors = {}};
    for (Index s = 0; s < model->layout.sensors; ++s) {
      BlockSample sample{.rate_count = 4, .force_count = 4};
      sample.rate = value.segment<3>(6 * s) + 0.005 * random_vector(rng);
      sample.force = value.segment<3>(6 * s + 3) + 0.05 * random_vector(rng);
      b.sensors.push_back(sample);
    }
    return b;
  }

  /// Derivatives of all measurements by all states, and the variances of their noise.
  MatrixXd jacobian() const {
    ChainEvaluator evaluator(*model);
    evaluator.evaluate(*model, filter().state());
    const ChainMeasurement& m = evaluator.result();
    const FilterLayout& layout = model->layout;
    MatrixXd h = MatrixXd::Zero(layout.rows(), layout.size);
    h.leftCols(layout.fast) = m.by_fast;
    h.rightCols(layout.size - layout.first_unseen) = m.by_geometry;
    for (Index s = 0; s < layout.sensors; ++s)
      for (Index k = 0; k < 3; ++k) {
        const Index own = layout.sensor_state(s);
        h(6 * s + k, own + SensorIndex::gyroscope_bias + k) = 1.0;
        h(6 * s + 3 + k, own + SensorIndex::accelerometer_bias + k) = 1.0;
        h.row(6 * s + k).segment<3>(own + SensorIndex::gyroscope_scale + 3 * k) =
            m.angular_velocity[static_cast<std::size_t>(s)].transpose();
        h.row(6 * s + 3 + k).segment<3>(own + SensorIndex::accelerometer_scale + 3 * k) =
            m.force[static_cast<std::size_t>(s)].transpose();
      }
    return h;
  }
  VectorXd noise() const {
    VectorXd r(model->layout.rows());
    for (Index s = 0; s < model->layout.sensors; ++s) {
      r.segment<3>(6 * s).setConstant(std::max(1e-4 / 4 + 4e-6, 4e-4 * 0.005 / 0.02));
      r.segment<3>(6 * s + 3).setConstant(std::max(1e-2 / 4 + 9e-4, 4e-2 * 0.005 / 0.02));
    }
    return r;
  }
};

/// Largest difference of two states' numbers.
double difference(const ChainState& a, const ChainState& b) {
  double most = (a.world_R_base - b.world_R_base).cwiseAbs().maxCoeff();
  most = std::max(most, (a.joints - b.joints).cwiseAbs().maxCoeff());
  for (const auto& member : {&ChainState::rate, &ChainState::angular_acceleration, &ChainState::velocity})
    most = std::max(most, (a.*member - b.*member).cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < a.spherical.size(); ++i)
    most = std::max(most, (a.spherical[i] - b.spherical[i]).cwiseAbs().maxCoeff());
  for (std::size_t s = 0; s < a.sensors.size(); ++s) {
    most = std::max(most, (a.sensors[s].gyroscope_bias - b.sensors[s].gyroscope_bias).cwiseAbs().maxCoeff());
    most = std::max(most, (a.sensors[s].accelerometer_scale - b.sensors[s].accelerometer_scale).cwiseAbs().maxCoeff());
  }
  return most;
}

TEST(ChainFilter, AnUpdateIsKalmansExceptThatGeometryIsOnlyConsidered) {
  const TrackedTree tree(3);
  ChainFilter filter = tree.filter();
  const MatrixXd p = filter.covariance(), h = tree.jacobian();
  const BlockMeasurement block = tree.block(4);
  filter.update(block);
  const MatrixXd w = p * h.transpose(), s = h * w + MatrixXd(tree.noise().asDiagonal());
  const MatrixXd gain = s.ldlt().solve(w.transpose()).transpose();
  const VectorXd innovation = filter.innovations().value;
  const VectorXd before = predicted_measurement(*tree.model, tree.filter().state());
  for (std::size_t i = 0; i < block.sensors.size(); ++i) {
    const auto row = 6 * static_cast<Index>(i);
    EXPECT_LT((innovation.segment<3>(row) - (block.sensors[i].rate - before.segment<3>(row))).norm(), 1e-12);
    EXPECT_LT((innovation.segment<3>(row + 3) - (block.sensors[i].force - before.segment<3>(row + 3))).norm(), 1e-12);
  }
  const Index estimated = tree.model->layout.first_point, geometry = tree.model->layout.size - estimated;
  MatrixXd expected = p - gain * s * gain.transpose();
  expected.bottomRightCorner(geometry, geometry) = p.bottomRightCorner(geometry, geometry);
  EXPECT_LT((filter.covariance() - expected).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_TRUE(filter.covariance() == filter.covariance().transpose());
  VectorXd error = gain * innovation;
  error.tail(geometry).setZero();
  ChainState state = tree.filter().state();
  retract(*tree.model, error, state);
  EXPECT_LT(difference(filter.state(), state), 1e-10);
}

TEST(ChainFilter, LeaveOneOutIsWhatAllOtherSensorsWouldHavePredicted) {
  const TrackedTree tree(5);
  ChainFilter filter = tree.filter();
  const MatrixXd h = tree.jacobian();
  const MatrixXd s = h * filter.covariance() * h.transpose() + MatrixXd(tree.noise().asDiagonal());
  filter.update(tree.block(6));
  const VectorXd& v = filter.innovations().value;
  for (Index out = 0; out < tree.model->layout.sensors; ++out) {
    std::vector<Index> others;
    for (Index i = 0; i < v.size(); ++i)
      if (i / 6 != out) others.push_back(i);
    const auto n = static_cast<Index>(others.size());
    MatrixXd cross(6, n), rest(n, n);
    VectorXd seen(n);
    for (Index i = 0; i < n; ++i) {
      seen[i] = v[others[static_cast<std::size_t>(i)]];
      cross.col(i) = s.col(others[static_cast<std::size_t>(i)]).segment<6>(6 * out);
      for (Index j = 0; j < n; ++j)
        rest(i, j) = s(others[static_cast<std::size_t>(i)], others[static_cast<std::size_t>(j)]);
    }
    const auto factor = rest.ldlt();
    const VectorXd left = v.segment<6>(6 * out) - cross * factor.solve(seen);
    const MatrixXd covariance = s.block<6, 6>(6 * out, 6 * out) - cross * factor.solve(MatrixXd(cross.transpose()));
    const double expected = left.dot(covariance.ldlt().solve(left));
    EXPECT_NEAR(filter.innovations().leave_out[static_cast<std::size_t>(out)], expected, 1e-6 * (1.0 + expected));
    EXPECT_EQ(filter.innovations().rows[static_cast<std::size_t>(out)], 6);
  }
  const double log_likelihood = -0.5 * v.dot(s.ldlt().solve(v)) - 0.5 * s.ldlt().vectorD().array().log().sum();
  EXPECT_NEAR(filter.innovations().log_likelihood, log_likelihood, 1e-7 * std::abs(log_likelihood));
}

TEST(ChainFilter, MeasurementsThatAreMissingAreThoseOfInfiniteNoise) {
  const TrackedTree tree(7);
  BlockMeasurement block = tree.block(8);
  block.sensors[1].force_count = 0;
  block.sensors[4].rate_count = block.sensors[4].force_count = 0;
  ChainFilter filter = tree.filter();
  const MatrixXd p = filter.covariance(), h = tree.jacobian();
  VectorXd noise = tree.noise();
  noise.segment<3>(9).setConstant(1e12), noise.segment<6>(24).setConstant(1e12);
  filter.update(block);
  const MatrixXd w = p * h.transpose(), s = h * w + MatrixXd(noise.asDiagonal());
  MatrixXd expected = p - w * s.ldlt().solve(MatrixXd(w.transpose()));
  const Index geometry = tree.model->layout.size - tree.model->layout.first_point;
  expected.bottomRightCorner(geometry, geometry) = p.bottomRightCorner(geometry, geometry);
  EXPECT_LT((filter.covariance() - expected).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(filter.innovations().rows[1], 3);
  EXPECT_EQ(filter.innovations().rows[4], 0);
}

TEST(ChainFilter, ASensorOutOfUseChangesNothingButIsStillCompared) {
  const TrackedTree tree(9);
  ChainFilter without = tree.filter(), missing = tree.filter();
  without.use_sensor(2, false);
  BlockMeasurement block = tree.block(10);
  block.sensors[2].rate += Vec3(5, 5, 5);
  without.update(block);
  EXPECT_GT(without.innovations().leave_out[2], 1000.0);
  block.sensors[2].rate_count = block.sensors[2].force_count = 0;
  missing.update(block);
  EXPECT_EQ(difference(without.state(), missing.state()), 0.0);
  EXPECT_TRUE(without.covariance() == missing.covariance());
}

TEST(ChainFilter, AScalarMeasurementIsKalmansToo) {
  const TrackedTree tree(11);
  ChainFilter filter = tree.filter();
  const MatrixXd p = filter.covariance();
  const Index at = tree.model->layout.joint_state(0), other = tree.model->layout.sensor_state(1);
  ChainFilter::ScalarRow row{.terms = 2, .innovation = 0.01, .variance = 1e-4};
  row.at = {at, other}, row.factor = {1.0, -2.0};
  filter.update(row);
  VectorXd h = VectorXd::Zero(p.rows());
  h[at] = 1.0, h[other] = -2.0;
  const VectorXd w = p * h;
  const double variance = h.dot(w) + 1e-4;
  MatrixXd expected = p - w * w.transpose() / variance;
  const Index geometry = tree.model->layout.size - tree.model->layout.first_point;
  expected.bottomRightCorner(geometry, geometry) = p.bottomRightCorner(geometry, geometry);
  EXPECT_LT((filter.covariance() - expected).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(filter.state().joints[0] - tree.state.joints[0], 0.01 * w[at] / variance, 1e-14);
}

/// Against Kalman's equations of a state with one more element, the noise.
TEST(ChainFilter, NoiseThatIsInAStateAlreadyIsTakenOutOfIt) {
  const TrackedTree tree(11);
  ChainFilter filter = tree.filter();
  const Index n = tree.model->layout.size, estimated = tree.model->layout.first_point;
  const Index bias = tree.model->layout.sensor_state(1), at = tree.model->layout.joint_state(0);
  const double noise = 1e-5, covariance = -4e-5;
  MatrixXd p = MatrixXd::Zero(n + 1, n + 1);
  p.topLeftCorner(n, n) = filter.covariance();
  p(n, n) = noise;
  p(n, at) = p(at, n) = covariance;
  VectorXd h = VectorXd::Zero(n + 1);
  h[bias] = h[n] = 1.0;
  const VectorXd w = p * h;
  MatrixXd expected = p - w * w.transpose() / h.dot(w);
  expected.block(estimated, estimated, n - estimated, n - estimated) =
      p.block(estimated, estimated, n - estimated, n - estimated);
  filter.update({.at = {bias},
                 .factor = {1.0},
                 .terms = 1,
                 .innovation = 0.003,
                 .variance = noise,
                 .noisy_state = at,
                 .noise_covariance = covariance});
  EXPECT_LT((filter.covariance() - expected.topLeftCorner(n, n)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(filter.state().joints[0] - tree.state.joints[0], 0.003 * w[at] / h.dot(w), 1e-14);
}

TEST(ChainFilter, AStateSharesNoMoreNoiseThanItsVarianceHolds) {
  const TrackedTree tree(11);
  ChainFilter filter = tree.filter();
  const Index bias = tree.model->layout.sensor_state(1), at = tree.model->layout.joint_state(0);
  const double before = filter.covariance()(at, at);
  filter.update({.at = {bias},
                 .factor = {1.0},
                 .terms = 1,
                 .innovation = 0.0,
                 .variance = 1e3,  // so that the bias' own uncertainty does not matter
                 .noisy_state = at,
                 .noise_covariance = -1e6});
  EXPECT_NEAR(filter.covariance()(at, at) / before, 0.75, 1e-3);
}

TEST(ChainFilter, APlacedJointIsKnownThereAndToNothingElse) {
  const TrackedTree tree(13);
  ChainFilter filter = tree.filter();
  filter.place(1, 0.7, 0.02);
  const Index at = tree.model->layout.joint_state(1);
  EXPECT_EQ(filter.state().joints[position_states], 0.7);
  EXPECT_DOUBLE_EQ(filter.covariance()(at, at), 4e-4);
  EXPECT_NEAR(filter.covariance().row(at).norm(), 4e-4, 1e-18);
  filter.count_from_here(1);
  EXPECT_EQ(filter.covariance().col(at).norm(), 0.0);
}

/// A considered axis that is off shows as another bias in another posture: only sensors that turn forget theirs.
/// A measurement of the position alone, by its result.
TEST(ChainFilter, WhatIsCorrelatedWithASupposedPositionGoesAlong) {
  const TrackedTree tree(8);
  const Index at = tree.model->layout.joint_state(1);
  ChainFilter measured = tree.filter(), supposed = measured;
  const double variance = measured.covariance()(at, at), noise = 0.3 * variance, gain = variance / (variance + noise);
  ChainFilter::ScalarRow row{.terms = 1, .innovation = 0.1, .variance = noise};
  row.at[0] = at, row.factor[0] = 1.0;
  measured.update(row);
  supposed.suppose(1, supposed.state().joints[position_states] + gain * 0.1, std::sqrt(gain * noise));
  EXPECT_LT(difference(measured.state(), supposed.state()), 1e-12);
  EXPECT_LT((measured.covariance() - supposed.covariance()).cwiseAbs().maxCoeff(), 1e-12);
}

/// Of a block in which a sensor has rows at the end only.
TEST(ChainFilter, AMeasurementOfALaterTimeIsComparedWithThePredictionThere) {
  const TrackedTree tree(5);
  ChainFilter filter = tree.filter(), late = filter;
  filter.update(tree.block(1));
  const VectorXd before = predicted_measurement(*tree.model, tree.filter().state());
  late.update(tree.block(1));
  const double dt = 0.02, later = 0.006;
  for (ChainFilter* of : {&filter, &late}) of->predict(dt);
  const VectorXd change = (predicted_measurement(*tree.model, filter.state()) - before) / dt;
  BlockMeasurement block = tree.block(2);
  block.time = dt;
  filter.update(block);
  block.sensors[1].rate_time = later;
  late.update(block);
  const VectorXd difference = filter.innovations().value - late.innovations().value;
  EXPECT_LT((difference.segment<3>(6) - later * change.segment<3>(6)).norm(), 1e-9);
  EXPECT_EQ(difference.tail(difference.size() - 9).norm(), 0.0);
}

/// By one innovation: the rows changed at another rate before, and how fast they change now is known no better than
/// that.
TEST(ChainFilter, AMeasurementOfALaterTimeIsAsUncertainAsTheRateOfChange) {
  const TrackedTree tree(5);
  ChainFilter filter = tree.filter();
  const VectorXd before = predicted_measurement(*tree.model, filter.state());
  filter.update(tree.block(1));
  const double dt = 0.02, later = 0.006;
  filter.predict(dt);
  const VectorXd change = (predicted_measurement(*tree.model, filter.state()) - before) / dt;
  ChainFilter late = filter;
  BlockMeasurement block = tree.block(2);
  block.time = dt;
  filter.update(block);
  for (std::size_t s = 0; s < block.sensors.size(); ++s) {
    BlockSample& sample = block.sensors[s];
    sample.rate_time = sample.force_time = later;
    sample.rate += later * change.segment<3>(6 * static_cast<Index>(s));
    sample.force += later * change.segment<3>(6 * static_cast<Index>(s) + 3);
  }
  late.update(block);
  EXPECT_LT((late.innovations().value - filter.innovations().value).norm(), 1e-9);
  EXPECT_GT(late.covariance().trace(), 1.001 * filter.covariance().trace());
}

TEST(FitMonitor, WhatNobodyHasComparedForSecondsIsForgotten) {
  const TrackedTree tree(6);
  ChainFilter filter = tree.filter();
  FitMonitor fit(filter.model().sensors.size(), filter.model().joints.size());
  BlockMeasurement block = tree.block(3);
  block.sensors[1].force += Vec3::Constant(5.0);
  filter.update(block);
  fit.add(filter, 0.0, 0.02);
  const double then = fit.sensor(1).quick;
  EXPECT_GT(then, 1.1);
  block.sensors[1].rate_count = block.sensors[1].force_count = 0;
  filter.update(block);
  for (int i = 1; i < 150; ++i) fit.add(filter, 0.02 * i, 0.02);
  EXPECT_NEAR(fit.sensor(1).quick, 1.0, 0.02 * (then - 1.0));
}

TEST(ChainFilter, BiasesOfForceAreForgottenWithTheAngleTurnedThrough) {
  const TrackedTree tree(3);
  FilterModel known = *tree.model;
  for (SensorSettings& s : known.sensors) s.axis_sd = 0.0;
  ChainFilter filter = tree.filter(), without(std::make_shared<FilterModel>(known));
  without.start(tree.state, tree.fast);
  for (ChainFilter* each : {&filter, &without}) {
    each->update(tree.block(4));
    each->predict(each->state().time + 0.05);
  }
  ChainEvaluator evaluator(known);
  evaluator.evaluate(known, tree.filter().state());
  for (std::size_t s = 0; s < known.sensors.size(); ++s) {
    const Index bias = known.layout.sensor_state(static_cast<Index>(s)) + SensorIndex::accelerometer_bias;
    const double added = filter.covariance()(bias, bias) - without.covariance()(bias, bias);
    const double turned = 0.05 * evaluator.result().angular_velocity[s].norm();
    const double expected = posture_walk * turned * square(known.gravity * tree.model->sensors[s].axis_sd);
    EXPECT_NEAR(added, expected, 1e-6 * expected + 1e-15);
  }
}

TEST(FilterModel, AxisSdsAreThoseOfTheDirectionsOnEachSegment) {
  Rng rng(5);
  TrackingModel model = test::random_tree(rng, true);
  const FilterModel filter = filter_model(model);
  bool is_any = false;
  for (const SensorSettings& sensor : filter.sensors) {
    double squares = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      const TrackingParameter& p = model.parameters[i];
      const TrackingBody& body = model.bodies[static_cast<std::size_t>(p.index)];
      const bool is_own = p.kind == TrackingParameterKind::child_rotation && p.index == sensor.body;
      const bool is_next = p.kind == TrackingParameterKind::parent_rotation && body.parent == sensor.body;
      if ((!is_own && !is_next) || p.component == 2) continue;
      if (filter.bodies[static_cast<std::size_t>(p.index)].motion == JointMotion::spherical) continue;
      squares += model.covariance(static_cast<Index>(i), static_cast<Index>(i)), ++count;
    }
    EXPECT_NEAR(sensor.axis_sd, count > 0 ? std::sqrt(squares / count) : 0.0, 1e-15);
    is_any |= sensor.axis_sd > 0.0;
  }
  EXPECT_TRUE(is_any);
}

/// A first-order process forgets: after a long gap a bias is off by the difference of two of its values.
TEST(ChainFilter, BiasesMayHaveChangedWhereItStartsAgain) {
  const TrackedTree tree(16);
  ChainFilter before = tree.filter();
  before.update(tree.block(1));
  const TrackingModel given = [] {
    Rng rng(16);
    return test::random_tree(rng);
  }();
  const double gyroscope = std::max(min_bias_instability.rate, given.prior.bias_instability.rate);
  const InsLevel walk = tree.model->bias_walk;
  const auto grown = [&](double gap, Index state) {
    ChainFilter filter = before;
    ChainState later = tree.state;
    later.time = before.state().time + gap;
    filter.start(later, tree.fast);
    return filter.covariance()(state, state) - before.covariance()(state, state);
  };
  for (Index s = 0; s < tree.model->layout.sensors; ++s) {
    const Index bias = tree.model->layout.sensor_state(s);
    EXPECT_EQ(grown(0.0, bias + SensorIndex::gyroscope_bias), 0.0);
    EXPECT_NEAR(grown(10.0, bias + SensorIndex::gyroscope_bias), 10.0 * walk.rate, 1e-3 * walk.rate);
    EXPECT_NEAR(grown(10.0, bias + SensorIndex::accelerometer_bias), 10.0 * walk.force, 1e-3 * walk.force);
    EXPECT_NEAR(grown(1e6, bias + SensorIndex::gyroscope_bias), 2.0 * square(gyroscope), 1e-3 * square(gyroscope));
  }
  EXPECT_EQ(tree.filter().covariance()(tree.model->layout.sensor_state(0), tree.model->layout.sensor_state(0)),
            tree.model->parameters(0, 0))
      << "nothing was known before the first start";
}

TEST(Replay, OfNothingThatIsNewEndsWhereTheFilterIs) {
  const TrackedTree tree(15);
  ChainFilter filter = tree.filter();
  Replay replay(filter);
  for (std::uint64_t i = 1; i <= 7; ++i) {
    BlockMeasurement block = tree.block(i);
    block.time = 0.02 * static_cast<double>(i);
    filter.predict(block.time);
    filter.update(block);
    replay.add(block, filter);
  }
  ChainFilter again = filter;
  int blocks = 0;
  replay.run(
      again, [](ChainFilter&) {}, [&](const ChainFilter&, const BlockMeasurement&) { ++blocks; });
  EXPECT_EQ(blocks, 7);
  EXPECT_EQ(difference(again.state(), filter.state()), 0.0);
  EXPECT_TRUE(again.covariance() == filter.covariance());
}

TEST(FitMonitor, NamesTheSensorThatDisagreesAndForgetsItWhenItAgreesAgain) {
  const TrackedTree tree(17);
  ChainFilter filter = tree.filter();
  FitMonitor monitor(6, filter.model().joints.size());
  const auto run = [&](double turned, double seconds) {
    constexpr double step = 0.1;  // [s]
    for (double t = 0.0; t < seconds; t += step) {
      BlockMeasurement block = tree.block(static_cast<std::uint64_t>(1000 * t) + 1);
      block.sensors[3].rate += Vec3::Constant(turned);
      filter.start(tree.state, tree.fast);
      filter.update(block);
      monitor.add(filter, t, step);
    }
  };
  run(0.0, 5.0);
  EXPECT_EQ(monitor.worst(filter), (Suspect{}));
  run(2.0, 5.0);
  EXPECT_EQ(monitor.worst(filter), (Suspect{.sensor = 3}));
  EXPECT_TRUE(monitor.sensor(3).is_suspect);
  filter.use_sensor(3, false);
  EXPECT_EQ(monitor.worst(filter), (Suspect{})) << "it is out of use already";
  EXPECT_EQ(monitor.recovered(filter, [](std::size_t) { return true; }), (Suspect{}));
  monitor.reset_sensor(3);
  EXPECT_FALSE(monitor.sensor(3).is_suspect);
}

}  // namespace
}  // namespace kinfer::track
