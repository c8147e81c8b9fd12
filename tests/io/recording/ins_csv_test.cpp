// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_csv.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kinfer/base/rng.hpp"
#include "kinfer/io/recording/ins_columns.hpp"
#include "kinfer/io/text/plain_decimal.hpp"

namespace kinfer {
namespace {

const std::string imu_header = "t,imu_ax,imu_ay,imu_az,imu_gx,imu_gy,imu_gz,imu_mx,imu_my,imu_mz\n";

/// `rows` rows of a stationary sensor at 100 Hz, numbered by their time, with some noise so that no row repeats.
std::string still_rows(int rows, double gravity = 9.81, double first = 0.0) {
  std::string text;
  for (int i = 0; i < rows; ++i)
    text += fmt::format("{:.2f},0.0{},0.1,{},0.001,0.002,-0.00{},1.5,20.{},-44\n", first + 0.01 * i, i % 7,
                        gravity + 0.001 * (i % 5), 1 + i % 3, i % 4);
  return text;
}

std::string error_of(const std::string& text) {
  const auto read = parse_ins_csv(text, "imu.csv");
  return read ? "no error" : read.error().what;
}

TEST(InsCsv, RowsBecomeColumnsOfEachSensor) {
  const std::string text =
      "# logger 7\nt,a_ax,a_ay,a_az,a_gx,a_gy,a_gz,boom_2_gx,boom_2_gy,boom_2_gz,boom_2_ax,boom_2_ay,boom_2_az\n"
      "0,1,2,9.5,4,5,6,7,8,9,1,0,9.75\n# a comment\n\n0.01,,,,4.5,nan,6.5,7,8,9,1,0,9.75\r\n";
  const auto read = parse_ins_csv(text, "imu.csv");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->sensors.size(), 2u);
  EXPECT_EQ(read->sensors[1].name, "boom_2");
  EXPECT_EQ(read->loggers[0].time, (std::vector<double>{0, 0.01}));
  EXPECT_EQ(read->sensors[0].acceleration.at(0), Vec3(1, 2, 9.5));
  EXPECT_EQ(read->sensors[1].angular_velocity.at(1), Vec3(7, 8, 9));
  EXPECT_EQ(read->sensors[1].acceleration.at(1), Vec3(1, 0, 9.75));
  EXPECT_EQ(read->sensors[0].faults[1], acceleration_missing | angular_velocity_missing);
  EXPECT_FALSE(read->sensors[0].has_magnetometer());
}

TEST(InsCsv, TheApostropheBeforeAFormulaIsNoPartOfTheSensorsName) {
  const std::string text =
      "t,'=a_ax,'=a_ay,'=a_az,'=a_gx,'=a_gy,'=a_gz,'-b_ax[g],'-b_ay[g],'-b_az[g],'-b_gx,'-b_gy,'-b_gz,"
      "'c_ax,'c_ay,'c_az,'c_gx,'c_gy,'c_gz\n"
      "0,0,0,9.8,1,2,3,0,0,1,4,5,6,0,0,9.8,7,8,9\n0.01,0,0,9.8,1,2,3,0,0,1,4,5,6,0,0,9.8,7,8,9\n";
  EXPECT_TRUE(is_ins_csv(text));
  const auto read = parse_ins_csv(text, "imu.csv");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->sensors.size(), 3u);
  EXPECT_EQ(read->sensors[0].name, "=a");
  EXPECT_EQ(read->sensors[1].name, "-b");
  EXPECT_EQ(read->sensors[2].name, "'c") << "no spreadsheet would run it";
}

TEST(InsCsv, UnitsInBracketsAreConverted) {
  const std::string text =
      "t[ms],s_ax[g],s_ay[g],s_az[g],s_gx[deg/s],s_gy[deg/s],s_gz[deg/s],s_mx[mT],s_my[G],s_mz[uT]\n"
      "0,0,0,1,180,0,0,0.02,0.3,-44\n10,0,0,1,180,0,0,0.02,0.3,-44\n";
  const auto read = parse_ins_csv(text, "imu.csv");
  ASSERT_TRUE(read) << read.error().what;
  const InsSensor& s = read->sensors[0];
  EXPECT_NEAR(read->loggers[0].time[1], 0.01, 1e-15);
  EXPECT_NEAR(s.acceleration.at(0).z(), 9.80665, 1e-6);
  EXPECT_NEAR(s.angular_velocity.at(0).x(), 3.14159265, 1e-6);
  EXPECT_LT((s.field.at(0) - Vec3(20, 30, -44)).norm(), 1e-5);
}

