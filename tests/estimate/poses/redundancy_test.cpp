// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/redundancy.hpp"

#include <gtest/gtest.h>

#include "kinfer/linalg/products.hpp"
#include "support/instruments.hpp"

namespace kinfer {
namespace {

using namespace test;

const Instrument instrument{.sigma = 20e-6, .sigma_tilt = 1e-3};

/// A few points beside many tilts.
struct TwoKinds {
  Chain chain = er20();
  ParameterSet set = all_parameters(chain, {});
  PoseSet data;
  Weights weights;

  TwoKinds() {
    data = readings_of(measured(chain, paper2_poses(30, noise_free)));
    measure_points(data, chain, instrument, Rng(1));
    data.points.resize(8);
    measure_tilts(data, chain, *instrument.sigma_tilt, Rng(2));
    weights = weights_of(data, instrument);
  }
  RedundancyOfKinds redundancy(const AbsorbedResiduals& absorbed) const {
    return redundancy_of_kinds(chain, set, data, weights, absorbed, 1);
  }
};

/// The diagonal of I − J (JᵀJ)⁻¹ Jᵀ with the whole Jacobian, rows of the priors included.
TEST(RedundancyOf, EachKindIsWhatTheHatMatrixLeavesOfItsRows) {
  const TwoKinds c;
  VectorXd r;
  MatrixXd jacobian;
  pose_residuals(c.chain, c.set, c.data, c.weights).evaluate(pack(c.set, c.chain), r, &jacobian);
  const MatrixXd inverse = gram(jacobian).inverse();
  const VectorXd leverage = (jacobian * inverse).cwiseProduct(jacobian).rowwise().sum();
  const Eigen::Index of_points = 3 * std::ssize(c.data.points), of_tilts = 2 * std::ssize(c.data.tilts);
  const RedundancyOfKinds found = c.redundancy({.by_parameters = 30.0});
  EXPECT_NEAR(found[index(kind_of<PointMeasurement>)], 1.0 - leverage.head(of_points).mean(), 1e-5);
  EXPECT_NEAR(found[index(kind_of<TiltMeasurement>)], 1.0 - leverage.segment(of_points, of_tilts).mean(), 1e-5);
  EXPECT_LT(found[index(kind_of<PointMeasurement>)], 0.5 * found[index(kind_of<TiltMeasurement>)]);
}

TEST(RedundancyOf, FunctionsBesideTheParametersAbsorbTheSameOfEachKind) {
  const TwoKinds c;
  const double residuals =
      3.0 * static_cast<double>(c.data.points.size()) + 2.0 * static_cast<double>(c.data.tilts.size());
  const RedundancyOfKinds without = c.redundancy({.by_parameters = 30.0}),
                          with = c.redundancy({.by_parameters = 30.0, .by_functions = 0.25 * residuals});
  for (const auto kind : {kind_of<PointMeasurement>, kind_of<TiltMeasurement>})
    EXPECT_NEAR(with[index(kind)], 0.75 * without[index(kind)], 1e-12);
}

TEST(RedundancyOf, OneKindAloneIsWhatTheParametersLeave) {
  TwoKinds c;
  c.data.tilts.clear();
  c.weights = weights_of(c.data, instrument);
  EXPECT_DOUBLE_EQ(c.redundancy({.by_parameters = 6.0})[index(kind_of<PointMeasurement>)], 0.75);
}

}  // namespace
}  // namespace kinfer
