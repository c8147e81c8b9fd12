// SPDX-License-Identifier: Apache-2.0
// Model selection accepts the terms that the data contain, rejects the others, and names those it could not test.
#include "kinfer/calibrate/terms/selection/model_selection.hpp"

#include <gtest/gtest.h>

#include "calibrate/terms/simulated_selection.hpp"
#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/terms/gear_harmonics.hpp"
#include "kinfer/calibrate/validation/extrapolation_splits.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "kinfer/words/calibration/model.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

bool selects(const Calibration& c, Term term) {
  return is_selected(step_with(c, term));
}

Calibration calibrated(const Chain& nominal, const PoseSet& data, const CalibrationOptions& options = {}) {
  return calibrate_robot({nominal, {}, tracker, data}, options, Rng(1)).value();
}

double error_on(const Chain& found, const Chain& truth, PoseSet rows) {
  measure_points(rows, truth, noise_free, Rng(1));
  return mean(point_errors(found, rows));
}

TEST(ModelSelection, GeometryAloneIsSelectedForAPurelyGeometricRobot) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  for (const int seed : {1, 2, 3}) {
    const Calibration c = calibrated(nominal_robot(), measured(truth, paper2_poses(60, tracker), seed));
    EXPECT_EQ(selected_model(c.model_selection), "geometry");
    EXPECT_EQ(step_with(c, Term::torque_compliance).missing, MissingData::torques);
    EXPECT_EQ(step_with(c, Term::thermal_expansion).missing, MissingData::temperature);
    EXPECT_FALSE(selects(c, Term::gain));
    EXPECT_TRUE(was_tested(step_with(c, Term::gain)));
  }
}

TEST(ModelSelection, ThePayloadMakesComplianceObservable) {
  Chain nominal = nominal_robot();
  nominal.masses = {{1, Vec3(0.4, 0, 0.1), 60.0}, {2, Vec3(0.1, 0, 0.1), 40.0}};
  Chain truth = with_random_errors(nominal, {}, Rng(2));
  truth.joints[1].compliance = 2e-6, truth.joints[2].compliance = 3e-6;
  PoseSet data = simulated_readings(truth, 60);
  for (int row = 0; row < 60; ++row) data.payload.push_back(row % 2 ? 20.0 : 0.0);
  measure_points(data, truth, tracker, Rng(3));
  const Calibration c = calibrated(nominal, data);
  EXPECT_TRUE(selects(c, Term::gravity_compliance)) << words::reason(step_with(c, Term::gravity_compliance));
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_NEAR(c.estimate.chain.joints[1].compliance, 2e-6, 0.3e-6);
  PoseSet unseen = simulated_readings(truth, 200, 77);
  unseen.payload.assign(200, 10.0);
  EXPECT_LT(error_on(c.estimate.chain, truth, unseen), 25e-6);
}

TEST(ModelSelection, TorqueComplianceBacklashGearHarmonicsAndThermalExpansionAreEachFound) {
  const Chain nominal = nominal_robot();
  const Chain geometry = with_random_errors(nominal, {}, Rng(4));
  const auto expect_found = [&](Term term, Chain truth, auto prepare) {
    PoseSet data = with_approach(simulated_readings(truth, 120));
    prepare(data);
    measure_points(data, truth, tracker, Rng(5));
    const Calibration c = calibrated(nominal, data);
    EXPECT_TRUE(selects(c, term)) << name(term) << ": " << words::reason(step_with(c, term));
    EXPECT_LT(error_on(c.estimate.chain, truth, data), 40e-6) << name(term);
  };
  Chain truth = geometry;
  truth.joints[1].torque_compliance = 3e-6;
  expect_found(Term::torque_compliance, truth, [](PoseSet& data) {
    Rng rng(6);
    data.torques = MatrixXd::Zero(6, data.rows());
    for (double& torque : data.torques.reshaped()) torque = 100.0 * rng.normal();
  });
  truth = geometry;
  truth.joints[0].backlash = truth.joints[2].backlash = 1e-4;
  expect_found(Term::backlash, truth, [](PoseSet&) {});
  truth = geometry;
  truth.joints[1].harmonics = {{1.0, 1.5e-4, 0.0}, {2.0, 1e-4, 1.5e-4}};
  expect_found(Term::gear_harmonics, truth, [](PoseSet&) {});
  truth = geometry;
  truth.expansion = 15e-6;
  truth.reference_temperature = 22.0;
  expect_found(Term::thermal_expansion, truth, [](PoseSet& data) {
    for (int row = 0; row < data.rows(); ++row) data.temperature.push_back(18.0 + row / 15.0);
  });
}

