// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "kinfer/io/recording/ins_csv.hpp"

namespace kinfer::test {
namespace {

using nlohmann::json;

class Simulate : public Program {};

TEST_F(Simulate, ExcavatorWritesARecordingThatIsReadBackAndItsGroundTruth) {
  const Outcome run = kinfer("simulate excavator --duration 60 --out data");
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* file : {"imu.csv", "truth.json", "motion.csv", "machine.xml", "run.json"})
    EXPECT_TRUE(fs::exists(in("data") / file)) << file;
  const auto recording = read_ins_csv(in("data/imu.csv"));
  ASSERT_TRUE(recording) << recording.error().what;
  EXPECT_EQ(recording->sensors.size(), 6u);
  EXPECT_EQ(recording->loggers[0].time.size(), 12000u);
  EXPECT_TRUE(recording->remarks.empty()) << recording->remarks[0];
  const json truth = json::parse(slurp(in("data/truth.json")));
  EXPECT_EQ(truth["root"], "ins0");
  ASSERT_EQ(truth["joints"].size(), 5u);
  const json& boom = truth["joints"][1];
  EXPECT_EQ(boom["parent"], "ins1");
  EXPECT_EQ(boom["child"], "ins2");
  EXPECT_EQ(boom["type"], "revolute");
  EXPECT_NEAR(boom["point_in_parent"][0].get<double>(), 0.4, 1e-12);
  EXPECT_NEAR(boom["point_in_child"][0].get<double>(), -0.58, 1e-12);
  const std::string motion = slurp(in("data/motion.csv"));
  EXPECT_EQ(motion.find("t,q_swing,q_boom,q_adjustment,q_stick,q_tool,ins0_qw,ins0_qx,ins0_qy,ins0_qz,ins1_qw"), 0u);
}

TEST_F(Simulate, SameSeedWritesTheSameBytesAnywhereAndAnotherSeedDoesNot) {
  const std::string options = "simulate crane --duration 14 --missing 0.05 --spikes 3 --magnetic-disturbance 5 ";
  ASSERT_EQ(kinfer(options + "--out one --threads 1").code, 0);
  ASSERT_EQ(kinfer(options + "--out two --threads 2").code, 0);
  ASSERT_EQ(kinfer(options + "--out other --seed 2").code, 0);
  for (const char* file : {"imu.csv", "truth.json", "motion.csv", "machine.xml"})
    EXPECT_EQ(slurp(in("one") / file), slurp(in("two") / file)) << file;
  EXPECT_NE(slurp(in("one/imu.csv")), slurp(in("other/imu.csv")));
}

TEST_F(Simulate, SensorsOnFoamMeasureAnotherMotionOfTheSameMachine) {
  ASSERT_EQ(kinfer("simulate tree --duration 16 --out firm").code, 0);
  ASSERT_EQ(kinfer("simulate tree --duration 16 --foam 3 --out soft").code, 0);
  EXPECT_NE(slurp(in("firm/imu.csv")), slurp(in("soft/imu.csv")));
  EXPECT_EQ(json::parse(slurp(in("firm/truth.json")))["joints"], json::parse(slurp(in("soft/truth.json")))["joints"]);
}

TEST_F(Simulate, WithoutMujocoIsRefusedInOneSentenceAndNothingElseMissesIt) {
  ::setenv("KINFER_MUJOCO", in("libmujoco.so").c_str(), 1);
  const Outcome run = kinfer("simulate tree --out none");
  const Outcome poses = kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") + " --out poses");
  ::unsetenv("KINFER_MUJOCO");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("MuJoCo is needed to simulate machines"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("apt install libmujoco"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(in("none")));
  EXPECT_EQ(poses.code, 0) << poses.err;
}

TEST_F(Simulate, ALibraryThatIsNotMujocoIsRefusedInOneSentence) {
  ::setenv("KINFER_MUJOCO", "libz.so.1", 1);
  const Outcome run = kinfer("simulate tree --out none");
  ::unsetenv("KINFER_MUJOCO");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("libz.so.1 is not of version"), std::string::npos) << run.err;
}

TEST_F(Simulate, ImpossibleOptionsAreRefusedInOneSentenceAndNothingIsWritten) {
  const std::pair<const char*, const char*> cases[] = {
      {"simulate digger", "digger: no such machine; known are crane, excavator, excavator-general, robot6, tree"},
      {"simulate tree --duration 5", "a duration of 5 s is too short for this script: 15.2 s at least"},
      {"simulate tree --grade lab",
       "lab: no such sensor grade; known are perfect, noise, industrial, consumer, or a file"},
      {"simulate tree --excitation wild",
       "--excitation: expected one of gentle, quick, sequential, standard, together, vigorous, found \"wild\""},
      {"simulate tree --rate 5", "from 20 to 2000, found \"5\""},
      {"simulate tree --missing 1.5", "from 0 to 0.9, found \"1.5\""},
      {"simulate excavator --linkage --motion soft", "--motion soft: has no effect with --linkage"}};
  for (const auto& [arguments, sentence] : cases) {
    const Outcome run = kinfer(std::string(arguments) + " --out data");
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_NE(run.err.find(sentence), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(in("data"))) << arguments;
  }
}

TEST_F(Simulate, AnOwnSensorGradeAndSixAxesAreRecorded) {
  write(in("sheet.toml"), "name = \"lab\"\n[accelerometer]\nnoise_density = 0\n[gyroscope]\nnoise_density = 0\n");
  const Outcome run =
      kinfer("simulate tree --duration 16 --motion prescribed --grade sheet.toml --no-magnetometer --json --out data");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["rows"], 3200);
  EXPECT_EQ(slurp(in("data/imu.csv")).find("_mx"), std::string::npos);
}

TEST_F(Simulate, RowsThatAreStampedSeveralAtOnceAreRead) {
  ASSERT_EQ(kinfer("simulate tree --duration 16 --motion prescribed --packet 3 --out data").code, 0);
  const Outcome run = kinfer("inspect data/imu.csv");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find(" Hz (100.00 % of it is there)"), std::string::npos) << run.out;
}

TEST_F(Simulate, PosesHaveAHeadlineAsJson) {
  const Outcome run = kinfer("simulate-poses --robot " + source("examples/robot6/robot.toml") +
                             " --poses 7 --sigma 0.02 --measured pose --out poses --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const json headline = json::parse(run.out);
  EXPECT_EQ(headline["poses"], 7);
  EXPECT_EQ(headline["joints"], 6);
  EXPECT_EQ(headline["measured"], "pose");
  EXPECT_DOUBLE_EQ(headline["sigma"].get<double>(), 2e-5);
}

}  // namespace
}  // namespace kinfer::test
