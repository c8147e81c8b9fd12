// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Outcome;
using test::slurp;
using test::write;
using ::testing::HasSubstr;

class Merge : public test::Program {
 protected:
  std::string robot() const { return source("examples/robot6/robot.toml"); }

  /// KEY.toml: a robot of a series that was built well: all share most of their errors.
  void write_errors(const std::string& key, int robot) const {
    std::string text = "units = { length = \"mm\", angle = \"deg\" }\n[errors]\nbase_x = 500\n";
    int k = 0;
    for (const char* joint : {"1", "2", "3", "4", "5", "6"})
      for (const char* kind : {"a", "d", "theta", "alpha"}) {
        const double tolerance = kind[0] == 'd' || std::string(kind) == "a" ? 0.5 : 0.1;
        const double own = 0.1 * std::sin(1.7 * robot + 2.3 * ++k), common = 0.8 * std::sin(3.1 * k);
        text += fmt::format("{}{} = {:.6f}\n", kind, joint, tolerance * (common + own));
      }
    write(in(key + ".toml"), text);
  }

  /// runs/: `count` calibrations of such robots.
  void calibrate_fleet(int count, const std::string& more = "") const {
    std::string made = "key,verb,arguments\n", calibrated = "key,verb,arguments,robot,date,truth\n";
    for (int i = 0; i < count; ++i) {
      const std::string key = "r" + std::to_string(i);
      write_errors(key, i);
      made += key + ",simulate-poses,--robot " + robot() + " --errors " + key +
              ".toml --poses 40 --lowest 0 --clearance 350\n";
      calibrated += key + ",calibrate,--robot robots/" + key + "/robot.toml --data robots/" + key + "/poses.csv," +
                    key + ",2026-05-01,robots/" + key + "/truth.toml\n";
    }
    write(in("robots.csv"), made);
    write(in("manifest.csv"), calibrated + more);
    ASSERT_EQ(kinfer("sweep robots.csv --out robots").code, 0);
    const Outcome run = kinfer("sweep manifest.csv --out runs");
    ASSERT_EQ(run.code, 0) << run.err;
  }
};

TEST_F(Merge, MakesTableReportAndPriorOfAFleet) {
  calibrate_fleet(5, "bad,calibrate,--robot none.toml --data none.csv,,,\n");
  const Outcome run = kinfer("merge runs --out fleet");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("6 tasks: "));
  EXPECT_THAT(run.out, HasSubstr("1 refused"));
  const std::string table = slurp(in("fleet/table.csv"));
  EXPECT_THAT(table, HasSubstr("key,robot,date,verb,state,exit_code,usability"));
  EXPECT_THAT(table, HasSubstr("r3,r3,2026-05-01,calibrate,done,0,use,improves_nominal"));
  EXPECT_THAT(table, HasSubstr("theta2[rad],sd_theta2[rad]"));
  const json fleet = json::parse(slurp(in("fleet/fleet.json")));
  EXPECT_EQ(fleet["counts"]["refused"], 1);
  EXPECT_EQ(fleet["failures"][0]["keys"][0], "bad");
  EXPECT_EQ(fleet["coverage"][0]["count"], 5);
  const json prior = json::parse(slurp(in("fleet/prior.json")));
  EXPECT_EQ(prior["robots"], 5);
  EXPECT_EQ(prior["covariance"].size(), prior["names"].size());
  EXPECT_THAT(slurp(in("fleet/report.html")), HasSubstr("\"kind\":\"fleet\""));
}

TEST_F(Merge, APriorOfTheFleetIsHandedToEachCalibrationAndAForeignRobotIsNoticed) {
  calibrate_fleet(8);
  ASSERT_EQ(kinfer("merge runs --out fleet").code, 0);
  const Outcome again = kinfer("sweep manifest.csv --prior fleet --out again");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(slurp(in("again/r0/task.json")), HasSubstr("\"--prior\""));
  EXPECT_THAT(slurp(in("again/r0/evidence.json")), HasSubstr("population_used"));
  EXPECT_EQ(kinfer("sweep manifest.csv --out again --resume").code, 2) << "with and without a prior in one folder";

  // A robot of the same type with errors as large as its tolerances, which those of the series never have.
  ASSERT_EQ(kinfer("simulate-poses --robot " + robot() + " --poses 40 --lowest 0 --clearance 350 --out data").code, 0);
  const Outcome foreign = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --prior fleet --out foreign");
  EXPECT_EQ(foreign.code, 0) << foreign.err;
  EXPECT_THAT(slurp(in("foreign/evidence.json")), HasSubstr("foreign_to_population"));
}

