// SPDX-License-Identifier: Apache-2.0
// Model selection accepts terms that are present, rejects others, and names those it could not test.
#include "kinfer/calibrate/terms/model_selection.hpp"

#include <gtest/gtest.h>

#include "kinfer/calibrate/terms/extrapolation_splits.hpp"
#include "kinfer/calibrate/terms/gear_harmonics.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "support/instruments.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

PoseSet readings(const Chain& truth, int poses, int seed = 1) {
  return readings_of(measured(truth, paper2_poses(poses, noise_free), seed));
}

const SelectionStep& step_named(const Calibration& c, const std::string& name) {
  for (const SelectionStep& r : c.model_selection.model_terms)
    if (r.name == name) return r;
  ADD_FAILURE() << "no model term is called " << name;
  return c.model_selection.model_terms.front();
}

Calibration climbed(const Chain& nominal, const PoseSet& data, const CalibrationOptions& options = {}) {
  return calibrate_robot({nominal, {}, tracker, data}, options, Rng(1)).value();
}

double error_on(const Chain& found, const Chain& truth, PoseSet rows) {
  measure_points(rows, truth, noise_free, Rng(1));
  return mean(point_errors(found, rows));
}

TEST(ModelSelection, GeometryAloneIsSelectedForAPurelyGeometricRobot) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  for (const int seed : {1, 2, 3}) {
    const Calibration c = climbed(nominal_robot(), measured(truth, paper2_poses(60, tracker), seed));
    EXPECT_EQ(c.model_selection.selected, "geometry");
    EXPECT_TRUE(step_named(c, "torques").skipped);
    EXPECT_NE(step_named(c, "torques").reason.find("no joint torques were measured"), std::string::npos);
    EXPECT_TRUE(step_named(c, "temperature").skipped);
    EXPECT_FALSE(step_named(c, "gains").selected);
    EXPECT_NE(step_named(c, "gains").reason.find("refused"), std::string::npos);
  }
}

TEST(ModelSelection, ThePayloadMakesComplianceObservable) {
  Chain nominal = nominal_robot();
  nominal.masses = {{1, Vec3(0.4, 0, 0.1), 60.0}, {2, Vec3(0.1, 0, 0.1), 40.0}};
  Chain truth = with_random_errors(nominal, {}, Rng(2));
  truth.joints[1].compliance = 2e-6, truth.joints[2].compliance = 3e-6;
  PoseSet data = readings(truth, 60);
  for (int row = 0; row < 60; ++row) data.payload.push_back(row % 2 ? 20.0 : 0.0);
  measure_points(data, truth, tracker, Rng(3));
  const Calibration c = climbed(nominal, data);
  EXPECT_TRUE(step_named(c, "gravity").selected) << step_named(c, "gravity").reason;
  EXPECT_TRUE(c.usable) << c.verdict;
  EXPECT_NEAR(c.estimate.chain.joints[1].compliance, 2e-6, 0.3e-6);
  PoseSet unseen = readings(truth, 200, 77);
  unseen.payload.assign(200, 10.0);
  EXPECT_LT(error_on(c.estimate.chain, truth, unseen), 25e-6);
}

TEST(ModelSelection, TorqueComplianceBacklashGearHarmonicsAndThermalExpansionAreEachFound) {
  const Chain nominal = nominal_robot();
  const Chain geometry = with_random_errors(nominal, {}, Rng(4));
  const auto found = [&](const std::string& name, Chain truth, auto prepare) {
    PoseSet data = with_approach(readings(truth, 120));
    prepare(data);
    measure_points(data, truth, tracker, Rng(5));
    const Calibration c = climbed(nominal, data);
    EXPECT_TRUE(step_named(c, name).selected) << name << ": " << step_named(c, name).reason;
    EXPECT_LT(error_on(c.estimate.chain, truth, data), 40e-6) << name;
  };
  Chain truth = geometry;
  truth.joints[1].torque_compliance = 3e-6;
  found("torques", truth, [](PoseSet& data) {
    Rng rng(6);
    data.torques = MatrixXd::Zero(6, data.rows());
    for (double& torque : data.torques.reshaped()) torque = 100.0 * rng.normal();
  });
  truth = geometry;
  truth.joints[0].backlash = truth.joints[2].backlash = 1e-4;
  found("backlash", truth, [](PoseSet&) {});
  truth = geometry;
  truth.joints[1].harmonics = {{1.0, 1.5e-4, 0.0}, {2.0, 1e-4, 1.5e-4}};
  found("gear", truth, [](PoseSet&) {});
  truth = geometry;
  truth.expansion = 15e-6;
  truth.reference_temperature = 22.0;
  found("temperature", truth, [](PoseSet& data) {
    for (int row = 0; row < data.rows(); ++row) data.temperature.push_back(18.0 + row / 15.0);
  });
}

