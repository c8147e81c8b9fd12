// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cli/program.hpp"
#include "kinfer/base/angle.hpp"

namespace kinfer {
namespace {

using test::Outcome;
using test::slurp;
using test::write;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Track : public test::Program {
 protected:
  /// drive/ and machine/: a log, and the machine identified from it.
  void identify(const std::string& more = "") const {
    ASSERT_EQ(kinfer("simulate crane --excitation together --out drive --grade noise --quiet").code, 0);
    const Outcome run = kinfer("identify drive/imu.csv --out machine --quiet " + more);
    ASSERT_EQ(run.code, 0) << run.err;
  }

  /// Runs a shell command inside the test's folder; "kinfer" stands for the program.
  Outcome shell(std::string command) const {
    for (std::size_t at = 0; (at = command.find("kinfer ", at)) != std::string::npos; at += 7)
      command.replace(at, 6, "'" KINFER_PROGRAM "'"), at += sizeof(KINFER_PROGRAM) - 4;
    const int status = std::system(("cd '" + folder_.string() + "' && (" + command + ") >out.txt 2>err.txt").c_str());
    return {WEXITSTATUS(status), slurp(in("out.txt")), slurp(in("err.txt"))};
  }
};

/// Column `name` of a CSV; an empty cell is NaN.
std::vector<double> column(const std::string& csv, const std::string& name) {
  std::stringstream lines(csv);
  std::string line, cell;
  std::getline(lines, line);
  std::stringstream head(line);
  int index = -1;
  for (int i = 0; std::getline(head, cell, ','); ++i)
    if (cell == name) index = i;
  EXPECT_GE(index, 0) << name << " in " << line;
  std::vector<double> values;
  while (std::getline(lines, line)) {
    std::stringstream row(line);
    for (int i = 0; i <= index; ++i) std::getline(row, cell, ',');
    values.push_back(cell.empty() ? std::nan("") : std::stod(cell));
  }
  return values;
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

TEST_F(Track, FollowsTheMachineAndWritesItsFiles) {
  identify();
  const Outcome run = kinfer("track machine drive/imu.csv --out work");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("joint positions tracked over"));
  const std::string csv = slurp(in("work/track.csv"));
  EXPECT_THAT(csv, StartsWith("t[s],q_ins0-ins1[deg],"));
  EXPECT_EQ(lines_of(csv), lines_of(slurp(in("drive/imu.csv")))) << "a row per row";
  EXPECT_THAT(slurp(in("work/evidence.json")), HasSubstr("\"kind\": \"track\""));
  EXPECT_THAT(slurp(in("work/report.html")), HasSubstr("Joint positions over time"));
  EXPECT_TRUE(test::fs::exists(in("work/run.json")));
  const std::string report = slurp(in("work/report.html"));
  EXPECT_EQ(kinfer("report work --quiet").code, 0);
  EXPECT_EQ(slurp(in("work/report.html")), report) << "made of evidence.json alone";
  // The luffing joint against the truth, both from the start of the log.
  const std::vector<double> found = column(csv, "q_ins1-ins2[deg]"),
                            truth = column(slurp(in("drive/motion.csv")), "q_luff");
  ASSERT_EQ(found.size(), truth.size());
  const std::size_t rest = 600;  // at 3 s; it rests for four
  double worst = 0.0, product = 0.0;
  for (std::size_t i = rest; i < found.size(); ++i) product += (found[i] - found[rest]) * (truth[i] - truth[rest]);
  const double sense = product < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = rest; i < found.size(); ++i)
    worst = std::max(worst, std::abs(sense * (found[i] - found[rest]) - (truth[i] - truth[rest]) / degree));
  EXPECT_LT(worst, 0.2) << "[deg]";
}

TEST_F(Track, GivesTheSameRowsHoweverTheLogArrives) {
  identify();
  ASSERT_EQ(shell("kinfer track machine drive/imu.csv --quiet > file.csv").code, 0);
  ASSERT_EQ(shell("dd if=drive/imu.csv bs=777 status=none | kinfer track machine - --quiet > input.csv").code, 0);
  ASSERT_EQ(
      shell("head -c 100000 drive/imu.csv > growing.csv; kinfer track machine growing.csv --follow --quiet > "
            "followed.csv & sleep 0.5; tail -c +100001 drive/imu.csv >> growing.csv; for i in $(seq 600); do "
            "[ $(wc -c < followed.csv) -ge $(wc -c < file.csv) ] && break; sleep 0.1; done; kill -INT $!; wait $!")
          .code,
      0);
  const std::string file = slurp(in("file.csv"));
  EXPECT_GT(lines_of(file), 1000u);
  EXPECT_EQ(slurp(in("input.csv")), file);
  EXPECT_EQ(slurp(in("followed.csv")), file);
  const Outcome lines = shell("head -3 drive/imu.csv | kinfer track machine - --json --quiet");
  EXPECT_EQ(lines_of(lines.out), 2u);
  EXPECT_THAT(lines.out, StartsWith("{\"t\":0,\"q\":["));
}

/// The start was sought again and again from where the rows before had put it, and ended 700° off on every second
/// slope.
TEST_F(Track, BeginsOnAnySlope) {
  ASSERT_EQ(kinfer("simulate excavator-general --out level --quiet").code, 0);
  ASSERT_EQ(kinfer("identify level/imu.csv --out machine --quiet").code, 0);
  for (const std::string slope : {"7", "13"}) {
    ASSERT_EQ(kinfer("simulate excavator-general --drive 2 --out drive --quiet --slope " + slope).code, 0);
    const Outcome run = kinfer("track machine drive/imu.csv --out work");
    EXPECT_EQ(run.code, 0) << slope;
    EXPECT_THAT(run.out, HasSubstr("no alarm")) << slope;
  }
}

TEST_F(Track, FollowsALogThatIsRotated) {
  identify();
  ASSERT_EQ(shell("kinfer track machine drive/imu.csv --quiet > file.csv").code, 0);
  const std::string file = slurp(in("file.csv"));
  const auto after = [](std::size_t rows) {
    return "for i in $(seq 600); do [ $(wc -l < followed.csv) -ge " + std::to_string(rows) +
           " ] && break; sleep 0.1; done; ";
  };
  for (const std::string rotate :
       {": > growing.csv; (head -1 drive/imu.csv; tail -n +1502 drive/imu.csv) >> growing.csv; ",
        "mv growing.csv old.csv; (head -1 drive/imu.csv; tail -n +1502 drive/imu.csv) > new; "
        "mv new growing.csv; "}) {
    const Outcome run = shell(
        ": > followed.csv; head -1501 drive/imu.csv > growing.csv; kinfer track machine growing.csv --follow > "
        "followed.csv 2> said.txt & " +
        after(1501) + rotate + after(lines_of(file)) + "kill -INT $!; wait $!");
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(slurp(in("followed.csv")), file);
    EXPECT_THAT(slurp(in("said.txt")), HasSubstr("growing.csv: the log began anew after "));
  }
  const Outcome again = shell(
      ": > followed.csv; head -1501 drive/imu.csv > growing.csv; kinfer track machine growing.csv --follow --quiet > "
      "followed.csv & " +
      after(1501) + ": > growing.csv; sleep 0.2; head -300 drive/imu.csv >> growing.csv; wait $!");
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("the log began anew, and its time with it"));
}

