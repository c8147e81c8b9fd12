// SPDX-License-Identifier: Apache-2.0
// Measurements that contradict each other, or the joints, do not become a verdict of use.
#include <gtest/gtest.h>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/validation/kind_errors.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "support/instruments.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

using namespace test;

constexpr Instrument stated{.sigma = 10e-6};  // and nothing of angles

PoseSet points_of(const Chain& truth, int poses) {
  PoseSet set = measured(truth, paper2_poses(poses, stated));
  set.orientations.clear();
  return set;
}

Result<Calibration> calibrated_freely(const PoseSet& data, const Instrument& instrument = stated,
                                      const CalibrationOptions& options = {.model = FixedModel{}}) {
  return calibrate_robot({nominal_robot(), {}, instrument, data}, options, Rng(1));
}

Chain robot_with_errors(int seed = 1) {
  return with_random_errors(nominal_robot(), {}, Rng(seed));
}

void expect_contradiction(const PoseSet& data, MeasurementKind kind) {
  const Calibration c = calibrated_freely(data).value();
  EXPECT_EQ(c.usability, Usability::do_not_use) << words::verdict(c);
  ASSERT_EQ(c.reason, CalibrationReason::contradictory) << words::verdict(c);
  EXPECT_EQ(c.contradiction->kind, kind);
}

TEST(Contradictions, PairsOfALengthThatThePointsDenyAreNamed) {
  PoseSet data = points_of(robot_with_errors(), 30);
  for (int row = 0; row + 1 < data.rows(); row += 2) data.pairs.push_back({row, row + 1, 0.5});
  expect_contradiction(data, kind_of<PairDistance>);
  EXPECT_NE(words::verdict(*calibrated_freely(data)).find("15 of 15 pairwise distances"), std::string::npos)
      << words::verdict(*calibrated_freely(data));
}

TEST(Contradictions, RandomPosesInOneSocketAreNamed) {
  PoseSet data = points_of(robot_with_errors(), 30);
  data.sockets = {"a"};
  for (int row = 0; row < data.rows(); ++row) data.contacts.push_back({row, 0});
  expect_contradiction(data, kind_of<SocketContact>);
}

TEST(Contradictions, RandomTiltsWhoseNoiseIsNotStatedAreNamed) {
  PoseSet data = points_of(robot_with_errors(), 30);
  Rng rng(5);
  for (int row = 0; row < data.rows(); ++row) data.tilts.push_back({row, 9.8 * random_vector(rng).normalized()});
  expect_contradiction(data, kind_of<TiltMeasurement>);
}

TEST(Contradictions, MirroredDirectionsBesidePointsAreOfNoUse) {
  PoseSet data = points_of(robot_with_errors(), 30);
  data.stations = {"west"};
  const Vec3 station(2.6, -1.8, 0.9);
  for (int row = 0; row < data.rows(); ++row) {
    Vec3 seen = (data.points[row].position - station).normalized();
    seen.y() *= -1.0;
    data.directions.push_back({row, 0, seen});
  }
  const Result<Calibration> c = calibrated_freely(data);
  EXPECT_TRUE(!c || c->usability == Usability::do_not_use) << words::verdict(*c);
}

TEST(Contradictions, AKindWithAFewGrossErrorsOrRoughNoiseIsNone) {
  for (const int seed : {1, 2, 3}) {
    const Chain truth = robot_with_errors(seed);
    PoseSet data = points_of(truth, 30);
    measure_pairs(data, truth, 10e-6, Rng(seed));
    for (int i = 0; i < 3; ++i) data.pairs[i].distance += 0.1;
    measure_tilts(data, truth, 0.2, Rng(seed + 10));  // 1.2 deg
    const Calibration c = calibrated_freely(data).value();
    EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
    EXPECT_FALSE(c.contradiction);
  }
}

