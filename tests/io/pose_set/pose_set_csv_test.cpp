// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_set_csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"

namespace kinfer {
namespace {

/// A revolute and a prismatic joint, with a further target on the tool.
Chain two_joints() {
  Chain chain;
  chain.joints.resize(2);
  chain.joints[0].name = "pan";
  chain.joints[1].name = "slide";
  chain.joints[1].parent = 0;
  chain.joints[1].type = JointType::prismatic;
  chain.targets.push_back({"s2", Vec3(0.01, 0, 0)});
  return chain;
}

PoseSet poses_of(const std::string& text, const ColumnMap& map = {},
                 RequiredContent expect = RequiredContent::measurements) {
  const Result<PoseSet> set = parse_pose_set(text, "poses.csv", two_joints(), map, expect);
  EXPECT_TRUE(set.has_value()) << (set ? "" : set.error().what);
  return set.value_or(PoseSet{});
}

std::string complaint_about(const std::string& text, const ColumnMap& map = {}) {
  const Result<PoseSet> set = parse_pose_set(text, "poses.csv", two_joints(), map);
  return set ? "(accepted)" : set.error().what;
}

TEST(PoseSetCsv, UnitsOfTheHeaderAreConvertedOnce) {
  const PoseSet set = poses_of("q1[deg],q2[mm],x[mm],y[mm],z[mm],temperature[K]\n90,250,1000,-2000,3,293.15\n");
  EXPECT_DOUBLE_EQ(set.joints(0, 0), 90 * degree);
  EXPECT_DOUBLE_EQ(set.joints(1, 0), 0.25);
  ASSERT_EQ(set.points.size(), 1U);
  EXPECT_TRUE(set.points[0].position.isApprox(Vec3(1, -2, 0.003)));
  EXPECT_NEAR(set.temperature[0], 20.0, 1e-12);
}

TEST(PoseSetCsv, WithoutBracketsEverythingIsSi) {
  const PoseSet set = poses_of("q1,q2,x,y,z\n1.5,0.25,1,-2,3e-3\n");
  EXPECT_EQ(set.joints(0, 0), 1.5);
  EXPECT_EQ(set.joints(1, 0), 0.25);
  EXPECT_EQ(set.points[0].position, Vec3(1, -2, 3e-3));
}

TEST(PoseSetCsv, JointColumnsMayBeNamedAndStandInAnyOrder) {
  const PoseSet set = poses_of("x,y,z,q_slide[mm],q1\n1,2,3,40,0.5\n");
  EXPECT_EQ(set.joints(0, 0), 0.5);
  EXPECT_DOUBLE_EQ(set.joints(1, 0), 0.04);
  EXPECT_EQ(set.joint_names, (std::vector<std::string>{"pan", "slide"}));
}

TEST(PoseSetCsv, AnEmptyCellIsNoMeasurement) {
  const PoseSet set = poses_of("q1,q2,x,y,z\n0,0,1,2,3\n0,0,,,\n0,0,4,5,6\n");
  EXPECT_EQ(set.rows(), 3);
  ASSERT_EQ(set.points.size(), 2U);
  EXPECT_EQ(set.points[1].row, 2);
}

TEST(PoseSetCsv, CommentsEmptyLinesCarriageReturnsByteOrderMarksAndQuotesAreHandled) {
  const PoseSet set = poses_of(
      "\xEF\xBB\xBF# measured on Monday\r\nq1,q2,x,y,z,\"id\"\r\n\r\n0,0,1,2,3,\"the \"\"first\"\", again\"\r\n# "
      "pause\r\n0, 0, +4 ,\"5\",6,b\r\n");
  EXPECT_EQ(set.rows(), 2);
  EXPECT_EQ(set.id, (std::vector<std::string>{"the \"first\", again", "b"}));
  EXPECT_EQ(set.line, (std::vector<int>{4, 6}));
  EXPECT_EQ(set.points[1].position, Vec3(4, 5, 6));
}

TEST(PoseSetCsv, AQuaternionIsScalarFirstAndNormalised) {
  const PoseSet set = poses_of("q1,q2,x,y,z,qw,qx,qy,qz\n0,0,1,2,3,0.7072,0,0,0.7072\n0,0,1,2,3,,,,\n");
  ASSERT_EQ(set.orientations.size(), 1U);
  EXPECT_TRUE(set.orientations[0].orientation.toRotationMatrix().isApprox(rot_z(90 * degree), 1e-12));
}

TEST(PoseSetCsv, EveryKindOfMeasurementFindsItsList) {
  const PoseSet set = poses_of(
      "q1,q2,x,y,z,sx,sy,sz,s2_x,s2_y,s2_z,anchor,pair,distance,socket,plane,tilt_x[g],tilt_y[g],tilt_z[g]\n"
      "0,0,1,2,3,0.1,0.2,0.3,,,,,,,,,,,\n"
      "0,0,,,,,,,4,5,6,,,,,,,,\n"
      "0,0,,,,,,,,,,2,,1.5,,,,,\n"
      "0,0,,,,,,,,,,,bar,0.8,,,,,\n"
      "0,0,,,,,,,,,,,bar,,,,,,\n"
      "0,0,,,,,,,,,,,,,left,,,,\n"
      "0,0,,,,,,,,,,,,,,table,,,\n"
      "0,0,,,,,,,,,,,,,,,0,0,1\n");
  ASSERT_EQ(set.points.size(), 2U);
  EXPECT_EQ(*set.points[0].sd, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(set.points[1].target, 0);
  EXPECT_EQ(set.targets, std::vector<std::string>{"s2"});
  ASSERT_EQ(set.distances.size(), 1U);
  EXPECT_EQ(set.distances[0].anchor, 1) << "files count anchors from 1";
  EXPECT_EQ(set.distances[0].distance, 1.5);
  ASSERT_EQ(set.pairs.size(), 1U);
  EXPECT_EQ(set.pairs[0].row, 3);
  EXPECT_EQ(set.pairs[0].other, 4);
  EXPECT_EQ(set.pairs[0].distance, 0.8);
  ASSERT_EQ(set.contacts.size(), 1U);
  EXPECT_EQ(set.sockets[set.contacts[0].socket], "left");
  ASSERT_EQ(set.plane_contacts.size(), 1U);
  EXPECT_EQ(set.planes[set.plane_contacts[0].plane], "table");
  ASSERT_EQ(set.tilts.size(), 1U);
  EXPECT_TRUE(set.tilts[0].specific_force.isApprox(Vec3(0, 0, 9.80665)));
}

constexpr const char* with_covariances =
    "q1,q2,x[mm],y[mm],z[mm],p_cov_xx[mm^2],p_cov_xy[mm^2],p_cov_xz[mm^2],p_cov_yy[mm^2],p_cov_yz[mm^2],p_cov_zz[mm^2],"
    "qw,qx,qy,qz,r_cov_xx[mrad^2],r_cov_xy[mrad^2],r_cov_xz[mrad^2],r_cov_yy[mrad^2],r_cov_yz[mrad^2],r_cov_zz[mrad^2],"
    "s2_x,s2_y,s2_z,s2_cov_xx,s2_cov_xy,s2_cov_xz,s2_cov_yy,s2_cov_yz,s2_cov_zz\n"
    "0,0,1,2,3,4,1,0,9,-2,1,1,0,0,0,1,0.5,0,1,0,0,7,8,9,1,0,0,2,0,3\n"
    "0,0,1,2,3,,,,,,,1,0,0,0,,,,,,,,,,,,,,,\n";

TEST(PoseSetCsv, ACovarianceIsKeptAsDeviationsAlongItsAxes) {
  const PoseSet set = poses_of(with_covariances);
  ASSERT_EQ(set.points.size(), 3U);
  const Mat3 point = 1e-6 * (Mat3() << 4, 1, 0, 1, 9, -2, 0, -2, 1).finished();
  EXPECT_TRUE(covariance_of(*set.points[0].sd, set.points[0].axes).isApprox(point, 1e-12));
  EXPECT_FALSE(set.points[1].sd) << "empty cells: the instrument's word";
  EXPECT_TRUE(set.points[2].sd->cwiseAbs2().isApprox(Vec3(1, 2, 3), 1e-12));
  const Mat3 turn = 1e-6 * (Mat3() << 1, 0.5, 0, 0.5, 1, 0, 0, 0, 0).finished();
  EXPECT_TRUE(covariance_of(*set.orientations[0].sd, set.orientations[0].axes).isApprox(turn, 1e-12));
  for (const FileUnits units : {FileUnits::si, FileUnits::mm_deg}) {
    const PoseSet again = poses_of(format_pose_set_csv(set, two_joints(), units));
    ASSERT_EQ(again.points.size(), 3U);
    EXPECT_TRUE(covariance_of(*again.points[0].sd, again.points[0].axes).isApprox(point, 1e-9));
    EXPECT_TRUE(covariance_of(*again.orientations[0].sd, again.orientations[0].axes).isApprox(turn, 1e-9));
    EXPECT_FALSE(again.points[1].sd);
  }
}

TEST(PoseSetCsv, AnInvalidCovarianceIsRefusedWithItsLine) {
  const auto expect_error = [](const std::string& text, const std::string& words) {
    EXPECT_NE(complaint_about(text).find(words), std::string::npos) << complaint_about(text);
  };
  const std::string names = "p_cov_xx,p_cov_xy,p_cov_xz,p_cov_yy,p_cov_yz,p_cov_zz";
  expect_error("q1,q2,x,y,z," + names + "\n0,0,1,2,3,1,2,0,1,0,1\n", "negative variance");
  expect_error("q1,q2,x,y,z," + names + "\n0,0,1,2,3,1,,0,1,0,1\n", "expected six numbers or none of them, found 5");
  expect_error("q1,q2,x,y,z,sx,sy,sz," + names + "\n0,0,1,2,3,1,1,1,1,0,0,1,0,1\n", "expected one of both");
  expect_error("q1,q2,x,y,z,p_cov_xx\n0,0,1,2,3,1\n", "column p_cov_xy is missing");
  expect_error("q1,q2,x,y,z,p_cov_xx[mm],p_cov_xy,p_cov_xz,p_cov_yy,p_cov_yz,p_cov_zz\n0,0,1,2,3,1,0,0,1,0,1\n",
               "expected a variance of lengths");
}

constexpr const char* cross_columns =
    "pr_cov_xx[mm.mrad],pr_cov_xy[mm.mrad],pr_cov_xz[mm.mrad],pr_cov_yx[mm.mrad],pr_cov_yy[mm.mrad],pr_cov_yz[mm.mrad],"
    "pr_cov_zx[mm.mrad],pr_cov_zy[mm.mrad],pr_cov_zz[mm.mrad]";

TEST(PoseSetCsv, TheCrossCovarianceOfPointAndOrientationIsReadAndWritten) {
  const std::string text =
      std::string("q1,q2,x,y,z,sx[mm],sy[mm],sz[mm],qw,qx,qy,qz,srx[mrad],sry[mrad],srz[mrad],") + cross_columns +
      "\n0,0,1,2,3,1,2,3,1,0,0,0,4,5,6,1,2,-1,0.5,3,-2,0,1,2\n0,0,1,2,3,1,2,3,1,0,0,0,4,5,6,,,,,,,,,\n";
  const PoseSet set = poses_of(text);
  ASSERT_EQ(set.orientations.size(), 2U);
  const Mat3 expected = 1e-6 * (Mat3() << 1, 2, -1, 0.5, 3, -2, 0, 1, 2).finished();  // rows: the point's axes
  EXPECT_TRUE(set.orientations[0].covariance_with_point->isApprox(expected, 1e-12));
  EXPECT_FALSE(set.orientations[1].covariance_with_point);
  for (const FileUnits units : {FileUnits::si, FileUnits::mm_deg}) {
    const PoseSet again = poses_of(format_pose_set_csv(set, two_joints(), units));
    ASSERT_EQ(again.orientations.size(), 2U);
    EXPECT_TRUE(again.orientations[0].covariance_with_point->isApprox(expected, 1e-9));
    EXPECT_FALSE(again.orientations[1].covariance_with_point);
  }
}

TEST(PoseSetCsv, ACovarianceOfAPoseThatIsNotPositiveDefiniteIsRefusedWithItsLine) {
  const std::string header =
      std::string("q1,q2,x,y,z,sx[mm],sy[mm],sz[mm],qw,qx,qy,qz,srx[mrad],sry[mrad],srz[mrad],") + cross_columns + "\n";
  const std::string row = "0,0,1,2,3,1,2,3,1,0,0,0,4,5,6,";
  const auto complaint = [&](const std::string& cells) { return complaint_about(header + cells + "\n"); };
  EXPECT_EQ(complaint(row + "4.1,0,0,0,0,0,0,0,0"),
            "poses.csv:2: pr_cov_xx to pr_cov_zz: with p_cov and r_cov of the row, expected a positive definite 6 x 6 "
            "covariance of the pose");
  EXPECT_EQ(complaint(row + "3.9,0,0,0,0,0,0,0,0"), "(accepted)");
  EXPECT_EQ(complaint(row + "1,0,0,0,,0,0,0,0"),
            "poses.csv:2: pr_cov_xx to pr_cov_zz: expected nine numbers or none of them, found 8");
  const std::string lonely = "pr_cov_xx to pr_cov_zz: expected a position and an orientation beside it, both with";
  EXPECT_NE(complaint("0,0,1,2,3,,,,1,0,0,0,4,5,6,1,0,0,0,0,0,0,0,0").find(lonely), std::string::npos);
  EXPECT_NE(complaint("0,0,1,2,3,1,2,3,1,0,0,0,,,,1,0,0,0,0,0,0,0,0").find(lonely), std::string::npos);
  EXPECT_NE(complaint("0,0,1,2,3,1,2,3,,,,,,,,1,0,0,0,0,0,0,0,0").find("expected an orientation beside it"),
            std::string::npos);
  EXPECT_NE(complaint_about("q1,q2,x,y,z,qw,qx,qy,qz,pr_cov_xy\n0,0,1,2,3,1,0,0,0,1\n").find("pr_cov_xx is missing"),
            std::string::npos);
}

TEST(PoseSetCsv, RowsMayHaveLoadsLabelsSetupsSweepsTorquesAndCommands) {
  const PoseSet set = poses_of(
      "q1,q2,x,y,z,payload[kg],set,setup,sweep,tau1,tau2,q1_cmd[deg],q2_cmd[mm]\n"
      "0,0,1,2,3,5,train,A,,0.1,0.2,1,2\n"
      "0,0,1,2,3,,holdout,B,pan,,0.4,3,4\n");
  EXPECT_EQ(set.payload, (std::vector<double>{5, 0}));
  EXPECT_EQ(set.set, (std::vector{SplitLabel::train, SplitLabel::holdout}));
  EXPECT_EQ(set.setup, (std::vector<int>{0, 1}));
  EXPECT_EQ(set.setups, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(set.sweep, (std::vector<int>{-1, 0}));
  EXPECT_EQ(set.torques(1, 1), 0.4);
  EXPECT_TRUE(std::isnan(set.torques(0, 1)));
  EXPECT_DOUBLE_EQ(set.commanded(0, 1), 3 * degree);
  EXPECT_DOUBLE_EQ(set.commanded(1, 1), 4e-3);
}

void expect_same(const PoseSet& a, const PoseSet& b) {
  EXPECT_TRUE(a.joints.isApprox(b.joints, 1e-15));
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].row, b.points[i].row);
    EXPECT_EQ(a.points[i].target, b.points[i].target);
    EXPECT_TRUE(a.points[i].position.isApprox(b.points[i].position, 1e-15));
    EXPECT_EQ(a.points[i].sd.has_value(), b.points[i].sd.has_value());
  }
  ASSERT_EQ(a.orientations.size(), b.orientations.size());
  for (std::size_t i = 0; i < a.orientations.size(); ++i)
    EXPECT_TRUE(a.orientations[i].orientation.isApprox(b.orientations[i].orientation, 1e-15));
  ASSERT_EQ(a.distances.size(), b.distances.size());
  for (std::size_t i = 0; i < a.distances.size(); ++i) {
    EXPECT_EQ(a.distances[i].anchor, b.distances[i].anchor);
    EXPECT_DOUBLE_EQ(a.distances[i].distance, b.distances[i].distance);
  }
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t i = 0; i < a.pairs.size(); ++i) EXPECT_EQ(a.pairs[i].other, b.pairs[i].other);
  EXPECT_EQ(a.contacts.size(), b.contacts.size());
  EXPECT_EQ(a.plane_contacts.size(), b.plane_contacts.size());
  EXPECT_EQ(a.tilts.size(), b.tilts.size());
  EXPECT_EQ(a.payload, b.payload);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.set, b.set);
  EXPECT_EQ(a.setup, b.setup);
  EXPECT_EQ(a.sweep, b.sweep);
  EXPECT_EQ(a.torques.size(), b.torques.size());
  EXPECT_EQ(a.commanded.size(), b.commanded.size());
}

