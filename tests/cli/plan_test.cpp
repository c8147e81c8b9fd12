// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class PlanPoses : public Program {
 protected:
  std::string robot() const { return source("examples/robot6/robot.toml"); }
};

TEST_F(PlanPoses, PlannedPosesAreReadBackAndComeWithAFigure) {
  const Outcome run = kinfer("plan --robot " + robot() + " --poses 10 -o plan.csv --lowest 100 --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const json plan = json::parse(run.out);
  EXPECT_EQ(slurp(in("plan.json")), run.out);
  EXPECT_GT(plan["least_rms"].get<double>(), 0.0);
  EXPECT_LE(plan["least_rms"].get<double>(), 1.02 * plan["expected"]["rms"].get<double>());
  EXPECT_EQ(plan["poses"], 10);
  EXPECT_LT(plan["expected"]["rms"], plan["random"]["rms"]);
  EXPECT_EQ(plan["observability"].size(), 5u);
  ASSERT_EQ(kinfer("predict --chain " + robot() + " --joints plan.csv -o poses.csv").code, 0);
  const std::string figure = slurp(in("plan.svg"));
  EXPECT_EQ(figure.find("<?xml"), 0u);
  EXPECT_NE(figure.find("poses measured"), std::string::npos);
}

TEST_F(PlanPoses, SomeOfThePosesOfAFileAreChosenAndOthersLeftOut) {
  ASSERT_EQ(kinfer("simulate-poses --robot " + robot() + " --out data --poses 40").code, 0);
  const Outcome chosen =
      kinfer("plan --robot " + robot() + " --poses 12 -o plan.csv --candidates data/poses.csv --json");
  ASSERT_EQ(chosen.code, 0) << chosen.err;
  EXPECT_EQ(json::parse(chosen.out)["rows"].size(), 12u);
  const Outcome added = kinfer("plan --robot " + robot() + " --poses 4 -o more.csv --data data/poses.csv --json");
  ASSERT_EQ(added.code, 0) << added.err;
  EXPECT_LT(json::parse(added.out)["expected"]["rms"], json::parse(added.out)["existing"]["rms"]);
}

TEST_F(PlanPoses, PosesAreNotWrittenOverByTheirFigure) {
  for (const std::string name : {"plan.svg", "plan.json"}) {
    const Outcome run = kinfer("plan --robot " + robot() + " --poses 8 -o " + name);
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find("the figure and its numbers end in .svg and .json"), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(in(name)));
  }
}

TEST_F(PlanPoses, AnInstrumentThatStatesLengthsAloneHasTheUsualAngles) {
  const std::string whole = slurp(robot());
  const auto at = whole.find("[instrument]");
  const std::string before = whole.substr(0, at);
  const auto plan = [&](const std::string& name, const std::string& instrument) {
    std::ofstream(in(name)) << before << "[instrument]\n" << instrument;
    const Outcome run = kinfer("plan --robot " + name + " --measured pose --poses 4 -o plan.csv --json");
    EXPECT_EQ(run.code, 0) << run.err;
    return json::parse(run.out)["expected"]["rms"].get<double>();
  };
  const double lengths_alone = plan("lengths.toml", "sigma = 0.05\n");
  EXPECT_NEAR(lengths_alone, plan("both.toml", "sigma = 0.05\nsigma_angle = 0.0114592\n"), 1e-3 * lengths_alone);
}

TEST_F(PlanPoses, BadInputGivesOneSentence) {
  const Outcome place = kinfer("plan --robot " + robot() + " -o plan.csv --instrument-at 1,2");
  EXPECT_EQ(place.code, 2);
  EXPECT_NE(place.err.find("expected x,y,z in mm"), std::string::npos) << place.err;
  const Outcome floor = kinfer("plan --robot " + robot() + " -o plan.csv --lowest 90000");
  EXPECT_EQ(floor.code, 2);
  EXPECT_NE(floor.err.find("none of"), std::string::npos) << floor.err;
}

}  // namespace
}  // namespace kinfer::test
