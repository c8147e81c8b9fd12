// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/model_terms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "kinfer/calibrate/terms/approximate_masses.hpp"
#include "kinfer/calibrate/terms/holdout_errors.hpp"
#include "kinfer/calibrate/validation/extrapolation_splits.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

PoseSet ten_rows() {
  PoseSet data;
  data.joints = MatrixXd::Zero(6, 10);
  return data;
}

ModelTerm term_of(Term term, const Chain& nominal, const PoseSet& data) {
  return make_model_term(term, nominal, {.tolerances = {}, .rows = data});
}

std::vector<std::string> parameter_names_of(const ModelTerm& term) {
  std::vector<std::string> names;
  for (const Parameter& parameter : term.parameters) names.push_back(parameter.name);
  return names;
}

/// A robot whose third joint slides.
Chain robot_with_slide() {
  Chain chain = test::er20();
  chain.joints[2].type = JointType::prismatic;
  return chain;
}

TEST(ModelTerms, EveryOneStartsFromZeroAndHasPriors) {
  const Chain nominal = test::nominal_robot();
  VectorXd q = VectorXd::Constant(6, 0.3);
  const Pose before = forward(nominal, q);
  for (const TermMaker& maker : term_makers()) {
    const ModelTerm made = term_of(maker.term, nominal, ten_rows());
    EXPECT_LT((forward(made.nominal, q).position - before.position).norm(), 1e-12) << name(maker.term);
    for (const Parameter& parameter : made.parameters) {
      EXPECT_GT(parameter.prior_sd, 0.0) << parameter.name;
      EXPECT_LT(parameter.prior_sd, 0.1) << parameter.name;
    }
  }
}

TEST(ModelTerms, SayWhatTheDataDoNotHave) {
  const Chain nominal = test::er20();
  PoseSet data = ten_rows();
  EXPECT_EQ(term_of(Term::gain, nominal, data).missing, MissingData::none);
  EXPECT_EQ(term_of(Term::torque_compliance, nominal, data).missing, MissingData::torques);
  EXPECT_EQ(term_of(Term::backlash, nominal, data).missing, MissingData::approach_order);
  EXPECT_EQ(term_of(Term::thermal_expansion, nominal, data).missing, MissingData::temperature);
  EXPECT_EQ(term_of(Term::spectral_harmonics, nominal, data).missing, MissingData::spectral_line);
  Chain weightless = nominal;
  weightless.gravity.setZero();
  EXPECT_EQ(term_of(Term::gravity_compliance, weightless, data).missing, MissingData::gravity);
  data.torques = data.approach = MatrixXd::Zero(6, 10);
  data.temperature.assign(10, 20.0);
  EXPECT_EQ(term_of(Term::torque_compliance, nominal, data).missing, MissingData::none);
  EXPECT_EQ(term_of(Term::backlash, nominal, data).missing, MissingData::none);
  EXPECT_EQ(term_of(Term::thermal_expansion, nominal, data).missing, MissingData::temperature_range);
}

