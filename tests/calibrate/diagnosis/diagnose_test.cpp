// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/diagnosis/diagnose.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "kinfer/calibrate/diagnosis/moving_points.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

Joint dh_joint(double a, double alpha_deg, double d, JointType type, int parent) {
  Joint joint;
  DhLink link;
  link.a = a, link.alpha = alpha_deg * degree, link.d = d;
  joint.link = link;
  joint.type = type;
  joint.parent = parent;
  joint.name = "J" + std::to_string(parent + 2);
  return joint;
}

Chain ur_like() {
  Chain chain;
  const auto r = JointType::revolute;
  chain.joints = {dh_joint(0, 90, 0.1273, r, -1),  dh_joint(-0.612, 0, 0, r, 0),   dh_joint(-0.5723, 0, 0, r, 1),
                  dh_joint(0, 90, 0.163941, r, 2), dh_joint(0, -90, 0.1157, r, 3), dh_joint(0, 0, 0.0922, r, 4)};
  chain.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.2}));
  chain.tool.xyz = {0.02, -0.015, 0.1};
  return chain;
}

Chain scara() {
  Chain chain;
  chain.joints = {dh_joint(0.4, 0, 0.35, JointType::revolute, -1), dh_joint(0.3, 180, 0, JointType::revolute, 0),
                  dh_joint(0, 0, 0, JointType::prismatic, 1), dh_joint(0, 0, 0, JointType::revolute, 2)};
  chain.tool.xyz = {0.06, 0.01, 0.03};
  return chain;
}

Chain arm6() {
  Chain chain = test::er20();
  chain.tool.xyz = {0.03, -0.02, 0.1};
  return chain;
}

/// A robot whose true numbers differ from the nominal ones by its tolerances, measured by a tracker.
CalibrationTask measured_robot(const Chain& nominal, int seed = 1, Measured what = Measured::positions) {
  const Chain truth = with_random_errors(nominal, {}, Rng(seed));
  const PoseSimulation simulation{.poses = 60, .space = {}, .instrument = test::tracker, .measured = what};
  return {.nominal = nominal,
          .tolerances = {},
          .instrument = test::tracker,
          .data = simulate_pose_set(truth, simulation, Rng(seed).stream(9)).value()};
}

std::string listed(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& f : findings) text += std::string(name(f.kind)) + ": " + words::sentence(f) + "\n";
  return text;
}

/// The only finding, which must be of the expected kind.
Finding only(const CalibrationTask& task, const std::string& kind) {
  const Diagnosis diagnosis = diagnose(task);
  EXPECT_EQ(diagnosis.findings.size(), 1u) << listed(diagnosis.findings);
  if (diagnosis.findings.empty()) return {};
  EXPECT_EQ(diagnosis.findings.front().kind, finding_kind(kind)) << listed(diagnosis.findings);
  return diagnosis.findings.front();
}

/// Noise level [m] of a fit to corrected data: about 20 µm where everything was corrected.
double noise_level(const CalibrationTask& corrected_task) {
  return fit_once(corrected_task, corrected_task.data, GeometricParameters{}, {}).value().sigma;
}

TEST(Diagnosis, FaultlessSetsHaveNoFinding) {
  for (const Chain& nominal : {arm6(), ur_like(), scara()})
    for (int seed = 1; seed <= 5; ++seed) {
      const Diagnosis diagnosis = diagnose(measured_robot(nominal, seed, Measured::poses));
      EXPECT_TRUE(diagnosis.findings.empty()) << seed << "\n" << listed(diagnosis.findings);
    }
}