TEST(PoseSetCsv, WritingThenReadingGivesEqualValues) {
  const char* const texts[] = {
      "q1[deg],q2[mm],x[mm],y[mm],z[mm],qw,qx,qy,qz\n33.3,250,1000.1,-2000,3,1,0,0,0\n-7.7,1,,,,0.6,0,0.8,0\n",
      "q1,q2,x,y,z,sx,sy,sz,s2_x,s2_y,s2_z\n0,0,1,2,3,0.1,0.2,0.3,7,8,9\n0,0,,,,,,,4,5,6\n",
      "q1,q2,anchor,pair,distance,socket,plane,tilt_x,tilt_y,tilt_z\n1,1,2,,1.5,ball,,,,\n0,0,,a,0.8,,table,,,\n0,0,,a,"
      ",,,1,2,3\n",
      "q1,q2,x,y,z,payload[kg],set,setup,sweep,tau1,tau2,q1_cmd[deg],q2_cmd[mm],id\n0,0,1,2,3,5,train,A,,0.1,0.2,1,2,"
      "\"a,b\"\n"
      "0,0,1,2,3,,holdout,B,pan,,0.4,3,4,\"say \"\"c\"\"\"\n",
  };
  for (const char* text : texts)
    for (const FileUnits units : {FileUnits::si, FileUnits::mm_deg}) {
      const PoseSet set = poses_of(text);
      expect_same(set, poses_of(format_pose_set_csv(set, two_joints(), units)));
    }
}

