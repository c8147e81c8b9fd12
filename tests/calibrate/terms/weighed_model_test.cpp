// SPDX-License-Identifier: Apache-2.0
// Terms that weigh themselves do no harm: rigid robots, and data from which little can be known.
#include "kinfer/calibrate/terms/weighed_model.hpp"

#include <gtest/gtest.h>

#include "calibrate/terms/simulated_selection.hpp"
#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/terms/candidate_terms.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/words/calibration/model.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

Calibration default_calibration(const Chain& nominal, const PoseSet& data,
                                const ModelChoice& model = AutomaticModel{}) {
  return calibrate_robot({nominal, {}, tracker, data}, {.model = model}, Rng(1)).value();
}

double error_on_unseen(const Calibration& c, const Chain& truth) {
  PoseSet rows = simulated_readings(truth, 200, 77);
  measure_points(rows, truth, noise_free, Rng(1));
  return mean(point_errors(c.estimate.chain, rows));
}

/// The default's mean error on unseen poses over that of geometry alone.
double ratio_to_geometry(const PoseSet& data, const Chain& truth) {
  return error_on_unseen(default_calibration(nominal_robot(), data), truth) /
         error_on_unseen(default_calibration(nominal_robot(), data, FixedModel{}), truth);
}

TEST(WeighedModel, RigidRobotsLoseNothing) {
  std::vector<double> ratios;
  for (int seed = 1; seed <= 10; ++seed) {
    const Chain truth = with_random_errors(nominal_robot(), {}, Rng(seed));
    PoseSet data = with_approach(simulated_readings(truth, 40, 20 + seed));
    measure_points(data, truth, tracker, Rng(40 + seed));
    ratios.push_back(ratio_to_geometry(data, truth));
  }
  EXPECT_LE(mean(ratios), 1.01);
}

TEST(WeighedModel, TorquesThatAreZeroOrConstantAreNotExcited) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(3));
  PoseSet data = simulated_readings(truth, 60);
  measure_points(data, truth, tracker, Rng(4));
  for (const double torque : {0.0, 30.0}) {
    data.torques = MatrixXd::Constant(6, data.rows(), torque);
    const Calibration c = default_calibration(nominal_robot(), data);
    EXPECT_FALSE(is_selected(step_with(c, Term::torque_compliance))) << torque;
    EXPECT_EQ(selected_model(c.model_selection), "geometry") << torque;
  }
  data.torques.setZero();
  const Calibration c = default_calibration(nominal_robot(), data);
  EXPECT_EQ(step_with(c, Term::torque_compliance).decision, Decision::not_excited);
}

TEST(WeighedModel, OnePoseTwoHundredTimesIsNoEvidenceForAnyTerm) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(3));
  PoseSet data = simulated_readings(truth, 240);
  for (int row = 40; row < 240; ++row) data.joints.col(row) = data.joints.col(39);
  measure_points(data, truth, tracker, Rng(4));
  EXPECT_LE(ratio_to_geometry(data, truth), 1.05);
}

TEST(WeighedModel, TenPosesAndMoreTermsThanMeasurementsDoNoHarm) {
  std::vector<double> ratios;
  for (int seed = 1; seed <= 10; ++seed) {
    const Chain truth = with_random_errors(nominal_robot(), {}, Rng(seed));
    PoseSet data = with_approach(simulated_readings(truth, 10, 500 + seed));
    Rng rng(seed);
    data.torques = MatrixXd::Zero(6, data.rows());
    for (double& torque : data.torques.reshaped()) torque = 50.0 * rng.normal();
    measure_points(data, truth, tracker, Rng(40 + seed));
    ratios.push_back(ratio_to_geometry(data, truth));
  }
  EXPECT_LE(mean(ratios), 1.05);
}

TEST(WeighedModel, AWildRowInTheOnlyPoseThatExcitesATermDoesNotDecide) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(3));
  PoseSet data = simulated_readings(truth, 60);
  data.torques = MatrixXd::Zero(6, data.rows());
  data.torques(1, 17) = 200.0;
  measure_points(data, truth, tracker, Rng(4));
  data.points[17].position += Vec3(0.0, 0.8e-3, 0.0);
  const Calibration c = default_calibration(nominal_robot(), data);
  EXPECT_LE(ratio_to_geometry(data, truth), 1.05) << selected_model(c.model_selection);
}

TEST(WeighedModel, AnAcceptedTermSaysWhatItContributesAndHowSure) {
  Chain truth = with_random_errors(nominal_robot(), {}, Rng(4));
  truth.joints[1].harmonics = {{1.0, 1.5e-4, 0.0}, {2.0, 1e-4, 1.5e-4}};
  PoseSet data = simulated_readings(truth, 80);
  measure_points(data, truth, tracker, Rng(5));
  const Calibration c = default_calibration(nominal_robot(), data);
  const SelectionStep& gear = step_with(c, Term::gear_harmonics);
  EXPECT_EQ(gear.decision, Decision::accepted) << words::reason(gear);
  EXPECT_GT(gear.log_evidence_gain, 10.0);
  EXPECT_GT(gear.contribution, 50e-6);
  EXPECT_LT(gear.contribution, 1e-3);
  EXPECT_LT(gear.interpolation.mean_after, gear.interpolation.mean_before);
  EXPECT_GT(gear.determined_count, 0);
  EXPECT_LE(gear.determined_count, gear.parameter_count);
  for (const ParameterEstimate& value : c.estimate.values)
    EXPECT_FALSE(value.name.find("1q4") != std::string::npos && std::abs(value.value) > 2.0 * value.sd) << value.name;
}

TEST(CandidateTerms, ALineThatIsACandidateAlreadyIsNotAddedAgain) {
  Chain truth = nominal_robot();
  truth.joints[0].harmonics = {{20.0, 3e-4, 0.0}};
  PoseSet data = with_approach(simulated_readings(truth, 400, 5));
  measure_points(data, truth, tracker, Rng(6));
  const CalibrationTask task{nominal_robot(), {}, tracker, data};
  const Estimate geometry = default_calibration(nominal_robot(), data, FixedModel{}).estimate;
  CandidateTerms candidates = make_candidates(geometry, task, data);
  const std::size_t before = candidates.parameters.size();
  add_spectral_lines(candidates, geometry, task, data);
  const std::size_t after = candidates.parameters.size();
  EXPECT_GT(after, before) << "the line was found";
  add_spectral_lines(candidates, geometry, task, data);
  EXPECT_EQ(candidates.parameters.size(), after);
}

}  // namespace
}  // namespace kinfer
