// SPDX-License-Identifier: Apache-2.0
// Terms that weigh themselves do no harm: rigid robots, and data from which little can be known.
#include "kinfer/calibrate/terms/selection/weighed_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

// Of 60 residuals all candidates together explain nearly everything, whatever the noise.
TEST(WeighedModel, FewPointsOfUnstatedNoiseGiveRigidRobotsNoTerms) {
  int wrong = 0;
  for (int seed = 1; seed <= 12; ++seed) {
    const Chain truth = with_random_errors(nominal_robot(), {}, Rng(seed));
    PoseSet data = with_approach(simulated_readings(truth, 20, 20 + seed));
    measure_points(data, truth, tracker, Rng(40 + seed));
    const Calibration c = calibrate_robot({nominal_robot(), {}, std::nullopt, data}, {}, Rng(1)).value();
    wrong += selected_model(c.model_selection) != "geometry";
  }
  EXPECT_LE(wrong, 1);
}

TEST(WeighedModel, ManyPointsOfUnstatedNoiseShowGains) {
  for (int seed = 1; seed <= 3; ++seed) {
    Chain truth = with_random_errors(nominal_robot(), {}, Rng(seed));
    for (Joint& joint : truth.joints) joint.gain = 1.0 + 1e-3 * (seed % 2 ? 1.0 : -1.0);
    PoseSet data = simulated_readings(truth, 40, 20 + seed);
    measure_points(data, truth, tracker, Rng(40 + seed));
    const Calibration c = calibrate_robot({nominal_robot(), {}, std::nullopt, data}, {}, Rng(1)).value();
    EXPECT_TRUE(is_selected(step_with(c, Term::gain))) << seed;
  }
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
  EXPECT_NE(words::reason(step_with(c, Term::torque_compliance)).find("do not excite"), std::string::npos);
}

TEST(WeighedModel, ATemperatureThatIsTheTimeDoesNoHarm) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(3));
  PoseSet data = with_approach(simulated_readings(truth, 60));
  for (int row = 0; row < 60; ++row) data.time.push_back(10.0 * row), data.temperature.push_back(20.0 + 0.1 * row);
  measure_points(data, truth, tracker, Rng(4));
  EXPECT_LE(ratio_to_geometry(data, truth), 1.01);
  const Calibration c = default_calibration(nominal_robot(), data);
  EXPECT_EQ(step_with(c, Term::thermal_expansion).decision, Decision::no_evidence);
}

TEST(WeighedModel, OfTwoProportionalColumnsOneIsTakenOrBothAreNamed) {
  Chain nominal = nominal_robot();
  nominal.masses = {{1, Vec3(0.4, 0, 0), 60.0}, {3, Vec3(0, 0, 0.1), 30.0}};
  Chain truth = with_random_errors(nominal, {}, Rng(3));
  truth.joints[1].compliance = truth.joints[2].compliance = 1e-6;
  PoseSet data = simulated_readings(truth, 80);
  measure_points(data, truth, tracker, Rng(4));
  data.torques = gravity_torques_of_rows(nominal, data);
  const Calibration both = default_calibration(nominal, data),
                    one = default_calibration(nominal, data, FixedModel{{Term::gravity_compliance}});
  EXPECT_LE(error_on_unseen(both, truth), 1.05 * error_on_unseen(one, truth));
  const bool takes_gravity = is_selected(step_with(both, Term::gravity_compliance)),
             takes_torques = is_selected(step_with(both, Term::torque_compliance));
  EXPECT_TRUE(takes_gravity || takes_torques);
  const auto names_both = [](const UndeterminedGroup& group) {
    const auto has = [&](const char* name) {
      return std::ranges::find(group.parameters, name) != group.parameters.end();
    };
    return has("compliance2") && has("torque_compliance2");
  };
  if (takes_gravity && takes_torques) {
    EXPECT_TRUE(std::ranges::any_of(both.estimate.identifiability.undetermined, names_both));
  }
}

TEST(WeighedModel, OnePoseTwoHundredTimesIsNoEvidenceForAnyTerm) {
  const Chain truth = with_random_errors(nominal_robot(), {}, Rng(3));
  PoseSet data = simulated_readings(truth, 240);
  for (int row = 40; row < 240; ++row) data.joints.col(row) = data.joints.col(39);
  measure_points(data, truth, tracker, Rng(4));
  EXPECT_LE(ratio_to_geometry(data, truth), 1.05);
  const Calibration c = default_calibration(nominal_robot(), data);
  EXPECT_EQ(c.accuracy.size(), 40u) << "the poses that are reported are the different ones";
  EXPECT_TRUE(std::ranges::any_of(c.accuracy, [](const PoseAccuracy& pose) { return pose.rows.size() == 201; }));
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
    if (seed > 1) continue;
    EXPECT_TRUE(std::ranges::any_of(default_calibration(nominal_robot(), data).recommendations, [](const auto& advice) {
      return advice.kind == CalibrationAdviceKind::measure_more_poses;
    }));
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
  EXPECT_TRUE(std::ranges::any_of(c.estimate.outliers, [](const Outlier& o) { return o.row == 17; }));
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
  add_spectral_lines(candidates, find_gear_harmonics(geometry, data), task, data);
  const std::size_t after = candidates.parameters.size();
  EXPECT_GT(after, before) << "the line was found";
  add_spectral_lines(candidates, find_gear_harmonics(geometry, data), task, data);
  EXPECT_EQ(candidates.parameters.size(), after);
}

}  // namespace
}  // namespace kinfer