TEST(Contradictions, RandomPosesInOneSocketAloneMakeNoRobot) {
  PoseSet data = readings_of(points_of(robot_with_errors(), 40));
  data.sockets = {"a"};
  for (int row = 0; row < data.rows(); ++row) data.contacts.push_back({row, 0});
  const Calibration c = calibrated_freely(data).value();
  EXPECT_EQ(c.usability, Usability::do_not_use) << words::verdict(c);
}

TEST(Contradictions, TheErrorOfATiltIsAnAngleAndNotItsSine) {
  const Chain chain = nominal_robot();
  PoseSet data = readings_of(points_of(chain, 4));
  measure_tilts(data, chain, 0.0, Rng(1));
  const Vec3 up = data.tilts[0].specific_force, across = any_perpendicular(up.normalized());
  for (const double angle : {0.3, 1.2, 2.5}) {
    data.tilts[0].specific_force = exp_so3(angle * across) * up;
    EXPECT_NEAR(errors_of_kind(kind_of<TiltMeasurement>, chain, data)[0], angle, 1e-9);
  }
}

TEST(Contradictions, AnAccelerometerOfTheOtherSignIsNone) {
  const Chain truth = robot_with_errors();
  PoseSet data = points_of(truth, 30);
  measure_tilts(data, truth, 0.02, Rng(4));
  for (TiltMeasurement& tilt : data.tilts) tilt.specific_force *= -1.0;
  const Calibration c = calibrated_freely(data).value();
  EXPECT_EQ(c.usability, Usability::use) << words::verdict(c);
  EXPECT_LT(c.after.orientation.holdout.mean, 1.0 * degree);
}

TEST(Copies, TenCopiesOfSixPosesSayWhatTheSixSay) {
  const PoseSet six = points_of(robot_with_errors(), 8);
  std::vector<int> rows;
  for (int row = 0; row < 80; ++row) rows.push_back(row % 8);
  const Calibration once = calibrated_freely(six, stated, {}).value(),
                    copied = calibrated_freely(select(six, rows), stated, {}).value();
  EXPECT_EQ(selected_model(copied.model_selection), selected_model(once.model_selection));
  EXPECT_EQ(copied.estimate.values.size(), once.estimate.values.size());
  EXPECT_NEAR(copied.estimate.predicted_error, once.estimate.predicted_error, 0.1 * once.estimate.predicted_error);
}

TEST(Copies, HeldOutCopiesOfFittedRowsProveNothing) {
  const PoseSet fitted = points_of(robot_with_errors(), 20);
  std::vector<int> rows;
  for (int row = 0; row < 30; ++row) rows.push_back(row % 20);
  PoseSet data = select(fitted, rows);
  data.set.assign(20, SplitLabel::train);
  data.set.resize(30, SplitLabel::holdout);
  const Result<Calibration> c = calibrated_freely(data, stated, {.holdout = HeldOutByLabel{}, .model = FixedModel{}});
  ASSERT_FALSE(c.has_value());
  EXPECT_NE(c.error().what.find("copy of a fitted row"), std::string::npos) << c.error().what;
}

TEST(Directions, OfUnstatedNoiseAreNotTakenForExact) {
  Chain truth = robot_with_errors(3);
  truth.fixtures.stations = {{"west", Frame::from_pose(Pose::from_xyz_rpy({2.6, -1.8, 0.9}, {0.02, -0.01, 2.4}))}};
  PoseSet data = points_of(truth, 40);
  const std::vector<Pose> at = true_poses(truth, data);
  data.points.clear();
  data.stations = {"west"};
  Rng rng(17);
  for (int row = 0; row < data.rows(); ++row) {
    const Vec3 sight = truth.fixtures.stations[0].frame.pose().inverse() * at[row].position;
    data.directions.push_back({row, 0, (sight.normalized() + noise(rng, 1e-5)).normalized()});
  }
  const Calibration c = calibrated_freely(data, {.sigma = 1e-5}).value();
  EXPECT_NE(c.usability, Usability::do_not_use) << words::verdict(c);
  EXPECT_GT(*c.noise_holdout_rms, 1e-5);
}

}  // namespace
}  // namespace kinfer
