// SPDX-License-Identifier: Apache-2.0
// A fit without some of its terms is what a second fit without them is.
#include "kinfer/calibrate/terms/ablation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibrate/functions/nominal_fits.hpp"
#include "calibrate/terms/simulated_selection.hpp"
#include "kinfer/calibrate/functions/harmonic_series.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

struct WithTerm {
  PoseSet data;
  Estimate fit;
  std::vector<CandidateParameter> terms;
  Chain plain;  ///< where a fit without the term starts
  ParameterSet plain_set;
};

/// Readings of a robot with compliant joints, of which joint 2 errs by a function of its position, too.
WithTerm compliant_and_bent() {
  Chain truth = nominal_robot();
  truth = make_model_term(Term::gravity_compliance, truth, {{}, simulated_readings(truth, 10), {}}).nominal;
  for (Joint& joint : truth.joints) joint.compliance = 2e-6;
  WithTerm with{simulated_readings(truth, 400), {}, {}, nominal_robot(), {}};
  PoseSet moved = with.data;
  for (double& q : moved.joints.row(1)) q += 4e-4 * std::sin(5.0 * q + 1.5 * q * q);
  measure_points(moved, truth, tracker, Rng(51));
  with.data.points = moved.points;
  return with;
}

WithTerm fitted(bool with_series) {
  WithTerm with = compliant_and_bent();
  Estimate geometry = geometry_of(with.data);
  if (with_series) {
    const auto found = find_series(geometry, with.data, tracker);
    EXPECT_TRUE(found.has_value());
    if (!found) return with;
    geometry = fit_with_series(found->chain, found->parameters, with.data, tracker, {});
  }
  with.plain = geometry.chain, with.plain_set = geometry.parameters;
  const ModelTerm term = make_model_term(Term::gravity_compliance, geometry.chain, {{}, with.data, {}});
  for (const Parameter& parameter : term.parameters) with.terms.push_back({Term::gravity_compliance, parameter});
  with.fit =
      fit_with_series(term.nominal, with_parameters(geometry.parameters, term.parameters), with.data, tracker, {});
  return with;
}

/// `tolerance` [1]: of the mean error of that fit.
void expect_a_second_fit(const WithTerm& with, double tolerance) {
  ASSERT_FALSE(with.fit.values.empty());
  const Chain without = chain_without(with.fit, free_indices(with.fit, with.terms));
  const Chain refitted = fit_with_series(with.plain, with.plain_set, with.data, tracker, {}).chain;
  const double expected = mean_error(refitted, with.data);
  EXPECT_GT(expected, (1.0 + 2.0 * tolerance) * mean_error(with.fit.chain, with.data)) << "the term does something";
  EXPECT_NEAR(mean_error(without, with.data), expected, tolerance * expected);
}

TEST(Ablation, OfAChainIsASecondFit) {
  expect_a_second_fit(fitted(false), 0.01);
}

TEST(Ablation, TakesTheSeriesOfTheChainAlong) {
  const WithTerm with = fitted(true);
  EXPECT_GT(with.fit.series_response.size(), 0);
  expect_a_second_fit(with, 0.05);  // sizes of series are found anew in each fit
}

}  // namespace
}  // namespace kinfer