TEST(InsCsv, AWrongHeaderIsAnErrorOfOneSentence) {
  EXPECT_EQ(error_of(""), "imu.csv: the file has no header line");
  EXPECT_EQ(error_of("a,b\n1,2\n"),
            "imu.csv:1: expected a column t (time in s) and columns SENSOR_ax ... SENSOR_gz, found no t");
  EXPECT_EQ(error_of("t,x\n1,2\n"),
            "imu.csv:1: expected columns SENSOR_ax, SENSOR_ay ... SENSOR_gz beside t, found none");
  EXPECT_EQ(error_of("t,i_ax,i_ay,i_gx,i_gy,i_gz\n"), "imu.csv:1: sensor i: the specific force has no column i_az");
  EXPECT_EQ(error_of("t,i_ax,i_ay,i_az\n"), "imu.csv:1: sensor i: the angular rate has no column i_gx, i_gy, i_gz");
  EXPECT_EQ(error_of("t,i_ax,i_ax,i_az\n"), "imu.csv:1: column i_ax appears twice");
  EXPECT_EQ(error_of("t,i_ax[deg],i_ay,i_az\n"),
            "imu.csv:1: column i_ax: expected an acceleration (m/s^2, g), found \"deg\"");
  EXPECT_EQ(error_of("t[min],i_ax,i_ay,i_az\n"), "imu.csv:1: column t: expected a time (s, ms, us), found \"min\"");
  EXPECT_EQ(error_of("t,i_ax[1],i_ay,i_az\n"),
            "imu.csv:1: column i_ax: expected an acceleration (m/s^2, g), found \"1\"");
  EXPECT_EQ(error_of(imu_header), "imu.csv: the file has a header but no rows");
}

TEST(InsCsv, AWrongRowIsNamedWithItsLine) {
  EXPECT_EQ(error_of(imu_header + still_rows(2) + "0.02,1,2,3\n" + still_rows(1, 9.81, 0.03)),
            "imu.csv:4: expected 10 columns, found 4");
  EXPECT_EQ(error_of(imu_header + "0,0,0,9.8,0,0,0,1,20,-44,5\n"),
            "imu.csv:2: expected 10 columns, found 11; are there commas inside numbers (thousands separators, decimal "
            "commas)?");
  EXPECT_EQ(error_of(imu_header + "0,0,x1,9.8,0,0,0,1,20,-44\n"),
            "imu.csv:2: column imu_ay: expected a number, found \"x1\"");
  EXPECT_EQ(error_of(imu_header + ",0,0,9.8,0,0,0,1,20,-44\n"), "imu.csv:2: column t: expected a time, found none");
}

TEST(InsCsv, TimeMustRise) {
  EXPECT_EQ(error_of(imu_header + still_rows(3) + still_rows(1, 9.81, 0.0)),
            "imu.csv:5: the time goes backwards, from 0.02 s to 0 s; is this several recordings in one file?");
  EXPECT_EQ(error_of(imu_header + still_rows(3) + still_rows(1, 9.81, 0.02)),
            "imu.csv:5: duplicate time 0.02 s; the time must be strictly increasing");
}

const std::string header_with_units =
    "t,imu_ax[m/s^2],imu_ay[m/s^2],imu_az[m/s^2],imu_gx[rad/s],imu_gy[rad/s],imu_gz[rad/s],imu_mx,imu_my,imu_mz\n";

TEST(InsCsv, NumbersThatCannotBeInTheStatedUnitAreErrors) {
  EXPECT_EQ(error_of(header_with_units + still_rows(50, 1.0)),
            "imu.csv: imu: gravity reads 1.01 m/s²: the file seems to be in g; write the headers as imu_ax[g], "
            "imu_ay[g], imu_az[g]");
  EXPECT_NE(error_of(header_with_units + still_rows(50, 1000.0)).find("gravity reads 1e+03 m/s², expected about 9.81"),
            std::string::npos);
  std::string fast = header_with_units;
  for (int i = 0; i < 50; ++i) fast += fmt::format("{},0,0,9.8,{},0,0,1,20,-44\n", 0.01 * i, 90 + i);
  EXPECT_NE(error_of(fast).find("the file seems to be in °/s; write the headers as imu_gx[deg/s]"), std::string::npos);
}

TEST(InsCsv, NumbersInAnotherUnitThatTheFileDoesNotStateAreLeftToTheDiagnosis) {
  EXPECT_EQ(error_of(imu_header + still_rows(50, 1.0)), "no error");
  EXPECT_NE(error_of(imu_header + still_rows(50, 55.0)).find("gravity reads 55 m/s²"), std::string::npos)
      << "no known unit";
  EXPECT_NE(error_of(imu_header + still_rows(50, 0.02)).find("hold no gravity"), std::string::npos);
}

