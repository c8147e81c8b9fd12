// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/mean_rates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Positions by the trapezoidal rule over the means of blocks of a sine, [rad] worst error, with and without what the
/// rule misses.
struct RuleErrors {
  double of_rule = 0.0, left = 0.0;
};

RuleErrors errors_of_sine(int rows) {
  constexpr double frequency = 9.0, length = 0.02, amplitude = 1.0;  // [rad/s], [s], [rad]
  FilterModel model;
  model.layout.positions = 1;
  model.positions = {machine_acceleration};
  model.layout.position = {-1, 0};
  model.bodies.resize(2);
  model.bodies[1].motion = JointMotion::revolute;
  ChainState state;
  state.joints = VectorXd::Zero(position_states);
  MeanRates means(model);
  VectorXd error = VectorXd::Zero(model.layout.joint_state(1));
  const Index at = model.layout.joint_state(0);
  RuleErrors worst;
  double by_rule = amplitude * std::sin(0.0), before = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double middle = k * length;
    double mean = 0.0;
    for (int i = 0; i < rows; ++i) {
      const double t = middle + length * ((i + 0.5) / rows - 0.5);
      mean += amplitude * frequency * std::cos(frequency * t) / rows;
    }
    if (k > 0) by_rule += 0.5 * length * (before + mean);
    before = mean;
    state.joints[1] = mean;
    means.add_missed(model, state, length, rows, error);
    const double truth = amplitude * std::sin(frequency * middle);
    if (k < 5) continue;
    worst.of_rule = std::max(worst.of_rule, std::abs(by_rule - truth));
    worst.left = std::max(worst.left, std::abs(by_rule + error[at] - truth));
  }
  return worst;
}

TEST(MeanRates, WhatTheTrapezoidalRuleMissesIsKnown) {
  for (const int rows : {1, 2, 4, 10}) {
    const RuleErrors errors = errors_of_sine(rows);
    const double n = rows, c = 1.0 / 12.0 + (1.0 - 1.0 / (n * n)) / 24.0;
    EXPECT_NEAR(errors.of_rule, c * 0.02 * 0.02 * 81.0, 0.1 * errors.of_rule) << rows;
    EXPECT_LT(errors.left, 0.2 * errors.of_rule)
        << rows << ": it lags by half a block, and began with a rate of half a block later";
  }
}

}  // namespace
}  // namespace kinfer::track