TEST(ModelTerms, TheReferenceTemperatureIsTheMedianUnlessTheFileStatesOne) {
  PoseSet data = ten_rows();
  for (int row = 0; row < 10; ++row) data.temperature.push_back(18.0 + row);
  data.temperature[4] = std::numeric_limits<double>::quiet_NaN();
  const ModelTerm term = term_of(Term::thermal_expansion, test::er20(), data);
  EXPECT_EQ(term.missing, MissingData::none);
  EXPECT_DOUBLE_EQ(term.nominal.reference_temperature, 23.0);
  Chain stated = test::er20();
  stated.reference_temperature = 20.0;
  EXPECT_DOUBLE_EQ(term_of(Term::thermal_expansion, stated, data).nominal.reference_temperature, 20.0);
  std::ranges::fill(data.temperature, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(term_of(Term::thermal_expansion, stated, data).missing, MissingData::temperature_range);
}

TEST(ModelTerms, GainsAndGearsAreThoseOfDrivenRevoluteJoints) {
  EXPECT_EQ(term_of(Term::gain, test::er20(), ten_rows()).parameters.size(), 6U);
  EXPECT_EQ(parameter_names_of(term_of(Term::gain, robot_with_slide(), ten_rows())),
            (std::vector<std::string>{"gain1", "gain2", "gain4", "gain5", "gain6"}));
  const ModelTerm gears = term_of(Term::gear_harmonics, robot_with_slide(), ten_rows());
  EXPECT_EQ(gears.parameters.size(), 5U * 2U * 2U) << "sine and cosine, once and twice per revolution";
  EXPECT_EQ(gears.nominal.joints[0].harmonics.size(), 2U);
  EXPECT_TRUE(gears.nominal.joints[2].harmonics.empty());
  EXPECT_EQ(term_of(Term::backlash, robot_with_slide(), ten_rows()).parameters.size(), 6U) << "slides have play, too";
}

TEST(ModelTerms, AHarmonicThatTheFileHasIsNotAddedTwice) {
  Chain nominal = test::er20();
  nominal.joints[1].harmonics = {{2.0, 1e-4, 0.0}};
  const ModelTerm gears = term_of(Term::gear_harmonics, nominal, ten_rows());
  EXPECT_EQ(gears.nominal.joints[1].harmonics.size(), 2U);
  EXPECT_EQ(gears.parameters.size(), 24U);
  EXPECT_EQ(gears.nominal.joints[1].harmonics[0].sine, 1e-4);
}

TEST(ModelTerms, AJointMayFollowTheTwoBeforeIt) {
  Chain nominal = test::er20();
  nominal.joints[2].couplings = {{1, -1.0}};
  const ModelTerm coupling = term_of(Term::coupling, nominal, ten_rows());
  EXPECT_EQ(parameter_names_of(coupling),
            (std::vector<std::string>{"coupling2_1", "coupling3_2", "coupling3_1", "coupling4_3", "coupling4_2",
                                      "coupling5_4", "coupling5_3", "coupling6_5", "coupling6_4"}));
  EXPECT_EQ(coupling.nominal.joints[2].couplings[0].factor, -1.0) << "the file's value stays";
  const ModelTerm slide = term_of(Term::coupling, robot_with_slide(), ten_rows());
  for (const std::string& parameter : parameter_names_of(slide))
    EXPECT_EQ(parameter.find('3'), std::string::npos) << parameter << ": slides are not coupled";
}

TEST(ModelTerms, MassesAreApproximateWhereNeitherFileNorRowsStateAny) {
  PoseSet data = ten_rows();
  EXPECT_TRUE(term_of(Term::gravity_compliance, test::er20(), data).masses_approximate);
  Chain with_mass = test::er20();
  with_mass.masses = {{.joint = 2, .com = Vec3(0.1, 0.0, 0.0), .mass = 12.0}};
  const ModelTerm stated = term_of(Term::gravity_compliance, with_mass, data);
  EXPECT_FALSE(stated.masses_approximate);
  EXPECT_EQ(stated.nominal.masses.size(), 1U);
  data.payload.assign(10, 0.0);
  EXPECT_TRUE(term_of(Term::gravity_compliance, test::er20(), data).masses_approximate);
  data.payload[3] = 5.0;
  EXPECT_FALSE(term_of(Term::gravity_compliance, test::er20(), data).masses_approximate);
}

TEST(ApproximateMasses, LieAtTheMiddleOfTheLinks) {
  const Chain chain = with_approximate_masses(test::er20());
  ASSERT_EQ(chain.masses.size(), 7U) << "six links and the tool";
  const PointMass& upper_arm = chain.masses[1];  // joint 2; joint 3 is a3 = 0.78227 m along its x
  EXPECT_EQ(upper_arm.joint, 1);
  EXPECT_NEAR(upper_arm.com.norm(), 0.5 * 0.78227, 1e-9);
  EXPECT_NEAR(upper_arm.mass, 15.0 * 0.78227, 1e-9);
  EXPECT_EQ(chain.masses[3].mass, 1.0) << "joint 5 lies in joint 4's frame: the least mass";
  EXPECT_EQ(chain.masses.back().mass, 2.0);
  EXPECT_EQ(chain.masses.back().joint, 5);
  for (const PointMass& mass : chain.masses) EXPECT_GT(mass.mass, 0.0);
}

HoldoutErrors errors_of_rows(std::vector<double> errors, const std::vector<int>& rows) {
  return {.split_fits = {}, .errors = std::move(errors), .row = rows, .pose = rows};
}

TEST(HoldoutErrors, AreSummedUpWithoutTheRowsInGrossError) {
  const HoldoutErrors all = errors_of_rows({1.0, 2.0, 9.0, 3.0}, {4, 7, 7, 1});
  EXPECT_EQ(statistics_without(all, {}).n, 4);
  const ErrorStatistics left = statistics_without(all, {{.row = 7}});
  EXPECT_EQ(left.n, 2) << "both measurements of the row";
  EXPECT_DOUBLE_EQ(left.mean, 2.0);
  EXPECT_TRUE(contains_row({{.row = 7}}, 7));
  EXPECT_FALSE(contains_row({{.row = 7}}, 4));
}

TEST(HoldoutErrors, AreComparedWithoutTheOutliersOfBothModels) {
  const HoldoutErrors before = errors_of_rows({1.0, 2.0, 50.0, 60.0}, {0, 1, 2, 3}),
                      after = errors_of_rows({0.5, 1.0, 40.0, 0.5}, {0, 1, 2, 3});
  const ErrorChange change = compare_holdout(before, {{.row = 2}, {.row = 3}}, after, {{.row = 2}});
  EXPECT_DOUBLE_EQ(change.mean_before, 21.0) << "row 3 is explained by the richer model, so it counts";
  EXPECT_DOUBLE_EQ(change.mean_after, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(change.worst_after, 1.0);
}

TEST(ExtrapolationSplits, DoNotDependOnJointUnitsAndIgnoreJointsAtRest) {
  PoseSet data;
  data.joints = MatrixXd::Zero(4, 60);
  Rng rng(2);
  for (int row = 0; row < 60; ++row)
    data.joints(0, row) = rng.normal(), data.joints(1, row) = 0.4 * data.joints(0, row) + 0.1 * rng.normal(),
                   data.joints(2, row) = rng.normal();
  const auto reference = extrapolation_splits(data);
  ASSERT_EQ(reference.size(), 4U);
  data.joints.row(0) *= 1e3;
  data.joints.row(2).array() += 50.0;
  const auto scaled = extrapolation_splits(data);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_TRUE(scaled[i].holdout == reference[i].holdout || scaled[i].holdout == reference[i ^ 1].holdout) << i;
}

}  // namespace
}  // namespace kinfer
