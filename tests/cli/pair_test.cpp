// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cli/program.hpp"

namespace kinfer {
namespace {

using test::Outcome;
using test::slurp;
using test::write;
using ::testing::HasSubstr;

class Pair : public test::Program {
 protected:
  /// joints.csv and, with the lines that `keep` holds, tracker.csv: the example robot's tool points.
  void write_lists(const std::vector<bool>& keep, const std::string& id = "") const {
    predict_targets("10,-80,70,20,40,-30\n-25,-60,80,10,60,5\n30,-70,60,0,30,10\n0,-90,80,10,20,0\n");
    std::istringstream joints(slurp(in("joints.csv"))), points(slurp(in("targets.csv")));
    std::string header, line, named_joints, tracker = (id.empty() ? "" : "id,") + std::string("x[m],y[m],z[m]\n");
    std::getline(joints, header), std::getline(points, line);
    named_joints = (id.empty() ? "" : "id,") + header + "\n";
    for (std::size_t i = 0; i < 4; ++i) {
      std::getline(joints, header), std::getline(points, line);
      const std::string label = id.empty() ? "" : id + std::to_string(i) + ",";
      named_joints += label + header + "\n";
      std::istringstream cells(line);
      std::string x, y, z;
      std::getline(cells, x, ','), std::getline(cells, y, ','), std::getline(cells, z, ',');
      if (keep[i]) tracker += label + x + "," + y + "," + z + "\n";
    }
    write(in("joints.csv"), named_joints), write(in("tracker.csv"), tracker);
  }
  Outcome pair(const std::string& more = "") const {
    return kinfer("pair --robot " + source("examples/robot6/robot.toml") +
                  " --joints joints.csv --measured tracker.csv --out poses.csv " + more);
  }
};

TEST_F(Pair, ListsOfOneLengthArePairedByOrder) {
  write_lists({true, true, true, true});
  const Outcome run = pair();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("4 pairs by order of 4 rests of the robot and 4 of the tracker"));
  EXPECT_THAT(run.out, HasSubstr("differ from the nominal model's by 0.00 mm"));
  EXPECT_EQ(kinfer("inspect poses.csv --robot " + source("examples/robot6/robot.toml")).code, 0);
}

TEST_F(Pair, NamesFindTheirPartnersAndWhatHasNoneIsListed) {
  write_lists({true, false, true, true}, "pose");
  const Outcome run = pair();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 pairs by name"));
  EXPECT_THAT(run.out, HasSubstr("no partner: joints.csv (pose1, line 3)"));
  EXPECT_THAT(slurp(in("poses.csv")), HasSubstr("pose3"));
}

TEST_F(Pair, AmbiguousCountsAndOptionsWithoutEffectAreRefused) {
  write_lists({true, false, true, true});
  EXPECT_THAT(pair().err, HasSubstr("the joint list has 4 rests and the measured list 3; they part at rest 2"));
  EXPECT_EQ(pair().code, 2);
  write_lists({true, true, true, true});
  EXPECT_THAT(pair("--offset 3").err, HasSubstr("--offset: no effect on pairing by order"));
  EXPECT_THAT(pair("--by time").err, HasSubstr("needs two streams with a column t"));
  EXPECT_THAT(pair("--by name").err, HasSubstr("needs a column id in both files"));
}

/// The columns of a CSV whose names begin with one of `names`, as rows of cells.
std::string columns_of(const std::string& csv, const std::vector<std::string>& names, bool has_header, char delimiter) {
  std::istringstream lines(csv);
  std::string line, out;
  std::vector<std::size_t> chosen;
  for (bool is_header = true; std::getline(lines, line); is_header = false) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (is_header)
      for (const std::string& name : names)
        for (std::size_t c = 0; c < row.size(); ++c)
          if (row[c].rfind(name + "[", 0) == 0) chosen.push_back(c);
    if (is_header && !has_header) continue;
    for (std::size_t k = 0; k < chosen.size(); ++k) out += (k > 0 ? std::string(1, delimiter) : "") + row[chosen[k]];
    out += "\n";
  }
  return out;
}