TEST_F(Track, SmoothsAWholeLog) {
  identify();
  const Outcome run = kinfer("track machine drive/imu.csv --out work --smooth");
  EXPECT_EQ(run.code, 0) << run.err;
  const std::string csv = slurp(in("work/track.csv"));
  EXPECT_EQ(lines_of(csv), lines_of(slurp(in("drive/imu.csv")))) << "a row per row";
  ASSERT_EQ(kinfer("track machine drive/imu.csv --out filtered --quiet").code, 0);
  const auto sum_of_sd = [&](const std::string& file) {
    double sum = 0.0;
    for (const double sd : column(slurp(in(file)), "sd_q_ins1-ins2[deg]"))
      if (std::isfinite(sd)) sum += sd;
    return sum;
  };
  EXPECT_LT(sum_of_sd("work/track.csv"), sum_of_sd("filtered/track.csv"));
  const Outcome follow = kinfer("track machine drive/imu.csv --smooth --follow");
  EXPECT_EQ(follow.code, 2);
  EXPECT_THAT(follow.err, HasSubstr("--smooth needs the whole log"));
}

TEST_F(Track, PutsRowsThatComeLateInOrder) {
  identify();
  ASSERT_EQ(kinfer("track machine/chain.toml drive/imu.csv --out work --quiet").code, 0);
  // Every third row one place later, and one far too late.
  ASSERT_EQ(
      shell(
          "awk 'NR>1 && NR%3==0 { held=$0; next } { print } held { print held; held=\"\" }' drive/imu.csv > late.csv; "
          "sed -n 500p drive/imu.csv >> late.csv")
          .code,
      0);
  EXPECT_THAT(kinfer("track machine late.csv").err, HasSubstr("the time goes backwards"));
  const Outcome run = kinfer("track machine late.csv --out ordered --reorder 20");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("1 rows came more than 20 ms late and were left out"));
  EXPECT_EQ(slurp(in("ordered/track.csv")), slurp(in("work/track.csv")));
}