TEST_F(Merge, TruncatedForeignAndUnfinishedFoldersAreRowsOfTheirOwn) {
  calibrate_fleet(4);
  write(in("runs/r0/task.json"), slurp(in("runs/r0/task.json")).substr(0, 40));
  write(in("runs/r1/summary.json"), slurp(in("runs/r1/summary.json")).substr(0, 900));
  fs::remove_all(in("runs/r2"));
  fs::create_directories(in("runs/holiday"));
  const Outcome run = kinfer("merge runs --out fleet");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 unfinished, 3 unreadable"));
  const std::string table = slurp(in("fleet/table.csv"));
  EXPECT_THAT(table, HasSubstr("r0,r0,2026-05-01,,unreadable"));
  EXPECT_THAT(table, HasSubstr("r2,r2,2026-05-01,calibrate,unfinished"));
  EXPECT_THAT(table, HasSubstr("holiday,,,,unreadable"));
  EXPECT_THAT(table, HasSubstr("r3,r3,2026-05-01,calibrate,done"));
}

TEST_F(Merge, ArchivesGiveTheBytesOfFolders) {
  calibrate_fleet(4, "bad,calibrate,--robot none.toml --data none.csv,,,\n");
  ASSERT_EQ(kinfer("merge runs --out whole").code, 0);
  for (const char* shard : {"2/2", "1/2"})
    ASSERT_EQ(kinfer("sweep manifest.csv --pack --out packed --shard " + std::string(shard)).code, 0);
  ASSERT_EQ(kinfer("merge packed --out fleet").code, 0);
  for (const char* file : {"table.csv", "fleet.json", "prior.json", "report.html"})
    EXPECT_EQ(slurp(in(std::string("whole/") + file)), slurp(in(std::string("fleet/") + file))) << file;
}

TEST_F(Merge, SeveralFoldersMakeOneFleetWithTheBytesOfOne) {
  calibrate_fleet(4);
  ASSERT_EQ(kinfer("merge runs --out whole").code, 0);
  for (const char* part : {"1", "2"}) {
    fs::create_directories(in(std::string("part") + part));
    std::string rows = "key,verb,arguments,robot,date,truth\n";
    for (const int i : part[0] == '1' ? std::vector{0, 1} : std::vector{2, 3}) {
      const std::string key = "r" + std::to_string(i);
      fs::copy(in("runs/" + key), in(std::string("part") + part + "/" + key), fs::copy_options::recursive);
      rows += key + ",calibrate,," + key + ",2026-05-01,\n";
    }
    write(in(std::string("part") + part + "/manifest.csv"), rows);
  }
  ASSERT_EQ(kinfer("merge part2 part1 --out parts").code, 0);
  for (const char* file : {"table.csv", "fleet.json", "prior.json", "report.html"})
    EXPECT_EQ(slurp(in(std::string("whole/") + file)), slurp(in(std::string("parts/") + file))) << file;
  EXPECT_THAT(kinfer("merge runs part1 --out twice").err, HasSubstr("has results in two of the folders"));
}

TEST_F(Merge, ShardsInFoldersOfTheirOwnMakeOneFleet) {
  calibrate_fleet(4);
  ASSERT_EQ(kinfer("merge runs --out whole").code, 0);
  for (const std::string shard : {"one", "two"}) {
    fs::create_directories(in(shard));
    fs::copy(in("runs/manifest.csv"), in(shard + "/manifest.csv"));
    for (const int i : shard == "one" ? std::vector{0, 1} : std::vector{2, 3})
      fs::copy(in("runs/r" + std::to_string(i)), in(shard + "/r" + std::to_string(i)), fs::copy_options::recursive);
  }
  ASSERT_EQ(kinfer("merge one two --out shards").code, 0);
  for (const char* file : {"table.csv", "fleet.json"})
    EXPECT_EQ(slurp(in(std::string("whole/") + file)), slurp(in(std::string("shards/") + file))) << file;
}