TEST(PoseSetCsv, JointPositionsAloneSufficeForPredictions) {
  EXPECT_EQ(poses_of("q1,q2\n0,1\n2,3\n", {}, RequiredContent::joints_only).rows(), 2);
  const PoseSet with_anchor = poses_of("q1,q2,anchor\n0,1,2\n2,3,\n", {}, RequiredContent::joints_only);
  EXPECT_EQ(with_anchor.rows(), 2);
  ASSERT_EQ(with_anchor.distances.size(), 1U);
  EXPECT_EQ(with_anchor.distances[0].anchor, 1);
  EXPECT_TRUE(std::isnan(with_anchor.distances[0].distance));
}

TEST(PoseSetCsv, BadFilesAreRefusedWithOneSentence) {
  struct Case {
    std::string text, sentence;
  };
  const std::string header = "q1,q2,x,y,z\n";
  const Case cases[] = {
      {"# nothing\n\n", "poses.csv: the file has no header line"},
      {header, "poses.csv:1: the file has a header but no rows, expected one row a pose"},
      {header + "0,0,1,2,3\n0,0,1,2\n", "poses.csv:3: expected 5 columns, found 4"},
      {header + "0,0,1,2,3,4\n",
       "poses.csv:2: expected 5 columns, found 6; are there commas inside numbers (thousands separators, decimal "
       "commas)?"},
      {header + "0,0,1,two,3\n", "poses.csv:2: column y: expected a number, found \"two\""},
      {header + "0,0,1,2,0x10\n", "poses.csv:2: column z: expected a number, found \"0x10\""},
      {header + "0,0,1,2,3mm\n", "poses.csv:2: column z: expected a number, found \"3mm\""},
      {header + "0,0,1,\"1.234,5\",3\n",
       "poses.csv:2: column y: expected a number, found \"1.234,5\"; thousands separators are not read, or decimal "
       "marks are mixed"},
      {header + "0,0,1,\"1,5\",3\n",
       "poses.csv:2: column y: expected a number, found \"1,5\"; a column map can say decimal = \",\""},
      {header + "0,0,1,1 234.5,3\n",
       "poses.csv:2: column y: expected a number, found \"1 234.5\"; thousands separators are not read"},
      {header + "0,0,1,nan,3\n", "poses.csv:2: column y: expected a finite number, found \"nan\""},
      {header + "inf,0,1,2,3\n", "poses.csv:2: column q1: expected a finite number, found \"inf\""},
      {header + "0,,1,2,3\n", "poses.csv:2: column q2: a joint position is missing"},
      {header + "0,0,1,,3\n", "poses.csv:2: expected x, y and z or none of them, found 2"},
      {"q1,q2,x,y,z,x\n0,0,1,2,3,4\n", "poses.csv:1: column x appears twice"},
      {"q1,q2,x[mm],y,z,x[m]\n0,0,1,2,3,4\n", "poses.csv:1: column x appears twice"},
      {"q1,q2,x,y,z,\n0,0,1,2,3,\n", "poses.csv:1: a column has no name"},
      {"q1,q2,x[inch],y,z\n0,0,1,2,3\n", "poses.csv:1: column x is in inch, but column y is without a unit"},
      {"q1,q2,x[inch],y[inch],z[inch]\n0,0,1,2,3\n",
       "poses.csv:1: column x: expected a length (m, mm, um), found the unit \"inch\""},
      {"q1,q2,x[rad],y[rad],z[rad]\n0,0,1,2,3\n",
       "poses.csv:1: column x: expected a length (m, mm, um), found the unit \"rad\""},
      {"q1,q2,x[mm],y[m],z[mm]\n0,0,1,2,3\n", "poses.csv:1: column x is in mm, but column y is in m"},
      {"q1[mm],q2,x,y,z\n0,0,1,2,3\n",
       "poses.csv:1: column q1: expected an angle (rad, deg, mrad), found the unit \"mm\""},
      {"q1,q2[deg],x,y,z\n0,0,1,2,3\n",
       "poses.csv:1: column q2: expected a length (m, mm, um), found the unit \"deg\""},
      {"q1,x,y,z\n0,1,2,3\n", "poses.csv:1: expected 2 joint columns (q1 to q2, or q_<name>), found 1: q2 is missing"},
      {"q1,q2,q3,x,y,z\n0,0,0,1,2,3\n",
       "poses.csv:1: expected 2 joint columns (q1 to q2, or q_<name>), found 3: the robot has no q3"},
      {"q1,q_pan,q2,x,y,z\n0,0,0,1,2,3\n", "poses.csv:1: columns q1 and q_pan are the same joint"},
      {"q1,q2\n0,0\n", "poses.csv:1: nothing is measured in this file, expected columns as x,y,z beside the joints"},
      {header + "0,0,,,\n",
       "poses.csv:1: nothing is measured in this file, expected columns as x,y,z beside the joints"},
      {"q1,q2,x,y\n0,0,1,2\n", "poses.csv:1: column z is missing beside column x"},
      {"q1,q2,x,y,z,temprature\n0,0,1,2,3,20\n", "poses.csv:1: unknown column \"temprature\""},
      {"q1,q2,s3_x,s3_y,s3_z\n0,0,1,2,3\n", "poses.csv:1: column s3_x: the robot has no [[target]] named \"s3\""},
      {"q1,q2,x,y,z,qw,qx,qy,qz\n0,0,1,2,3,1,1,0,0\n",
       "poses.csv:2: qw, qx, qy, qz: expected a norm of 1, found 1.414"},
      {"q1,q2,x,y,z,qx,qy,qz\n0,0,1,2,3,1,0,0\n", "poses.csv:1: an orientation needs the columns qw, qx, qy and qz"},
      {"q1,q2,x,y,z,rx,ry,rz\n0,0,1,2,3,1,0,0\n",
       "poses.csv:1: columns rx, ry, rz need a column map that says euler = \"XYZ intrinsic\""},
      {"q1,q2,x,y,z,set\n0,0,1,2,3,test\n",
       "poses.csv:2: column set: expected \"train\" or \"holdout\", found \"test\""},
      {"q1,q2,anchor,distance\n0,0,0,1\n", "poses.csv:2: column anchor: expected a whole number from 1, found 0"},
      {"q1,q2,anchor,distance\n0,0,1,\n", "poses.csv:2: column distance: the distance from the anchor is missing"},
      {"q1,q2,anchor,distance\n0,0,,1\n", "poses.csv:2: column distance: expected an anchor or a pair beside it"},
      {"q1,q2,pair,distance\n0,0,a,1\n", "poses.csv:2: column pair: expected 2 rows of pair \"a\", found 1"},
      {"q1,q2,pair,distance\n0,0,a,1\n0,0,a,2\n",
       "poses.csv:3: column distance: the rows of pair \"a\" give different distances"},
      {header + "0,0,1,2,\"3\n",
       "poses.csv:2: a quoted cell does not end on this line, or text follows its closing quote"},
      {std::string("\xFF\xFEq\0", 4), "poses.csv:1: the file is UTF-16, expected UTF-8; save it as CSV UTF-8"},
  };
  for (const Case& bad : cases) EXPECT_EQ(complaint_about(bad.text), bad.sentence) << bad.text;
}

