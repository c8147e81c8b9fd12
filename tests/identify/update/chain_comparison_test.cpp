// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/chain_comparison.hpp"

#include <gtest/gtest.h>

#include "identify/update/known_model.hpp"
#include "kinfer/base/angle.hpp"
#include "kinfer/identify/update/combined_model.hpp"

namespace kinfer {
using namespace identify;
namespace {

using Eigen::Index;

ChainCause cause_of(const TrackingModel& model, const std::string& name, const std::string& segment) {
  for (const ChainCause& cause : possible_causes(model))
    if (cause.name == name && cause.segment == segment) return cause;
  ADD_FAILURE() << name;
  return {};
}

TEST(ChainComparison, FindsNothingOnTheSameMachine) {
  int changes = 0;
  double squares = 0.0, freedom = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const TrackingModel truth = test::known_model(test::every_joint_type(), seed);
    const ChainUpdate update =
        compare_chains(test::identified_again(truth, 1.0, 100 + seed), test::identified_again(truth, 1.5, 200 + seed))
            .update;
    changes += static_cast<int>(update.changes.size());
    squares += update.squared_distance;
    freedom += update.freedom;
  }
  EXPECT_EQ(changes, 0);
  EXPECT_NEAR(squares / freedom, 1.0, 0.2) << "the covariance is that of the differences";
}

TEST(ChainComparison, NamesTheSensorThatWasMovedWithItsSize) {
  const TrackingModel truth = test::known_model(test::every_joint_type(), 7);
  for (const double angle : {1.0 * degree, 40.0 * degree})
    for (const std::string name : {"ins0", "ins1", "ins3", "ins5", "ins6"}) {
      VectorXd size = VectorXd::Zero(6);
      size.head<3>() = angle * Vec3(1.0, -2.0, 2.0) / 3.0;
      size.tail<3>() << 0.01, 0.0, -0.02;
      const ChainComparison found =
          compare_chains(test::identified_again(truth, 1.0, 1),
                         test::identified_again(changed(truth, cause_of(truth, name, name), size), 1.0, 2));
      ASSERT_EQ(found.update.changes.size(), 1u) << name << " by " << angle;
      const ChainChange& change = found.update.changes.front();
      EXPECT_EQ(change.kind, ChainChangeKind::sensor_moved);
      EXPECT_EQ(change.name, name);
      if (change.angle) EXPECT_NEAR(change.angle->value, angle, 3.5 * change.angle->sd) << name;
      if (change.distance) EXPECT_NEAR(change.distance->value, std::sqrt(5e-4), 3.5 * change.distance->sd) << name;
      EXPECT_FALSE(found.update.is_other_machine);
      EXPECT_LT(found.update.squared_distance, 1.6 * found.update.freedom) << "the change explains the difference";
    }
}

TEST(ChainComparison, NamesTheJointThatMovedOnItsSegment) {
  const TrackingModel truth = test::known_model(test::arm(), 7);
  VectorXd size = VectorXd::Zero(5);
  size[2] = 0.02;
  const ChainUpdate update =
      compare_chains(test::identified_again(truth, 1.0, 1),
                     test::identified_again(changed(truth, cause_of(truth, "ins1-ins2", "ins1"), size), 1.0, 2))
          .update;
  ASSERT_EQ(update.changes.size(), 1u);
  EXPECT_EQ(update.changes.front().kind, ChainChangeKind::joint_moved);
  EXPECT_EQ(update.changes.front().name, "ins1-ins2");
  EXPECT_EQ(update.changes.front().segment, "ins1");
  ASSERT_TRUE(update.changes.front().distance);
  EXPECT_NEAR(update.changes.front().distance->value, 0.02, 3.5 * update.changes.front().distance->sd);
}

TEST(ChainComparison, CallsAnotherMachineAnotherMachine) {
  const ChainUpdate update =
      compare_chains(test::known_model(test::arm(), 7), test::known_model(test::arm(), 8)).update;
  EXPECT_TRUE(update.is_other_machine);
}

/// The model with a diagonal covariance of one variance per kind of parameter.
TrackingModel with_variance(TrackingModel model, double variance) {
  model.covariance = variance * MatrixXd::Identity(model.covariance.rows(), model.covariance.cols());
  return model;
}

TEST(CombinedModel, WeighsBothLogsByTheirInformation) {
  TrackingModel known = with_variance(test::known_model(test::arm(), 3), 1e-6), fresh = with_variance(known, 4e-6);
  const TrackingParameter moved{TrackingParameterKind::parent_rotation, 2, 0};
  BodyDifference step = BodyDifference::Zero();
  step[0] = 1e-4;
  fresh.bodies[2] = retracted(fresh.bodies[2], step);
  fresh.sensors[1].accelerometer_scale(0, 0) = 1e-4;
  fresh.sensors[1].gyroscope_bias[2] = 3e-4;
  const ChainComparison same{.update = {}, .causes = {}, .moved = known};
  const TrackingModel both = combined(same, fresh);
  const auto row = std::ranges::find(both.parameters, moved) - both.parameters.begin();
  EXPECT_NEAR(both.covariance(row, row), 1.0 / (1e6 + 0.25e6 - 1.0), 1e-12) << "the prior, 1 rad, counts once";
  EXPECT_NEAR(difference(known.bodies[2], both.bodies[2])[0], 1e-4 * 0.25 / 1.25, 1e-8);
  EXPECT_NEAR(both.sensors[1].accelerometer_scale(0, 0), 1e-4 * 0.25 / (1.25 - 0.01), 1e-8) << "prior: 1 %";
  EXPECT_NEAR(both.sensors[1].gyroscope_bias[2], 3e-4, 1e-8) << "biases are those of the newer log";
}

TEST(CombinedModel, ForgetsWhatChanged) {
  const TrackingModel truth = test::known_model(test::arm(), 7);
  VectorXd size = VectorXd::Zero(6);
  size << 0.02, 0.0, 0.0, 0.0, 0.03, 0.0;
  const TrackingModel known = test::identified_again(truth, 1.0, 1),
                      fresh = test::identified_again(changed(truth, cause_of(truth, "ins2", "ins2"), size), 1.0, 2);
  const ChainComparison comparison = compare_chains(known, fresh);
  ASSERT_EQ(comparison.causes.size(), 1u);
  const TrackingModel both = combined(comparison, fresh), right = aligned_model(fresh, both);
  const auto trace = [](const TrackingModel& model, int body, TrackingParameterKind kind) {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      const TrackingParameter& p = model.parameters[i];
      if (p.index == body && p.kind == kind && p.component < 2)
        sum += model.covariance(static_cast<Index>(i), static_cast<Index>(i));
    }
    return sum;
  };
  using Kind = TrackingParameterKind;
  EXPECT_LT(trace(both, 1, Kind::child_rotation), 0.7 * trace(right, 1, Kind::child_rotation)) << "not touched";
  EXPECT_LT(trace(both, 4, Kind::child_rotation), 0.7 * trace(right, 4, Kind::child_rotation)) << "not touched";
  EXPECT_GT(trace(both, 2, Kind::child_rotation), 0.7 * trace(right, 2, Kind::child_rotation)) << "moved";
}

TEST(CombinedModel, HoldsTheTruthInItsIntervals) {
  double squares = 0.0, freedom = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TrackingModel truth = test::known_model(test::every_joint_type(), seed),
                        fresh = test::identified_again(truth, 1.0, 300 + seed);
    const ChainComparison comparison = compare_chains(test::identified_again(truth, 1.0, 400 + seed), fresh);
    const TrackingModel both = combined(comparison, fresh);
    const GeometryDifference error = geometry_difference(both, with_variance(truth, 0.0));
    squares += squared_distance(error.value, error.covariance);
    freedom += static_cast<double>(error.value.size());
  }
  EXPECT_NEAR(squares / freedom, 1.0, 0.15);
}

}  // namespace
}  // namespace kinfer
