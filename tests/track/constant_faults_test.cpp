// SPDX-License-Identifier: Apache-2.0
// Sensitivities of the filter to constant faults against the filter itself, run with and without them.
#include "kinfer/track/filter/constant_faults.hpp"

#include <gtest/gtest.h>

#include "kinfer/track/filter/chain_filter.hpp"
#include "support/random_tracked_tree.hpp"

namespace kinfer::track {
namespace {

ChainFilter started_filter() {
  Rng rng(3);
  auto model = std::make_shared<FilterModel>(filter_model(test::random_tree(rng)));
  model->prismatic.clear();
  for (SensorSettings& sensor : model->sensors) {  // a turn of the mounting turns no bias
    sensor.gyroscope_bias = sensor.accelerometer_bias = Vec3::Zero();
    sensor.gyroscope_scale = sensor.accelerometer_scale = Mat3::Zero();
  }
  ChainState state = test::random_state(*model, rng);
  state.base = BaseMode::still;
  ChainFilter filter(model);
  filter.start(state, 0.01 * MatrixXd::Identity(model->layout.fast, model->layout.fast));
  return filter;
}

/// Exactly what the filter expects next.
BlockMeasurement expected(ChainFilter filter, double time) {
  filter.predict(time);
  const VectorXd value = predicted_measurement(filter.model(), filter.state());
  BlockMeasurement block{.time = time, .length = 0.02, .sensors = {}};
  for (Index s = 0; s < filter.model().layout.sensors; ++s)
    block.sensors.push_back({.rate = value.segment<3>(sensor_rows * s),
                             .force = value.segment<3>(sensor_rows * s + 3),
                             .rate_count = 4,
                             .force_count = 4});
  return block;
}

std::vector<BlockMeasurement> expected_rows(ChainFilter filter) {
  std::vector<BlockMeasurement> rows;
  const double begin = filter.state().time;
  for (int i = 1; i <= 10; ++i) {
    rows.push_back(expected(filter, begin + 0.02 * i));
    filter.predict(rows.back().time);
    filter.update(rows.back());
  }
  return rows;
}

ChainFilter run(ChainFilter filter, const std::vector<BlockMeasurement>& rows, std::size_t sensor, const Vec3& turn) {
  const Mat3 turned = Mat3::Identity() + skew(turn);
  for (BlockMeasurement block : rows) {
    BlockSample& sample = block.sensors[sensor];
    sample.rate = turned * sample.rate, sample.force = turned * sample.force;
    filter.predict(block.time);
    filter.update(block);
  }
  return filter;
}

TEST(ConstantFaults, ATurnMovesTheStateByItsSensitivity) {
  const ChainFilter start = started_filter();
  const std::vector<BlockMeasurement> rows = expected_rows(start);
  const ChainFilter plain = run(start, rows, 0, Vec3::Zero());
  constexpr double step = 1e-6;
  for (std::size_t sensor = 0; sensor < rows[0].sensors.size(); ++sensor)
    for (Index axis = 0; axis < 3; ++axis) {
      const ChainFilter turned = run(start, rows, sensor, step * Vec3::Unit(axis));
      const VectorXd by_difference = (turned.state().joints - plain.state().joints) / step;
      const VectorXd by_fault = plain.constant_faults()
                                    .by_fault()
                                    .row(3 * static_cast<Index>(sensor) + axis)
                                    .segment(base_states, by_difference.size());
      // The joints of a spherical joint are turned on; its velocities and accelerations count.
      for (Index i = 0; i < by_difference.size(); ++i)
        if (i % position_states != 0) EXPECT_NEAR(by_difference[i], by_fault[i], 2e-2 * by_fault.norm() + 1e-6) << i;
    }
}

TEST(ConstantFaults, ScoresOfATurnAreItsInformationTimesTheTurn) {
  const ChainFilter start = started_filter();
  const std::vector<BlockMeasurement> rows = expected_rows(start);
  const Vec3 turn(2e-6, -1e-6, 3e-6);
  const ConstantFaults faults = run(start, rows, 1, turn).constant_faults();
  const Vec3 expected = faults.of(1).information * turn;
  EXPECT_GT(expected.norm(), 0.0);
  EXPECT_LT((faults.of(1).score - expected).norm(), 1e-2 * expected.norm());
}

TEST(ConstantFaults, ATurnThatIsBelievedIsTakenOutOfTheState) {
  const ChainFilter start = started_filter();
  const std::vector<BlockMeasurement> rows = expected_rows(start);
  const Vec3 turn(2e-5, -1e-5, 3e-5);
  const ChainFilter plain = run(start, rows, 1, Vec3::Zero());
  ChainFilter turned = run(start, rows, 1, turn);
  const double before = (turned.state().joints - plain.state().joints).norm();
  turned.believe_turn(1, turn, Mat3::Zero(), 1.0);
  EXPECT_LT((turned.state().joints - plain.state().joints).norm(), 3e-2 * before);
  const Mat3 scale = turned.state().sensors[1].gyroscope_scale - plain.state().sensors[1].gyroscope_scale;
  EXPECT_LT((scale - skew(turn)).norm(), 1e-2 * turn.norm());
}

/// What a turn is believed to be follows from the scores, and so from every fault.
TEST(ConstantFaults, ABeliefDependsOnOtherFaultsByTheScoresAsTheyCount) {
  const ChainFilter start = started_filter();
  const std::vector<BlockMeasurement> rows = expected_rows(start);
  constexpr double step = 1e-6, excess = 5.0;
  const Mat3 covariance = 1e-4 * Mat3::Identity();
  const auto believed = [&](ChainFilter filter) {
    const Vec3 mean = covariance * filter.constant_faults().of(1).score / excess;
    filter.believe_turn(1, mean, covariance, excess);
    return filter;
  };
  const ChainFilter plain = run(start, rows, 0, Vec3::Zero());
  const ChainFilter turned = run(start, rows, 2, step * Vec3::UnitX());
  const auto velocities = [](const VectorXd& joints) {
    return VectorXd(joints(Eigen::seq(1, Eigen::indexing::last, position_states)));
  };
  const VectorXd change = (believed(turned).state().joints - believed(plain).state().joints -
                           (turned.state().joints - plain.state().joints)) /
                          step;
  const MatrixXd by_fault = believed(plain).constant_faults().by_fault() - plain.constant_faults().by_fault();
  const VectorXd expected = velocities(by_fault.row(6).segment(base_states, change.size()));
  EXPECT_GT(expected.norm(), 0.0);
  EXPECT_LT((velocities(change) - expected).norm(), 5e-2 * expected.norm());
}

}  // namespace
}  // namespace kinfer::track