/// A unit in which all points are small has small errors, too.
TEST(Diagnosis, PointsThatBelongToOtherPosesAreNotExplainedByAUnit) {
  for (const Chain& nominal : {arm6(), scara()})
    for (int seed = 1; seed <= 6; ++seed) {
      CalibrationTask task = measured_robot(nominal, seed);
      Rng rng(static_cast<std::uint64_t>(seed));
      for (std::size_t i = task.data.points.size() - 1; i > 0; --i)
        std::swap(task.data.points[i].position,
                  task.data.points[static_cast<std::size_t>(rng.uniform(0.0, static_cast<double>(i)))].position);
      for (const Finding& finding : diagnose(task).findings)
        EXPECT_FALSE(finding.applied) << seed << ": " << words::sentence(finding);
    }
}

TEST(Diagnosis, APointThatNeverMovesIsNoMeasurement) {
  CalibrationTask task = measured_robot(scara());
  EXPECT_TRUE(expect_moving_points(task));
  for (PointMeasurement& point : task.data.points) point.position = task.data.points.front().position;
  const auto refused = expect_moving_points(task);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("the measured points never move"), std::string::npos) << refused.error().what;
  // A tip that is held on one point does not move by the model either.
  task.data.joints.colwise() = VectorXd(task.data.joints.col(0));
  EXPECT_TRUE(expect_moving_points(task));
}

TEST(Diagnosis, ADistanceThatNeverChangesIsNoMeasurement) {
  CalibrationTask task = measured_robot(scara());
  task.nominal.fixtures.anchors = {Vec3(2.0, -1.0, 0.5)};
  for (const PointMeasurement& point : task.data.points)
    task.data.distances.push_back({.row = point.row, .anchor = 0, .distance = 1.0 + 0.01 * point.row});
  task.data.points.clear();
  EXPECT_TRUE(expect_moving_points(task));
  for (DistanceMeasurement& at : task.data.distances) at.distance = 1.5;
  EXPECT_NE(expect_moving_points(task).error().what.find("the measured distances never change"), std::string::npos);
}

TEST(Diagnosis, APointThatNeverMovesAlongOneDirectionIsNoMeasurement) {
  CalibrationTask task = measured_robot(scara());
  for (PointMeasurement& point : task.data.points) point.position.x() = 0.0;
  const auto refused = expect_moving_points(task);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("never move along one direction"), std::string::npos) << refused.error().what;
  // The joint that leads out of the plane is at rest: points in a plane are what the model predicts.
  task = measured_robot(scara());
  const Vec3 up = task.nominal.base.pose().rotation * Vec3::UnitZ();
  task.data.joints.row(2).setConstant(task.data.joints(2, 0));
  for (PointMeasurement& point : task.data.points)
    point.position -= up * up.dot(point.position - task.data.points.front().position);
  EXPECT_TRUE(expect_moving_points(task));
}

TEST(Diagnosis, ADirectionThatNeverChangesIsNoMeasurement) {
  CalibrationTask task = measured_robot(scara());
  task.data.stations = {"west"};
  for (const PointMeasurement& point : task.data.points)
    task.data.directions.push_back({point.row, 0, (point.position - Vec3(3.0, 1.0, 0.5)).normalized()});
  task.data.points.clear();
  EXPECT_TRUE(expect_moving_points(task));
  for (DirectionMeasurement& at : task.data.directions) at.direction = Vec3::UnitZ();
  EXPECT_NE(expect_moving_points(task).error().what.find("directions from station west never change"),
            std::string::npos);
}

TEST(Diagnosis, CommandedPositionsReplaceJointPositionsRecordedDuringMotion) {
  CalibrationTask task = measured_robot(arm6());
  task.data.commanded = task.data.joints;
  Rng rng(3);
  for (double& q : task.data.joints.reshaped()) q += 0.1 * degree * rng.normal();
  EXPECT_TRUE(only(task, "not_settled").applied);
  EXPECT_EQ(diagnose(task).corrected_task.data.joints, task.data.commanded);
}

TEST(Diagnosis, CommandedPositionsThatWereNotReachedAreNotUsed) {
  CalibrationTask task = measured_robot(arm6());
  task.data.commanded = task.data.joints;
  Rng rng(3);
  for (double& q : task.data.commanded.reshaped()) q += 0.02 * degree * rng.normal();
  EXPECT_TRUE(diagnose(task).findings.empty());
}

