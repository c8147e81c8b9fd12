// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace kinfer