TEST(ModelSelection, AParallelogramsCouplingIsCorrectedAndAnUnlistedOneIsFound) {
  Chain nominal = nominal_robot();
  nominal.joints[2].couplings = {{1, -1.0}};
  Chain truth = with_random_errors(nominal, {}, Rng(4));
  truth.joints[2].couplings = {{1, -1.003}};
  truth.joints[5].couplings = {{4, 0.0125}};  // a hollow wrist: one tooth of eighty couples into joint 6
  PoseSet data = simulated_readings(truth, 80);
  measure_points(data, truth, tracker, Rng(5));
  const Calibration c = calibrated(nominal, data);
  EXPECT_TRUE(selects(c, Term::coupling)) << words::reason(step_with(c, Term::coupling));
  const auto factor = [&](const std::string& wanted) {
    for (const ParameterEstimate& value : c.estimate.values)
      if (value.name == wanted) return value;
    ADD_FAILURE() << wanted;
    return ParameterEstimate{};
  };
  EXPECT_NEAR(factor("coupling3_2").value, -1.003, 3.5 * factor("coupling3_2").sd);
  EXPECT_NEAR(factor("coupling6_5").value, 0.0125, 3.5 * factor("coupling6_5").sd);
  EXPECT_LT(factor("coupling3_2").sd, 1e-4);
  PoseSet unseen = simulated_readings(truth, 200, 77);
  EXPECT_LT(error_on(c.estimate.chain, truth, unseen), 25e-6);
}

TEST(ModelSelection, TheSpectrumShowsAMotorHarmonicOfUnknownOrder) {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(8));
  truth.joints[1].harmonics = {{80.0, 1.5e-4, 1e-4}};
  PoseSet data = simulated_readings(truth, 400);
  measure_points(data, truth, tracker, Rng(5));
  const Calibration c = calibrated(nominal_robot(), data);
  EXPECT_TRUE(selects(c, Term::spectral_harmonics)) << words::reason(step_with(c, Term::spectral_harmonics));
  const auto& lines = c.estimate.chain.joints[1].harmonics;
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const Harmonic& h) { return std::abs(h.order - 80) < 0.05; }));
}

TEST(ModelSelection, ANamedModelIsUsedAsGiven) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  const PoseSet data = measured(truth, paper2_poses(40, tracker));
  const Calibration c = calibrated(nominal_robot(), data, {.model = FixedModel{{Term::gear_harmonics}}});
  EXPECT_EQ(selected_model(c.model_selection), "geometry + gear");
  EXPECT_EQ(c.model_selection.steps.size(), 2u);
}

TEST(ModelSelection, SameModelAndSameNumbersFor12And7Threads) {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(4));
  truth.joints[0].backlash = 1e-4;
  PoseSet data = with_approach(simulated_readings(truth, 50));
  measure_points(data, truth, tracker, Rng(5));
  const Calibration one = calibrated(nominal_robot(), data, {.threads = 1});
  for (const int threads : {2, 7}) {
    const Calibration other = calibrated(nominal_robot(), data, {.threads = threads});
    EXPECT_EQ(selected_terms(other.model_selection), selected_terms(one.model_selection));
    EXPECT_EQ(other.estimate.covariance, one.estimate.covariance);
    for (std::size_t i = 0; i < one.model_selection.steps.size(); ++i)
      EXPECT_EQ(other.model_selection.steps[i].holdout.mean, one.model_selection.steps[i].holdout.mean);
  }
}

TEST(ExtrapolationSplits, HoldOutTheQuarterAtEachEndOfTwoDirections) {
  PoseSet data;
  data.joints = MatrixXd::Zero(3, 40);
  for (int row = 0; row < 40; ++row) data.joints(0, row) = row, data.joints(1, row) = row % 7;
  const std::vector<Split> splits = extrapolation_splits(data);
  ASSERT_EQ(splits.size(), 4u);
  for (const Split& split : splits) {
    EXPECT_EQ(split.train.size() + split.holdout.size(), 40u);
    EXPECT_NEAR(static_cast<double>(split.holdout.size()), 10.0, 4.0) << "rows of equal position stay together";
  }
  for (const int row : splits[0].holdout)
    EXPECT_EQ(std::ranges::count(splits[1].holdout, row), 0) << "opposite ends of one direction";
  EXPECT_TRUE(extrapolation_splits(select(data, {0, 1, 2, 3})).empty());
}

}  // namespace
}  // namespace kinfer