TEST(PoseSetCsv, MissingAndEmptyFilesAreErrors) {
  EXPECT_EQ(read_pose_set("no-such-poses.csv", two_joints()).error().what, "no-such-poses.csv: no such file");
  EXPECT_EQ(read_pose_set("/dev/null", two_joints()).error().what, "/dev/null: the file is empty");
}

constexpr const char* foreign_map = R"(delimiter = ";"
decimal = ","
skip_lines = 1
euler = "XYZ intrinsic"
[columns]
q1 = "Joint A [deg]"
q_slide = "Joint B [mm]"
x = "X [mm]"
y = "Y [mm]"
z = "Z [mm]"
rx = "A [deg]"
ry = "B [deg]"
rz = "C [deg]"
)";

ColumnMap map_of(const std::string& text) {
  const auto map = parse_column_map(text, "map.toml");
  EXPECT_TRUE(map.has_value()) << (map ? "" : map.error().what);
  return map.value_or(ColumnMap{});
}

TEST(ColumnMap, AForeignFileIsReadByItsMapAndOtherColumnsAreIgnored) {
  const PoseSet set = poses_of(
      "exported by a tracker\nName;Name;Joint A;Joint B;X;Y;Z [mm];A;B;C\np1;p1;90,5;12,5;1000;-2,5;3;10;20;30\n",
      map_of(foreign_map));
  EXPECT_DOUBLE_EQ(set.joints(0, 0), 90.5 * degree);
  EXPECT_DOUBLE_EQ(set.joints(1, 0), 0.0125);
  EXPECT_TRUE(set.points[0].position.isApprox(Vec3(1, -0.0025, 0.003)));
  const Mat3 expected = rot_x(10 * degree) * rot_y(20 * degree) * rot_z(30 * degree);
  EXPECT_TRUE(set.orientations[0].orientation.toRotationMatrix().isApprox(expected, 1e-14));
}

