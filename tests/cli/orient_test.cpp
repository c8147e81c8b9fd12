// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/program.hpp"
#include "support/carried_sensor.hpp"

namespace kinfer::test {
namespace {

using testing::carried;
using testing::CarriedMotion;

/// The moving sensor as a CSV file; its name is `name`.
std::string as_csv(const CarriedMotion& motion, const std::string& name) {
  const testing::CarriedSensor c = carried(motion);
  std::string text = "t";
  for (const char* channel : {"ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz"}) text += "," + name + "_" + channel;
  text += "\n";
  for (std::size_t row = 0; row < c.time.size(); ++row) {
    text += fmt::format("{:.4f}", c.time[row]);
    for (const TriadColumns* triad : {&c.sensor.acceleration, &c.sensor.angular_velocity, &c.sensor.field})
      for (const auto& axis : triad->axis) text += fmt::format(",{:.7g}", axis[row]);
    text += "\n";
  }
  return text;
}

class Orient : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    static const SensorModel grade = *sensor_grade("industrial");
    write(in("imu.csv"), as_csv({.seconds = 20, .sampling_rate = 100, .grade = &grade}, "imu"));
  }
};

TEST_F(Orient, WritesOneRowPerInputRowCloseToTheTruth) {
  for (const char* filter : {"kinfer", "kinfer-offline", "paper"}) {
    const Outcome run = kinfer(std::string("orient imu.csv -o q.csv --filter ") + filter);
    ASSERT_EQ(run.code, 0) << run.err;
    std::istringstream rows(slurp(in("q.csv")));
    std::string line;
    std::getline(rows, line);
    EXPECT_EQ(line, "t,imu_qw,imu_qx,imu_qy,imu_qz");
    const auto truth = carried({.seconds = 20, .sampling_rate = 100}).truth;
    std::size_t row = 0;
    double worst = 0.0;
    for (; std::getline(rows, line); ++row) {
      std::ranges::replace(line, ',', ' ');
      std::istringstream cells(line);
      double t = -1, w = 0, x = 0, y = 0, z = 0;
      cells >> t >> w >> x >> y >> z;
      EXPECT_NEAR(t, 0.01 * static_cast<double>(row), 1e-9);
      worst = std::max(worst, truth[row].angularDistance(Quat(w, x, y, z)));
    }
    EXPECT_EQ(row, truth.size());
    EXPECT_LT(worst, (std::string(filter) == "paper" ? 15 : 5) * degree) << filter;
  }
}

TEST_F(Orient, JsonNamesTheSensorsAndQuietIsSilent) {
  const Outcome run = kinfer("orient imu.csv -o q.csv --json --magnetometer off");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto headline = nlohmann::json::parse(run.out);
  EXPECT_EQ(headline["sensors"][0]["name"], "imu");
  EXPECT_EQ(headline["sensors"][0]["rows"], 2000);
  EXPECT_EQ(headline["sensors"][0]["magnetometer"], false);
  EXPECT_GT(headline["sensors"][0]["rest_s"], 5.0);
  EXPECT_EQ(kinfer("orient imu.csv -o q.csv --quiet").out, "");
}

TEST_F(Orient, SeveralLoggersAreWrittenOneAfterTheOther) {
  write(in("other.csv"), as_csv({.seconds = 5, .sampling_rate = 50}, "other"));
  const Outcome run = kinfer("orient imu.csv other.csv -o q.csv");
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string text = slurp(in("q.csv"));
  EXPECT_EQ(std::ranges::count(text, '\n'), 1 + 2000 + 250);
  ASSERT_EQ(kinfer("orient imu.csv other.csv -o one.csv --sensor other").code, 0);
  EXPECT_EQ(slurp(in("one.csv")).substr(0, 35), "t,other_qw,other_qx,other_qy,other_");
}

TEST_F(Orient, BadInputGivesOneSentenceExitCode2AndNoFile) {
  write(in("g.csv"), "t,i_ax[m/s^2],i_ay[m/s^2],i_az[m/s^2],i_gx,i_gy,i_gz\n0,0,0,1,0,0,0\n0.01,0,0,1,0,0,0\n");
  write(in("dead.csv"), "t,i_ax,i_ay,i_az,i_gx,i_gy,i_gz\n0,0,0,0,0,0,0\n0.01,0,0,0,0,0,0\n");
  const std::pair<const char*, const char*> cases[] = {
      {"orient none.csv -o q.csv", "none.csv: no such file"},
      {"orient imu.csv -o q.csv --filter madgwick", "known are kinfer, kinfer-offline, paper"},
      {"orient imu.csv -o q.csv --sensor arm", "the recording has imu"},
      {"orient g.csv -o q.csv", "the file seems to be in g; write the headers as i_ax[g]"},
      {"orient dead.csv -o q.csv", "no row has a specific force"},
      {"orient imu.csv -o none/q.csv", "does the folder exist"},
  };
  for (const auto& [arguments, sentence] : cases) {
    const Outcome run = kinfer(arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_NE(run.err.find(sentence), std::string::npos) << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(in("q.csv"))) << arguments;
  }
}

TEST_F(Orient, ARecordingIsInspected) {
  const Outcome run = kinfer("inspect imu.csv --allan");
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* words : {"imu.csv: 2000 rows", "100 Hz", "2 rests", "gyro bias at rest", "judged grade: industrial",
                            "Allan deviation of imu over its longest rest", "noise density"})
    EXPECT_NE(run.out.find(words), std::string::npos) << words << "\n" << run.out;
}

TEST_F(Orient, InspectReportsTheFaultsOfARecording) {
  std::string text = as_csv({.seconds = 20, .sampling_rate = 100, .rest = -10}, "imu");
  text += "60,0,0,9.81,0,0,0,0,20,-44\n";
  write(in("odd.csv"), text);
  const Outcome run = kinfer("inspect odd.csv");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("no rest found"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("gap 19.990 s to 60.000 s"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace kinfer::test