TEST(InsCsv, AnImplausibleMagneticFieldIsReportedAndNotUsed) {
  std::string text = imu_header;
  for (int i = 0; i < 50; ++i) text += fmt::format("{},0,0,9.8,0,0,0,1.1,1.4,-1.5\n", 0.01 * i);
  auto read = parse_ins_csv(text, "imu.csv");
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->sensors[0].has_magnetometer());
  ASSERT_EQ(read->remarks.size(), 1u);
  EXPECT_NE(read->remarks[0].find("the magnetic field reads 2.33 µT"), std::string::npos);
  text.replace(text.find("imu_mx"), 6, "imu_mx[1]");
  read = parse_ins_csv(text, "imu.csv");
  EXPECT_TRUE(read->sensors[0].has_magnetometer()) << "arbitrary units, and said so";
}

TEST(InsCsv, AMagneticFieldInGaussIsConverted) {
  std::string text = imu_header;
  for (int i = 0; i < 50; ++i) text += fmt::format("{},0,0,9.8,0,0,0,0.1,0.2,-0.44\n", 0.01 * i);
  const auto read = parse_ins_csv(text, "imu.csv");
  ASSERT_TRUE(read);
  EXPECT_LT((read->sensors[0].field.at(3) - Vec3(10, 20, -44)).norm(), 1e-4);
  EXPECT_NE(read->remarks.at(0).find("taken to be in gauss"), std::string::npos);
}

TEST(InsCsv, AnAllZeroMagnetometerIsReportedAndNotUsed) {
  std::string text = imu_header;
  for (int i = 0; i < 50; ++i) text += fmt::format("{},0,0,9.8,0,0,0,0,0,0\n", 0.01 * i);
  const auto read = parse_ins_csv(text, "imu.csv");
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->sensors[0].has_magnetometer());
  EXPECT_EQ(read->remarks.at(0), "imu: the magnetometer says nothing but zeros: it is not used");
}

TEST(InsCsv, UnusualButUsableInputIsARemark) {
  const auto remarks = [](const std::string& text) {
    const auto read = parse_ins_csv(text, "imu.csv");
    return read ? read->remarks : std::vector<std::string>{read.error().what};
  };
  EXPECT_EQ(remarks(imu_header + still_rows(1)),
            (std::vector<std::string>{"imu.csv: one single row: no motion can be told from it"}));
  EXPECT_EQ(remarks(imu_header + still_rows(50) + "0.5,1,2"),
            (std::vector<std::string>{"imu.csv: the last line is cut off and is not used"}));
  EXPECT_EQ(remarks(imu_header + still_rows(50) + still_rows(50, 9.81, 100.0)),
            (std::vector<std::string>{"imu.csv: 1 gaps in time, the longest 99.5 s: nothing is known in between"}));
  std::string dead = imu_header + still_rows(50);
  for (int i = 50; i < 300; ++i) dead += fmt::format("{},,,,,,,,,\n", 0.01 * i);
  EXPECT_EQ(remarks(dead),
            (std::vector<std::string>{"imu: says nothing after 0.490 s (250 rows): its orientation is held there"}));
  std::string foreign =
      "t,temperature,imu_ax,imu_ay,imu_az,imu_gx,imu_gy,imu_gz\n0,25,0,0,9.8,0,0,0\n0.01,25,0,0,9.8,0,0,0\n";
  EXPECT_EQ(remarks(foreign),
            (std::vector<std::string>{"imu.csv: column temperature is no channel of an INS and is not used"}));
}

class TwoFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder);
    write("one.csv", imu_header + still_rows(5));
    write("two.csv", "t,b_ax,b_ay,b_az,b_gx,b_gy,b_gz\n100,0,0,9.8,0,0,0\n100.5,0,0,9.8,0,0,0\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  void write(const char* name, const std::string& text) const { std::ofstream(folder / name) << text; }
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "kinfer_ins_csv_test";
};

TEST_F(TwoFiles, EachFileIsALoggerWithItsOwnClock) {
  const std::vector<std::filesystem::path> paths{folder / "one.csv", folder / "two.csv"};
  const auto read = read_ins_csv(paths);
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->loggers.size(), 2u);
  EXPECT_EQ(read->loggers[1].name, "two.csv");
  EXPECT_EQ(read->time(read->sensors[1])[1], 100.5);
  EXPECT_EQ(read->sensors[0].rows(), 5u);
}

TEST_F(TwoFiles, ASensorMayBeInOneFileOnly) {
  const std::vector<std::filesystem::path> paths{folder / "one.csv", folder / "one.csv"};
  const auto read = read_ins_csv(paths);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().what.find("sensor imu also appears in one.csv; sensor names must be unique"),
            std::string::npos);
}