TEST(ColumnMap, WhatContradictsTheMapIsRefused) {
  const ColumnMap map = map_of(foreign_map);
  const std::string header = "exported\nJoint A;Joint B;X;Y;Z;A;B;C\n";
  EXPECT_EQ(complaint_about("exported\nJoint A;Joint B;X [m];Y;Z;A;B;C\n0;0;0;0;0;0;0;0\n", map),
            "poses.csv:2: column X is in m, but the column map says mm");
  EXPECT_EQ(complaint_about("exported\nJoint A;Joint B;X;Y;A;B;C\n0;0;0;0;0;0;0\n", map),
            "poses.csv:2: no column is named \"Z\", which the column map wants");
  EXPECT_EQ(complaint_about("exported\nJoint A;Joint B;X;X;Y;Z;A;B;C\n0;0;0;0;0;0;0;0;0\n", map),
            "poses.csv:2: column X appears twice");
  EXPECT_EQ(complaint_about(header + "0;0;1.5;0;0;0;0;0\n", map),
            "poses.csv:3: column x: expected a number, found \"1.5\"; the decimal mark of this file is the comma");
  EXPECT_EQ(complaint_about(header + "0;0;1.234,5;0;0;0;0;0\n", map),
            "poses.csv:3: column x: expected a number, found \"1.234,5\"; thousands separators are not read, or "
            "decimal marks are mixed");
}

