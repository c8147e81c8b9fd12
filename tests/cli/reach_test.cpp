// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/program.hpp"

namespace kinfer {
namespace {

using test::Outcome;
using test::slurp;
using test::write;
using ::testing::HasSubstr;

class Reach : public test::Program {
 protected:
  Outcome reach(const std::string& more) const {
    return kinfer("reach --chain " + source("examples/robot6/robot.toml") + " --targets targets.csv " + more);
  }
};

TEST_F(Reach, TakesTheChainByPositionAndFromItsFolder) {
  predict_targets("10,-80,70,20,40,-30\n");
  std::filesystem::create_directory(in("robot"));
  ASSERT_EQ(kinfer("convert " + source("examples/robot6/robot.toml") + " robot/chain.toml").code, 0);
  const Outcome by_option = reach("--quiet");
  EXPECT_EQ(by_option.code, 0) << by_option.err;
  for (const char* chain : {"robot", "robot/chain.toml", "--chain robot"}) {
    const Outcome run = kinfer(std::string("reach ") + chain + " --targets targets.csv --quiet");
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.out, by_option.out) << chain;
  }
  EXPECT_EQ(kinfer("path robot --from 0,0,0,0,0,0 --to 10,0,0,0,0,0").code, 0);
  ASSERT_EQ(kinfer("simulate-poses --robot robot --poses 5 --out data").code, 0);
  EXPECT_THAT(slurp(in("data/run.json")), HasSubstr("/robot/chain.toml\"")) << "the file, not its folder";
  std::filesystem::create_directory(in("empty"));
  EXPECT_THAT(kinfer("reach empty --targets targets.csv").err, HasSubstr("empty: expected a file, found a folder"));
}

TEST_F(Reach, WhatPredictSaysOfTheFoundJointsIsTheTarget) {
  predict_targets("10,-80,70,20,40,-30\n-25,-60,80,10,60,5\n");
  const Outcome run = reach("-o found.csv --json");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\"reached\":2"));
  EXPECT_THAT(run.err, HasSubstr("2 of 2 targets are reached"));
  ASSERT_EQ(kinfer("predict --chain " + source("examples/robot6/robot.toml") + " --joints found.csv -o again.csv").code,
            0);
  const Outcome all = reach("--postures all --quiet");
  EXPECT_EQ(all.code, 0);
  EXPECT_THAT(all.out, HasSubstr("1,2,reached"));
  std::istringstream wanted(slurp(in("targets.csv"))), found(slurp(in("again.csv")));
  std::string a, b;
  std::getline(wanted, a), std::getline(found, b);
  while (std::getline(wanted, a) && std::getline(found, b)) {
    std::istringstream one(a), other(b);
    for (std::string x, y; std::getline(one, x, ',') && std::getline(other, y, ',');)
      EXPECT_NEAR(std::stod(x), std::stod(y), 3e-9);
  }
}

TEST_F(Reach, TargetsThatAreNotReachedAreNamedWithTheReason) {
  write(in("targets.csv"), "x[m],y[m],z[m]\n30,0,0\n1,0,1\n");
  const Outcome run = reach("--prefer 0,-90,90,0,45,0");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("target 1: out of reach"));
  EXPECT_THAT(run.err, HasSubstr("1 of 2 targets are reached"));
}

TEST_F(Reach, BadInputIsOneSentence) {
  write(in("targets.csv"), "x,y,z\n1,0,1\n");
  const Outcome few = reach("--prefer 0,90");
  EXPECT_EQ(few.code, 2);
  EXPECT_THAT(few.err, HasSubstr("the robot has 6 joints, found 2 numbers"));
  EXPECT_THAT(reach("--prefer 0,a,1").err, HasSubstr("expected numbers separated by commas"));
  EXPECT_THAT(reach("--prefer 0,-inf,90,0,45,0").err, HasSubstr("--prefer: -inf rad is not possible for an angle"));
  EXPECT_THAT(reach("--prefer 0,1e300,90,0,45,0").err, HasSubstr("is not possible for an angle"));
  write(in("targets.csv"), "x,y\n1,0\n");
  EXPECT_EQ(reach("").code, 2);
}

}  // namespace
}  // namespace kinfer