TEST_F(TwoFiles, APathThatCannotBeReadIsAnError) {
  EXPECT_EQ(read_ins_csv(folder / "none.csv").error().what, (folder / "none.csv").string() + ": no such file");
  EXPECT_EQ(read_ins_csv(folder).error().what, folder.string() + ": expected a file, found a folder");
  write("empty.csv", "");
  EXPECT_EQ(read_ins_csv(folder / "empty.csv").error().what, (folder / "empty.csv").string() + ": the file is empty");
}

TEST(PlainDecimal, EqualsFromCharsOrIsEmpty) {
  Rng rng(9);
  const std::string letters = "0123456789.-+eE,";
  int read = 0;
  for (int i = 0; i < 200000; ++i) {
    const double number = i % 2 ? rng.uniform(-1e3, 1e3) : rng.normal();
    const std::uint64_t digits = rng.index(i % 2 ? 9 : 17);
    std::string text = i % 2 ? fmt::format("{:.{}f}", number, digits) : fmt::format("{:.{}e}", number, digits);
    if (i % 5 == 0) text[rng.index(text.size())] = letters[rng.index(letters.size())];
    double ours = 0.0, theirs = 0.0;
    const char* end = text.data() + text.size();
    const char* after = read_plain_decimal(text.data(), end, ours);
    if (!after) continue;
    ++read;
    const auto parsed = std::from_chars(text.data(), end, theirs);
    ASSERT_EQ(parsed.ec, std::errc()) << text;
    ASSERT_EQ(parsed.ptr, after) << text;
    ASSERT_EQ(ours, theirs) << text;
  }
  EXPECT_GT(read, 130000);
}

TEST(InsCsv, NoDamagedFileCrashesTheReaderOrGivesInconsistentShapes) {
  Rng rng(4);
  const std::string good = imu_header + still_rows(30);
  const std::string bytes = "0123456789.,-+eE\n\r#\"[]t_agmxyz nan\xff\0";
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = good;
    for (std::uint64_t n = 1 + rng.index(6); n > 0 && !text.empty(); --n) {
      const std::size_t at = rng.index(text.size());
      std::size_t from = 0;
      switch (rng.index(4)) {
        case 0:
          text[at] = bytes[rng.index(bytes.size())];
          break;
        case 1:
          text.erase(at, 1 + rng.index(40));
          break;
        case 2:
          from = rng.index(text.size());
          text.insert(at, text.substr(from, rng.index(60)));
          break;
        default:
          text.resize(at);
      }
    }
    const auto read = parse_ins_csv(text, "imu.csv");
    if (!read) {
      ASSERT_FALSE(read.error().what.empty());
      continue;
    }
    ++accepted;
    for (const InsSensor& s : read->sensors) {
      ASSERT_EQ(s.rows(), read->time(s).size());
      for (const TriadColumns* t : {&s.acceleration, &s.angular_velocity, &s.field})
        for (const auto& axis : t->axis) ASSERT_TRUE(axis.size() == s.rows() || (t == &s.field && axis.empty()));
    }
  }
  EXPECT_GT(accepted, 1000);
}

TEST(InsCsv, AMeasuredRecordingIsRead) {
  const char* data = std::getenv("KINFER_DATA");
  if (!data) GTEST_SKIP() << "KINFER_DATA is not set";
  const auto read = read_ins_csv(std::filesystem::path(data) / "ur5_openaxes" / "circle-150_imu.csv");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->sensors.size(), 2u);
  EXPECT_EQ(read->sensors[0].name, "radius");
  EXPECT_EQ(read->loggers[0].time.size(), 4282u);
  EXPECT_NEAR(median_period(read->loggers[0].time), 0.008, 1e-9);
}

TEST(InsCsv, QuotedNumbersAreNumbers) {
  const std::string text =
      "\"t\",\"s_ax\",\"s_ay\",\"s_az\",\"s_gx\",\"s_gy\",\"s_gz\"\n"
      "\"0\",\"1\",\"2\",\"9.5\",\"4\",\"5\",\"\"\n\"0.01\",1,2,9.5, \"4\" ,5,6\n";
  const auto read = parse_ins_csv(text, "imu.csv");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->loggers[0].time, (std::vector<double>{0, 0.01}));
  EXPECT_EQ(read->sensors[0].acceleration.at(0), Vec3(1, 2, 9.5));
  EXPECT_TRUE(std::isnan(read->sensors[0].angular_velocity.at(0).z()));
  EXPECT_EQ(read->sensors[0].angular_velocity.at(1), Vec3(4, 5, 6));
}

}  // namespace
}  // namespace kinfer