TEST(ModelSelection, AParallelogramsCouplingIsCorrectedAndAnUndocumentedOneIsFound) {
  Chain nominal = nominal_robot();
  nominal.joints[2].couplings = {{1, -1.0}};
  Chain truth = with_random_errors(nominal, {}, Rng(4));
  truth.joints[2].couplings = {{1, -1.003}};
  truth.joints[5].couplings = {{4, 0.0125}};  // a hollow wrist: one tooth of eighty couples into joint 6
  PoseSet data = readings(truth, 80);
  measure_points(data, truth, tracker, Rng(5));
  const Calibration c = climbed(nominal, data);
  EXPECT_TRUE(step_named(c, "coupling").selected) << step_named(c, "coupling").reason;
  const auto factor = [&](const std::string& name) {
    for (const ParameterEstimate& value : c.estimate.values)
      if (value.name == name) return value;
    ADD_FAILURE() << name;
    return ParameterEstimate{};
  };
  EXPECT_NEAR(factor("coupling3_2").value, -1.003, 3.5 * factor("coupling3_2").sd);
  EXPECT_NEAR(factor("coupling6_5").value, 0.0125, 3.5 * factor("coupling6_5").sd);
  EXPECT_LT(factor("coupling3_2").sd, 1e-4);
  PoseSet unseen = readings(truth, 200, 77);
  EXPECT_LT(error_on(c.estimate.chain, truth, unseen), 25e-6);
}

TEST(ModelSelection, TheSpectrumShowsAMotorHarmonicOfUnknownOrder) {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(8));
  truth.joints[1].harmonics = {{80.0, 1.5e-4, 1e-4}};
  PoseSet data = readings(truth, 400);
  measure_points(data, truth, tracker, Rng(5));
  const Calibration c = climbed(nominal_robot(), data);
  EXPECT_TRUE(step_named(c, "spectrum").selected) << step_named(c, "spectrum").reason;
  const auto& lines = c.estimate.chain.joints[1].harmonics;
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const Harmonic& h) { return std::abs(h.order - 80) < 0.05; }));
}

TEST(ModelSelection, ANamedModelIsUsedAsGiven) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(1));
  const PoseSet data = measured(truth, paper2_poses(40, tracker));
  const Calibration c = climbed(nominal_robot(), data, {.model = FixedModel{{"gear"}}});
  EXPECT_EQ(c.model_selection.selected, "geometry + gear");
  EXPECT_EQ(c.model_selection.model_terms.size(), 2u);
}

TEST(ModelSelection, SameModelAndSameNumbersFor12And7Threads) {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(4));
  truth.joints[0].backlash = 1e-4;
  PoseSet data = with_approach(readings(truth, 50));
  measure_points(data, truth, tracker, Rng(5));
  const Calibration one = climbed(nominal_robot(), data, {.threads = 1});
  for (const int threads : {2, 7}) {
    const Calibration other = climbed(nominal_robot(), data, {.threads = threads});
    EXPECT_EQ(other.model_selection.selected, one.model_selection.selected);
    EXPECT_EQ(other.estimate.covariance, one.estimate.covariance);
    for (std::size_t i = 0; i < one.model_selection.model_terms.size(); ++i)
      EXPECT_EQ(other.model_selection.model_terms[i].holdout.mean, one.model_selection.model_terms[i].holdout.mean);
  }
}

TEST(ExtrapolationSplits, HalveTheRowsTwiceAndHoldOutEachHalf) {
  PoseSet data;
  data.joints = MatrixXd::Zero(3, 40);
  for (int row = 0; row < 40; ++row) data.joints(0, row) = row, data.joints(1, row) = row % 7;
  const std::vector<Split> splits = extrapolation_splits(data);
  ASSERT_EQ(splits.size(), 4u);
  for (const Split& split : splits) EXPECT_EQ(split.train.size() + split.holdout.size(), 40u);
  EXPECT_EQ(splits[0].train, splits[1].holdout);
  EXPECT_TRUE(extrapolation_splits(select(data, {0, 1, 2, 3})).empty());
}

}  // namespace
}  // namespace kinfer