TEST(Diagnosis, RowsRecordedBeforeTheArmWasAtRestAreListed) {
  CalibrationTask task = measured_robot(arm6());
  task.data.commanded = task.data.joints;
  task.data.commanded.array() += 1e-4;
  task.data.commanded.col(7).array() += 0.01;
  EXPECT_EQ(only(task, "not_settled").rows, std::vector<int>{7});
}

PoseSet with_readings_shifted(PoseSet data, int from, int by) {
  const MatrixXd joints = data.joints;
  for (int row = from; row < data.rows(); ++row) {
    const int other = row - by;
    if (other >= from && other < data.rows()) data.joints.col(row) = joints.col(other);
  }
  return data;
}

class ShiftedRows : public ::testing::TestWithParam<std::pair<int, int>> {};  // from row, by

TEST_P(ShiftedRows, AreDetectedAndPairedAgain) {
  CalibrationTask task = measured_robot(arm6());
  const auto [from, by] = GetParam();
  const PoseSet right = task.data;
  task.data = with_readings_shifted(task.data, from, by);
  const Finding finding = only(task, "rows_shifted");
  EXPECT_TRUE(finding.applied);
  EXPECT_EQ(finding.rows.size(), static_cast<std::size_t>(60 - from - std::abs(by)));
  const PoseSet corrected_task = diagnose(task).corrected_task.data;
  for (const PointMeasurement& point : corrected_task.points)
    EXPECT_EQ(corrected_task.joints.col(point.row), right.joints.col(point.row)) << point.row;
  EXPECT_EQ(corrected_task.points.size(), right.points.size() - std::abs(by));
}
INSTANTIATE_TEST_SUITE_P(Diagnosis, ShiftedRows,
                         ::testing::Values(std::pair{0, 1}, std::pair{0, -2}, std::pair{0, 7}, std::pair{41, 1},
                                           std::pair{20, -1}),
                         [](const auto& test) {
                           return fmt::format("from_{}_by_{}{}", test.param.first,
                                              test.param.second < 0 ? "minus_" : "", std::abs(test.param.second));
                         });

TEST(Diagnosis, RowsWithoutAPartnerLoseTheirMeasurementsOfEveryKind) {
  CalibrationTask task = measured_robot(arm6());
  task.data = with_readings_shifted(task.data, 0, 1);
  task.data.stations = {"west"};
  for (int row = 0; row < task.data.rows(); ++row) task.data.directions.push_back({row, 0, Vec3::UnitX()});
  const PoseSet corrected = diagnose(task).corrected_task.data;
  EXPECT_EQ(corrected.points.size(), task.data.points.size() - 1);
  EXPECT_EQ(corrected.directions.size(), task.data.directions.size() - 1);
}

TEST(Diagnosis, SwappedRowsAreListedTogether) {
  CalibrationTask task = measured_robot(ur_like());
  std::swap(task.data.points[12].position, task.data.points[40].position);
  EXPECT_EQ(only(task, "rows_swapped").rows, (std::vector<int>{12, 40}));
}

TEST(Diagnosis, CopiedRowsAreListed) {
  CalibrationTask task = measured_robot(arm6());
  task.data.joints.col(31) = task.data.joints.col(5);
  task.data.points[31].position = task.data.points[5].position;
  EXPECT_EQ(only(task, "duplicate_rows").rows, (std::vector<int>{5, 31}));
}

TEST(Diagnosis, AMeasurementThatWasStoredTwiceIsListed) {
  CalibrationTask task = measured_robot(arm6());
  task.data.points[21].position = task.data.points[20].position;
  EXPECT_EQ(only(task, "measurement_repeated").rows, (std::vector<int>{20, 21}));
}

