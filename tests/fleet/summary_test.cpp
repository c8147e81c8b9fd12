// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/summary.hpp"

#include <gtest/gtest.h>

#include "support/robots.hpp"

namespace kinfer {
namespace {

/// A calibration that found these numbers of its chain, each as it is in the chain.
Calibration calibration_of(const Chain& chain, const std::vector<ParameterAddress>& numbers) {
  Calibration c;
  c.estimate.chain = c.nominal_model.chain = chain;
  for (const ParameterAddress& at : numbers) {
    const Parameter parameter = parameter_at(chain, at, 1e-3);
    c.estimate.parameters.parameters.push_back(parameter);
    c.estimate.values.push_back(
        {.name = parameter.name, .quantity = parameter.quantity, .value = value_at(chain, at), .sd = 1e-3});
  }
  const auto n = static_cast<Eigen::Index>(numbers.size());
  c.estimate.covariance = 1e-6 * MatrixXd::Identity(n, n);
  return c;
}

/// A harmonic or a coupling that the simulated robot does not have is zero, whatever else that one has in its place.
TEST(FleetSummary, WhatTheTruthLacksIsZeroInIt) {
  Chain truth = test::nominal_robot(), found = truth;
  std::get<MdhLink>(truth.joints[1].link).theta = 0.25;
  truth.joints[2].harmonics = {{2.0, 4e-4, 0.0}};
  found.joints[1].harmonics = {{1.0, 3e-4, 5e-4}};
  found.joints[2].harmonics = {{1.0, 1e-4, 0.0}, {2.0, 3e-4, 0.0}};
  found.joints[2].couplings = {{1, 2e-3}};
  const std::vector<ParameterAddress> numbers{JointNumber{1, Field::theta}, JointNumber{1, Field::sine, 0},
                                              JointNumber{2, Field::sine, 0}, JointNumber{2, Field::sine, 1},
                                              JointNumber{2, Field::coupling, 0}};
  const TaskSummary summary = fleet::summary_of(calibration_of(found, numbers), &truth);
  ASSERT_EQ(summary.parameters.size(), numbers.size());
  const double expected[] = {0.25, 0.0, 0.0, 4e-4, 0.0};
  for (std::size_t k = 0; k < numbers.size(); ++k) EXPECT_EQ(summary.parameters[k].truth, expected[k]) << k;
}

}  // namespace
}  // namespace kinfer