TEST_F(Pair, CalibrateTakesAJointLogAndATrackersListAndDoesTheSame) {
  simulate("--poses 40");
  const std::string poses = slurp(in("data/poses.csv"));
  write(in("joints.csv"), columns_of(poses, {"q1", "q2", "q3", "q4", "q5", "q6"}, true, ','));
  const std::string points = columns_of(poses, {"x", "y", "z"}, false, ' ');
  write(in("tracker.txt"), points);
  const std::string robot = "--robot " + source("examples/robot6/robot.toml");
  const std::string files = robot + " --joints joints.csv --measured tracker.txt ";
  const Outcome paired = kinfer("pair " + files + "--out poses.csv");
  ASSERT_EQ(paired.code, 0) << paired.err;
  EXPECT_THAT(paired.out, HasSubstr("tracker.txt: read as list of points"));
  EXPECT_THAT(paired.out, HasSubstr("they are read in mm"));
  const Outcome direct = kinfer("calibrate " + files + "--model geometry --out direct");
  EXPECT_EQ(direct.code, 0) << direct.err;
  EXPECT_THAT(direct.out, HasSubstr("40 pairs by order of 40 rests of the robot and 40 of the tracker"));
  EXPECT_EQ(slurp(in("direct/poses.csv")), slurp(in("poses.csv")));
  EXPECT_THAT(slurp(in("direct/evidence.json")), HasSubstr("tracker.txt"));
  // One point less: refused, with both counts.
  write(in("tracker.txt"), points.substr(points.find('\n') + 1));
  const Outcome ambiguous = kinfer("calibrate " + files + "--out ambiguous");
  EXPECT_EQ(ambiguous.code, 2);
  EXPECT_THAT(ambiguous.err, HasSubstr("the joint list has 40 rests and the measured list 39"));
  const std::string data = "calibrate " + robot + " --data data/poses.csv --out x ";
  EXPECT_THAT(kinfer(data + "--by time").err, HasSubstr("--by has no effect with --data"));
  EXPECT_THAT(kinfer(data + "--joints joints.csv --measured tracker.txt").err, HasSubstr("give one"));
  EXPECT_THAT(kinfer("calibrate " + robot + " --joints joints.csv --out x").err,
              HasSubstr("expected --data POSES.csv"));
}

TEST_F(Pair, ATrajectoryBecomesARobotLogThatInspectAndPairRead) {
  std::string text = "t[s],q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg]\n";
  for (int row = 0; row < 900; ++row) {
    // Rests of 0.9 to 1.4 s, each move half a second.
    const int stop = row / 150, part = row % 150;
    const double at = stop + std::min(1.0, std::max(0.0, (part - 90.0 - 5.0 * stop) / 35.0));
    text += std::to_string(0.01 * row);
    for (int j = 1; j <= 6; ++j)
      text += "," + std::to_string(20.0 * std::sin(0.9 * j + 1.3 * at * j) - (j == 2 ? 60.0 : 0.0));
    text += "\n";
  }
  write(in("path.csv"), text);
  const std::string robot = source("examples/robot6/robot.toml");
  const Outcome converted = kinfer("convert path.csv drive.mcap --robot " + robot);
  ASSERT_EQ(converted.code, 0) << converted.err;
  EXPECT_THAT(converted.out, HasSubstr("900 rows of 6 joints"));
  const Outcome inspected = kinfer("inspect drive.mcap");
  EXPECT_EQ(inspected.code, 0) << inspected.err;
  EXPECT_THAT(inspected.out, HasSubstr("/joint_states"));
  EXPECT_THAT(inspected.out, HasSubstr("joint positions: pair, calibrate (--joints), predict"));
  EXPECT_THAT(inspected.out, HasSubstr("tool points: pair, calibrate (--measured)"));
  EXPECT_THAT(kinfer("inspect drive.mcap --json").out, HasSubstr("\"type\": \"geometry_msgs/PoseStamped\""));
  const Outcome paired = kinfer("pair --robot " + robot + " --joints drive.mcap --measured drive.mcap --out poses.csv");
  EXPECT_EQ(paired.code, 0) << paired.err;
  EXPECT_THAT(paired.out, HasSubstr("drive.mcap: read as topic /joint_states (sensor_msgs/JointState)"));
  EXPECT_THAT(paired.out, HasSubstr("differ from the nominal model's by 0.00 mm"));
  EXPECT_THAT(
      kinfer("pair --robot " + robot + " --joints drive.mcap --measured drive.mcap --topic /none --out p.csv").err,
      HasSubstr("no topic of those that --topic names"));
  EXPECT_THAT(kinfer("convert " + robot + " robot.urdf --robot " + robot).err, HasSubstr("--robot: no effect"));
  write(in("joints.csv"), "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg]\n0,0,0,0,0,0\n");
  EXPECT_THAT(kinfer("convert joints.csv x.mcap --robot " + robot).err, HasSubstr("a trajectory needs a column t"));
}

TEST_F(Pair, InspectSaysWhatATrackersFileIs) {
  write(in("take.tsv"),
        "NO_OF_FRAMES\t2\nNO_OF_CAMERAS\t8\nFREQUENCY\t100\nMARKER_"
        "NAMES\ttip\tbase\n1\t2\t3\t4\t5\t6\n1\t2\t3\t4\t5\t6\n");
  const Outcome text = kinfer("inspect take.tsv"), json = kinfer("inspect take.tsv --json");
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("take.tsv: Qualisys tsv, 2 rows"));
  EXPECT_THAT(text.out, HasSubstr("markers: tip, base"));
  EXPECT_THAT(text.out, HasSubstr("--marker NAME says which is the tool point"));
  EXPECT_THAT(json.out, HasSubstr("\"kind\":\"tracker_file\""));
}

}  // namespace
}  // namespace kinfer