TEST(Diagnosis, ARepeatedPoseIsNoFault) {
  CalibrationTask task = measured_robot(arm6());
  task.data.joints.col(31) = task.data.joints.col(5);
  task.data.points[31].position = task.data.points[5].position + Vec3(8e-6, -5e-6, 3e-6);
  EXPECT_TRUE(diagnose(task).findings.empty());
}

TEST(Diagnosis, GrossOutliersAreListed) {
  CalibrationTask task = measured_robot(arm6());
  task.data.points[8].position.x() += 0.004;
  task.data.points[33].position.z() -= 0.3;
  EXPECT_EQ(only(task, "gross_outliers").rows, (std::vector<int>{8, 33}));
}

/// A fault of the file as a whole, which is certain and corrected.
struct Fault {
  std::string name, kind;
  std::function<void(CalibrationTask&)> make;
};
void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

void scale_points(CalibrationTask& task, double factor) {
  for (PointMeasurement& point : task.data.points) point.position *= factor;
}

std::vector<Fault> faults() {
  std::vector<Fault> list{
      {"degrees", "degrees_for_radians", [](CalibrationTask& t) { t.data.joints /= degree; }},
      {"radians", "radians_for_degrees", [](CalibrationTask& t) { t.data.joints *= degree; }},
      {"millimetres", "length_unit", [](CalibrationTask& t) { scale_points(t, 1e3); }},
      {"metres", "length_unit", [](CalibrationTask& t) { scale_points(t, 1e-3); }},
      {"swapped_columns", "columns_swapped",
       [](CalibrationTask& t) { t.data.joints.row(1).swap(t.data.joints.row(3)); }},
      {"parallel_linkage", "joint_coupled", [](CalibrationTask& t) { t.data.joints.row(2) += t.data.joints.row(1); }}};
  for (int k = 0; k < 6; ++k) {
    list.push_back(
        {fmt::format("sign_of_J{}", k + 1), "wrong_sign", [k](CalibrationTask& t) { t.data.joints.row(k) *= -1.0; }});
    if (k == 0 || k == 5) continue;  // absorbed by base and tool: no fault
    for (const int offset : {90, -90, 180})
      if (offset != 180 || (k != 1 && k != 4))  // equivalent to the sign of J1 and of J6
        list.push_back({fmt::format("offset_{}_of_J{}", offset < 0 ? "minus_90" : std::to_string(offset), k + 1),
                        "joint_offset",
                        [k, offset](CalibrationTask& t) { t.data.joints.row(k).array() += offset * degree; }});
  }
  return list;
}

class WholeFile : public ::testing::TestWithParam<Fault> {};

TEST_P(WholeFile, FaultIsTheOnlyFindingAndIsCorrected) {
  CalibrationTask task = measured_robot(ur_like(), 2);
  GetParam().make(task);
  const Diagnosis diagnosis = diagnose(task);
  ASSERT_EQ(diagnosis.findings.size(), 1u) << listed(diagnosis.findings);
  const Finding& finding = diagnosis.findings.front();
  EXPECT_EQ(name(finding.kind), GetParam().kind) << words::sentence(finding);
  EXPECT_TRUE(finding.applied);
  EXPECT_LT(noise_level(diagnosis.corrected_task), 5e-5) << words::sentence(finding);
}
INSTANTIATE_TEST_SUITE_P(Diagnosis, WholeFile, ::testing::ValuesIn(faults()),
                         [](const auto& test) { return test.param.name; });

TEST(Diagnosis, TwoWrongSignsAreFoundTogether) {
  CalibrationTask task = measured_robot(ur_like());
  task.data.joints.row(1) *= -1.0;
  task.data.joints.row(4) *= -1.0;
  const Diagnosis diagnosis = diagnose(task);
  EXPECT_EQ(diagnosis.findings.size(), 2u) << listed(diagnosis.findings);
  EXPECT_LT(noise_level(diagnosis.corrected_task), 5e-5);
}