TEST_F(Merge, VerifyOverTimeIsAControlChart) {
  write(in("first.toml"), "units = { length = \"mm\", angle = \"deg\" }\n[errors]\ntheta2 = 0.0\n");
  write(in("later.toml"), "units = { length = \"mm\", angle = \"deg\" }\n[errors]\ntheta2 = 0.02\n");
  std::string manifest = "key,verb,arguments,robot,date\n";
  for (int day = 1; day <= 14; ++day) {
    const std::string number = fmt::format("{:02}", day), errors = day < 9 ? "first.toml" : "later.toml";
    ASSERT_EQ(kinfer(fmt::format("simulate-poses --robot {} --errors {} --poses 20 --seed {} --out day{}", robot(),
                                 errors, 100 + day, number))
                  .code,
              0);
    manifest += fmt::format("d{0},verify,--chain {1} --data day{0}/poses.csv,cell1,2026-06-{0}\n", number, robot());
  }
  write(in("checks.csv"), manifest);
  ASSERT_EQ(kinfer("sweep checks.csv --out checks").code, 0);
  const Outcome run = kinfer("merge checks --out fleet");
  EXPECT_EQ(run.code, 0) << run.err;
  const json fleet = json::parse(slurp(in("fleet/fleet.json")));
  ASSERT_FALSE(fleet["chart"]["alarms"].empty()) << run.out;
  EXPECT_EQ(fleet["chart"]["alarms"][0]["robot"], "cell1");
  EXPECT_EQ(fleet["chart"]["alarms"][0]["since"], "2026-06-09");
}

TEST_F(Merge, BadInputIsOneSentence) {
  EXPECT_THAT(kinfer("merge nothing --out fleet").err, HasSubstr("nothing/manifest.csv: no such file"));
  write(in("prior.json"), "{\"format\":\"kinfer-prior/1\"}");
  simulate("--poses 12");
  EXPECT_THAT(kinfer("calibrate --robot data/robot.toml --data data/poses.csv --prior prior.json --out c").err,
              HasSubstr("prior.json: robots: "));
  write(in("dated.csv"), "key,verb,arguments,date\na,predict,,yesterday\n");
  EXPECT_THAT(kinfer("sweep dated.csv --out runs").err, HasSubstr("expected YYYY-MM-DD"));
  for (const char* own : {"manifest.csv", "results_1.tar"}) {
    write(in("own.csv"), fmt::format("key,verb,arguments\n{},predict,\n", own));
    EXPECT_THAT(kinfer("sweep own.csv --out runs").err, HasSubstr("is the name of a file of the sweep itself"));
  }
  write(in("sweep.csv"), "key,verb,arguments\na,predict,\n");
  EXPECT_THAT(kinfer("sweep sweep.csv --prior fleet --out runs").err, HasSubstr("--prior has no effect"));
  write(in("calibrations.csv"), "key,verb,arguments\na,calibrate,--robot data/robot.toml --data data/poses.csv\n");
  EXPECT_THAT(kinfer("sweep calibrations.csv --prior fleet --out runs").err,
              HasSubstr("--prior: fleet: no such file or folder"));
  EXPECT_FALSE(std::filesystem::exists(in("runs/a"))) << "no task is begun with a prior that cannot be read";
}

TEST_F(Merge, KernelsCanBePinned) {
  simulate("--poses 30");
  const Outcome plain =
      kinfer("--kernels portable calibrate --robot data/robot.toml --data data/poses.csv --out portable");
  EXPECT_EQ(plain.code, 0) << plain.err;
  EXPECT_THAT(slurp(in("portable/run.json")), HasSubstr("kernels portable"));
  const Outcome widest = kinfer("calibrate --robot data/robot.toml --data data/poses.csv --out widest");
  EXPECT_EQ(widest.code, 0);
  EXPECT_THAT(slurp(in("widest/run.json")), HasSubstr("processor_class"));
  EXPECT_THAT(kinfer("--kernels fast calibrate").err, HasSubstr("fast"));
}

}  // namespace
}  // namespace kinfer