TEST_F(Track, BadInputIsOneSentence) {
  identify("--zero ins2=10deg@1s");
  EXPECT_THAT(kinfer("track nowhere drive/imu.csv").err, HasSubstr("nowhere: expected a folder that kinfer identify"));
  EXPECT_THAT(kinfer("track machine drive/none.csv").err, HasSubstr("drive/none.csv: no such file"));
  EXPECT_THAT(kinfer("track machine drive/imu.csv --start 1,2").err, HasSubstr("--start: the robot has"));
  EXPECT_THAT(kinfer("track machine drive/imu.csv drive/imu.csv --follow").err, HasSubstr("--follow: needs a single"));
  EXPECT_THAT(shell("cut -d, -f1-10 drive/imu.csv > few.csv; kinfer track machine few.csv").err,
              HasSubstr("the chain has a sensor ins1, the log has none of that name; it has ins0"));
  EXPECT_THAT(
      shell("head -5 drive/imu.csv > back.csv; sed -n 3p drive/imu.csv >> back.csv; kinfer track machine back.csv").err,
      HasSubstr("back.csv:6: the time goes backwards"));
  const Outcome cut = shell("head -c 400000 drive/imu.csv | kinfer track machine -");
  EXPECT_EQ(cut.code, 0);
  EXPECT_THAT(cut.err, HasSubstr("standard input: the last line is cut off and is not used"));
  EXPECT_EQ(kinfer("track machine drive/imu.csv --quiet --out t --start nan,nan,nan,nan").code, 0)
      << "nan: a position that is not known";
  EXPECT_THAT(kinfer("track machine drive/imu.csv --out t --base-at 1e300,0,0,0").err,
              HasSubstr("is not possible for a length"));
  EXPECT_THAT(kinfer("track machine drive/imu.csv --out machine").err, HasSubstr("machine: is read, too"));
  EXPECT_EQ(shell("timeout -s TERM 0.05 kinfer track machine drive/imu.csv --out killed").code, 124);
  EXPECT_FALSE(test::fs::exists(in("killed"))) << "an interrupt is no end of a whole log";
  test::fs::remove(in("machine/track.toml"));
  EXPECT_THAT(kinfer("track machine drive/imu.csv").err,
              HasSubstr("machine: the chain has no tracking data, track.toml"));
}

TEST_F(Track, NamedZerosAreKept) {
  identify("--zero ins2=10deg@1s");
  EXPECT_THAT(kinfer("identify drive/imu.csv --out other --zero ins9=10deg@1s").err,
              HasSubstr("--zero ins9: no joint position of that name; the machine has ins0-ins1"));
  EXPECT_THAT(kinfer("identify drive/imu.csv --out other --zero ins2=10mm@1s").err, HasSubstr("the joint rotates"));
  EXPECT_THAT(kinfer("identify drive/imu.csv --out other --zero ins2=10deg@900s").err,
              HasSubstr("outside the recording"));
  EXPECT_THAT(kinfer("identify drive/imu.csv --out other --zero ins2=10deg").err, HasSubstr("expected a joint"));
  const Outcome run = kinfer("track machine drive/imu.csv --out work --quiet");
  const std::string csv = slurp(in("work/track.csv"));
  const std::vector<double> time = column(csv, "t[s]"), q = column(csv, "q_ins1-ins2[deg]");
  const auto at = static_cast<std::size_t>(std::ranges::lower_bound(time, 3.0) - time.begin());
  EXPECT_NEAR(q[at], 10.0, 0.5) << "the machine is at rest for four seconds";
}

}  // namespace
}  // namespace kinfer