TEST(Diagnosis, AMirroredMeasurementIsReportedAndNotCorrected) {
  CalibrationTask task = measured_robot(arm6());
  for (PointMeasurement& point : task.data.points) std::swap(point.position.x(), point.position.y());
  EXPECT_FALSE(only(task, "mirrored").applied);
}

TEST(Diagnosis, APrismaticJointInMillimetresIsFound) {
  CalibrationTask task = measured_robot(scara());
  task.data.joints.row(2) *= 1e3;
  EXPECT_EQ(words::sentence(only(task, "length_unit")), "J3 is in millimetres, but was read as metres");
}

class OrientationConventions : public ::testing::TestWithParam<int> {};

TEST_P(OrientationConventions, OtherThanTheDocumentedOneAreFoundAndConverted) {
  CalibrationTask task = measured_robot(arm6(), 1, Measured::poses);
  const std::vector<OrientationMeasurement> right = task.data.orientations;
  for (OrientationMeasurement& m : task.data.orientations) {
    const Quat q = m.orientation;
    if (GetParam() == 0) m.orientation = q.conjugate();
    if (GetParam() == 1) m.orientation = Quat(q.x(), q.y(), q.z(), q.w());  // x, y, z, w read as w, x, y, z
    if (GetParam() == 2) m.orientation = Quat(q.w(), q.x(), -q.y(), -q.z());
  }
  EXPECT_TRUE(only(task, "orientation_convention").applied);
  const PoseSet corrected_task = diagnose(task).corrected_task.data;
  for (std::size_t i = 0; i < right.size(); ++i)
    EXPECT_NEAR(std::abs(corrected_task.orientations[i].orientation.dot(right[i].orientation)), 1.0, 1e-9);
}
INSTANTIATE_TEST_SUITE_P(Diagnosis, OrientationConventions, ::testing::Range(0, 3));

/// The joints take up part of what the base does.
TEST(Diagnosis, ADriftingBaseIsDetectedWithItsSize) {
  CalibrationTask task = measured_robot(ur_like());
  for (PointMeasurement& point : task.data.points) point.position.x() += 0.4e-3 * point.row / 59.0;
  EXPECT_NEAR(only(task, "base_drifts").values.number("distance_m"), 0.4e-3, 0.1e-3);
}

TEST(Diagnosis, ASmallMoveOfTheBaseIsDetected) {
  CalibrationTask task = measured_robot(ur_like());
  for (PointMeasurement& point : task.data.points)
    if (point.row >= 30) point.position.y() += 0.3e-3;
  EXPECT_NEAR(only(task, "base_moved").values.number("distance_m"), 0.3e-3, 0.1e-3);
}

TEST(Diagnosis, ALargeMoveOfTheBaseIsDetectedWithItsRows) {
  CalibrationTask task = measured_robot(arm6());
  for (PointMeasurement& point : task.data.points)
    if (point.row >= 40) point.position += Vec3(0.1, -0.2, 0.05);
  const Finding finding = only(task, "base_moved");
  ASSERT_EQ(finding.rows.size(), 20u);
  EXPECT_EQ(finding.rows.front(), 40);
}

TEST(Diagnosis, AJointThatHardlyMovesIsNamed) {
  CalibrationTask task = measured_robot(arm6());
  const Chain truth = with_random_errors(task.nominal, {}, Rng(1));
  task.data.joints.row(3).setConstant(0.3);
  for (PointMeasurement& point : task.data.points)
    point.position = forward(truth, task.data.joints.col(point.row)).position;
  EXPECT_EQ(only(task, "joint_hardly_moves").values.text("joint"), "J4");
}