TEST(PoseSetCsv, DelimiterDecimalMarkAndUnitsAreToldByTheFileItself) {
  const auto set = parse_pose_set("sep=;\n\"q1 (deg)\";\"q2 (mm)\";\"x (mm)\";\"y (mm)\";\"z (mm)\";\n90;0;1,5;2;3;\n",
                                  "poses.csv", two_joints());
  ASSERT_TRUE(set) << set.error().what;
  EXPECT_NEAR(set->joints(0, 0), 90 * degree, 1e-12);
  EXPECT_NEAR(set->points[0].position.x(), 1.5e-3, 1e-12);
}

TEST(PoseSetCsv, RotationVectorsAndColumnsByNumberAreMapped) {
  const auto map = parse_column_map(
      "header = \"none\"\neuler = \"rotation vector\"\n[columns]\nq1 = \"#1\"\nq2 = \"#2\"\nx = \"#3 [mm]\"\ny = \"#4 "
      "[mm]\"\nz = \"#5 [mm]\"\nrx = \"#6\"\nry = \"#7\"\nrz = \"#8\"\n",
      "map.toml");
  ASSERT_TRUE(map) << map.error().what;
  const auto set = parse_pose_set("0 1 1000 2000 3000 0 0 1.5\n", "rtde.txt", two_joints(), *map);
  ASSERT_TRUE(set) << set.error().what;
  EXPECT_NEAR(set->points[0].position.y(), 2.0, 1e-12);
  EXPECT_NEAR(angle_between(set->orientations[0].orientation.toRotationMatrix(), rot_z(1.5)), 0.0, 1e-9);
}

TEST(ColumnMap, BadMapsAreRefusedWithOneSentence) {
  const auto complaint = [](const std::string& text) {
    const auto map = parse_column_map(text, "map.toml");
    return map ? "(accepted)" : map.error().what;
  };
  EXPECT_EQ(complaint("delimitter = \";\""), "map.toml:1: unknown key \"delimitter\"");
  EXPECT_EQ(complaint("delimiter = \";;\""), "map.toml:1: \"delimiter\": expected one character, found \";;\"");
  EXPECT_EQ(complaint("delimiter = \",\"\ndecimal = \",\""),
            "map.toml:2: \"decimal\" and \"delimiter\" are the same character");
  EXPECT_EQ(complaint("skip_lines = 1.5"), "map.toml:1: \"skip_lines\": expected a whole number from 0");
  EXPECT_EQ(complaint("euler = \"ABC\""),
            "map.toml:1: \"euler\": expected a sequence as \"XYZ intrinsic\" or \"ZYX extrinsic\", found \"ABC\"");
  EXPECT_EQ(complaint("[columns]\nx = 3"), "map.toml:2: columns: \"x\": expected a text, found a number");
}

TEST(PoseSetCsv, TheUr10SeriesAreReadByTheMapOfTheProject) {
  const char* data = std::getenv("KINFER_DATA");
  if (!data) GTEST_SKIP() << "KINFER_DATA is not set";
  const std::filesystem::path folder = std::filesystem::path(KINFER_SOURCE_DIR) / "data/ur10";
  const auto robot = read_robot_toml(folder / "robot.toml");
  ASSERT_TRUE(robot.has_value()) << robot.error().what;
  const auto map = read_column_map(folder / "leica_columns.toml");
  ASSERT_TRUE(map.has_value()) << map.error().what;
  const auto read = [&](const char* file) {
    const auto set = read_pose_set(std::filesystem::path(data) / "ur10_leica" / file, robot->chain, *map);
    EXPECT_TRUE(set.has_value()) << (set ? "" : set.error().what);
    return set.value_or(PoseSet{});
  };
  const PoseSet b = read("Series_B_measurements_joint_configurations.csv");
  EXPECT_EQ(b.rows(), 1495);
  EXPECT_EQ(b.points.size(), 1495U);
  EXPECT_EQ(b.orientations.size(), 1495U);
  EXPECT_NEAR(b.points[0].position.x(), 0.38376294, 1e-12);
  EXPECT_NEAR(b.points[0].sd->y(), 13.252e-6, 1e-15);
  EXPECT_NEAR(b.temperature[0], 21.86750031, 1e-12);
  EXPECT_EQ(b.joints(1, 0), -1.5708);
  const PoseSet c = read("Series_C_measurements_random_poses.csv");
  EXPECT_EQ(c.rows(), 2773);
  EXPECT_EQ(c.points.size(), 2773U);
}

}  // namespace
}  // namespace kinfer