TEST(Diagnosis, ATargetThatSlippedIsDetectedInItsRows) {
  CalibrationTask task = measured_robot(arm6());
  const Chain truth = with_random_errors(task.nominal, {}, Rng(1));
  const Vec3 in_tool(0.1, 0.05, -0.02);
  task.nominal.targets = {{"s2", in_tool}};
  task.data.targets = {"s2"};
  Rng rng(5);
  for (int row = 0; row < 60; ++row) {
    const Vec3 noise = 1e-5 * normal_vector(rng);
    const Vec3 slip = row == 14 ? Vec3(0.003, 0.001, 0) : Vec3::Zero();
    task.data.points.push_back({.row = row,
                                .target = 0,
                                .position = forward(truth, task.data.joints.col(row)) * (in_tool + slip) + noise,
                                .sd = {}});
  }
  EXPECT_EQ(only(task, "not_rigid").rows, std::vector<int>{14});
}

TEST(Diagnosis, ASetThatIsTooSmallIsLeftUnchanged) {
  CalibrationTask task = measured_robot(arm6());
  task.data = select(task.data, {0, 1, 2});
  EXPECT_NO_FATAL_FAILURE(diagnose(task));
  task.data = select(task.data, {});
  EXPECT_TRUE(diagnose(task).findings.empty());
}

TEST(Diagnosis, AShiftDropsEveryMeasurementOfARowWithoutJointPositions) {
  CalibrationTask task = measured_robot(arm6());
  for (int row = 0; row < 60; ++row) task.data.tilts.push_back({row, Vec3(0, 0, 9.8)});
  task.data = with_readings_shifted(task.data, 0, 2);
  const PoseSet corrected = diagnose(task).corrected_task.data;
  EXPECT_EQ(corrected.points.size(), 58u);
  EXPECT_EQ(corrected.tilts.size(), 58u);
}

TEST(Diagnosis, ARobotFileInMillimetresReadAsMetresIsFound) {
  CalibrationTask task = measured_robot(arm6());
  for (Joint& joint : task.nominal.joints) {
    auto& link = std::get<MdhLink>(joint.link);
    link.a *= 1e3, link.d *= 1e3;
  }
  const Diagnosis diagnosis = diagnose(task);
  const auto at = std::ranges::find(diagnosis.findings, FindingKind::robot_length_unit, &Finding::kind);
  ASSERT_NE(at, diagnosis.findings.end()) << listed(diagnosis.findings);
  EXPECT_GT(at->values.number("reach_m"), 100.0);
  EXPECT_EQ(at->severity, Severity::fault);
}

TEST(Diagnosis, AStageOfTheSizeOfItsPointsIsNoFault) {
  CalibrationTask task = measured_robot(arm6());
  for (Joint& joint : task.nominal.joints) {
    auto& link = std::get<MdhLink>(joint.link);
    link.a *= 1e-4, link.d *= 1e-4;
  }
  task.nominal.tool.xyz *= 1e-4, task.nominal.base.xyz *= 1e-4;
  for (PointMeasurement& point : task.data.points) point.position *= 1e-4;
  task.data = select(task.data, {0, 1, 2, 3, 4, 5, 6});  // too few to see that they belong together
  const Diagnosis diagnosis = diagnose(task);
  const auto at = std::ranges::find(diagnosis.findings, FindingKind::robot_length_unit, &Finding::kind);
  ASSERT_NE(at, diagnosis.findings.end()) << listed(diagnosis.findings);
  EXPECT_EQ(at->severity, Severity::warning);
}

TEST(Diagnosis, JointPositionsBeyondTheLimitsAreNoted) {
  CalibrationTask task = measured_robot(arm6());
  const double largest = task.data.joints.row(1).maxCoeff();
  task.nominal.joints[1].upper = largest - 2.0 * degree;
  const Diagnosis diagnosis = diagnose(task);
  const auto at = std::ranges::find(diagnosis.findings, FindingKind::outside_limits, &Finding::kind);
  ASSERT_NE(at, diagnosis.findings.end()) << listed(diagnosis.findings);
  EXPECT_EQ(at->values.text("joint"), "J2");
  for (const int row : at->rows) EXPECT_GT(task.data.joints(1, row), largest - 1.0 * degree);
}

}  // namespace
}  // namespace kinfer
