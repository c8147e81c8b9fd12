// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>
#include <zstd.h>

#include <fstream>

#include "io/recording/foreign_samples.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/io/recording/foreign/foreign_log.hpp"
#include "kinfer/io/recording/foreign/header_guess.hpp"
#include "kinfer/io/recording/foreign/ins_presets.hpp"
#include "kinfer/io/recording/recording_formats.hpp"
#include "support/zip_writer.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using namespace test;

class ForeignLogs : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder / "phone"); }
  void TearDown() override { fs::remove_all(folder); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  Result<InsRecording> read(const std::vector<fs::path>& paths) const { return read_recording(paths); }
  std::string error_of(const std::string& text, const std::string& map = "") const {
    const std::vector<fs::path> log{write("log.csv", text)};
    const auto result = map.empty() ? read_recording(log) : read_mapped_recording(log, write("map.toml", map));
    return result ? "" : result.error().what;
  }

  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_foreign_logs_" + std::to_string(getpid()));
};

/// The samples of the motion, in SI; the field's unit may be arbitrary.
void expect_motion(const Result<InsRecording>& read, const std::string& name, double rate_of_row = sample_rate) {
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->sensors.size(), 1U);
  const InsSensor& sensor = read->sensors[0];
  EXPECT_EQ(sensor.name, name);
  ASSERT_EQ(sensor.rows(), static_cast<std::size_t>(sample_rows));
  for (const int row : {0, 1, sample_rows - 1}) {
    EXPECT_LT((sensor.acceleration.at(row) - sample_force(row)).norm(), 1e-4) << row;
    EXPECT_LT((sensor.angular_velocity.at(row) - sample_rates(row)).norm(), 1e-5) << row;
    if (sensor.has_magnetometer()) {
      EXPECT_LT(angle_between(sensor.field.at(row), sample_field(row)), 1e-5) << row;
    }
  }
  const auto& time = read->loggers[0].time;
  EXPECT_NEAR(time.back() - time.front(), (sample_rows - 1) / rate_of_row, 1e-6);
}

TEST_F(ForeignLogs, XsensTextWithAnEmptyClockAndACounterThatWraps) {
  expect_motion(read({write("MT_00B42D0F.txt", xsens_txt())}), "MT_00B42D0F");
}

TEST_F(ForeignLogs, MovellaDotInDegreesWithAClockThatWraps) {
  expect_motion(read({write("DOT_1.csv", movella_dot())}), "DOT_1");
}

TEST_F(ForeignLogs, XioInDegreesAndG) {
  fs::create_directories(folder / "left");
  expect_motion(read({write("left/Inertial.csv", x_io())}), "left");
}

TEST_F(ForeignLogs, MicrostrainWithTimesOfDay) {
  expect_motion(read({write("node.csv", microstrain())}), "node");
}

TEST_F(ForeignLogs, SbgInDegreesWithALineOfUnitsBelowTheHeader) {
  expect_motion(read({write("imuData.txt", sbg_text())}), "imuData");
}

TEST_F(ForeignLogs, VectorNavMessagesAreRowsAtTheMakersRate) {
  constexpr double default_rate = 40.0;  // [Hz]
  for (const auto& [name, text] : {std::pair("imu", vectornav_imu()), std::pair("ymr", vectornav_ymr())}) {
    const auto log = read({write(std::string(name) + ".txt", text)});
    expect_motion(log, name, default_rate);
    ASSERT_FALSE(log->remarks.empty());
    EXPECT_NE(log->remarks.back().find("40 rows a second"), std::string::npos) << log->remarks.back();
  }
}

TEST_F(ForeignLogs, CompressedTextIsReadAsItIs) {
  const std::string text = x_io();
  std::string packed(ZSTD_compressBound(text.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), text.data(), text.size(), 3));
  fs::create_directories(folder / "left");
  expect_motion(read({write("left/Inertial.csv.zst", packed)}), "left");
  EXPECT_NE(read({write("cut.csv.zst", packed.substr(0, packed.size() - 20))}).error().what.find("is cut off"),
            std::string::npos);
}

TEST_F(ForeignLogs, APhonesFolderAndItsZipAreOneSensor) {
  fs::create_directories(folder / "phone");
  write("phone/Accelerometer.csv", phyphox("Accelerometer")), write("phone/Gyroscope.csv", phyphox("Gyroscope"));
  write("phone/device.csv", "\"property\";\"value\"\n\"model\";\"x\"\n");
  const auto by_folder = read({folder / "phone"});
  ASSERT_TRUE(by_folder) << by_folder.error().what;
  const fs::path archive = write("phone.zip", zip_of({{"Accelerometer.csv", phyphox("Accelerometer")},
                                                      {"Gyroscope.csv", phyphox("Gyroscope")},
                                                      {"meta/device.csv", "\"property\";\"value\"\n"}}));
  EXPECT_TRUE(is_recording(archive));
  const auto by_zip = read({archive});
  ASSERT_TRUE(by_zip) << by_zip.error().what;
  ASSERT_EQ(by_zip->sensors.size(), 1U);
  EXPECT_EQ(by_zip->sensors[0].name, "phone");
  EXPECT_EQ(by_zip->sensors[0].rows(), by_folder->sensors[0].rows());
}

TEST_F(ForeignLogs, ZipArchivesThatLieAreRefused) {
  const auto refusal = [&](const std::string& bytes) { return read({write("bad.zip", bytes)}).error().what; };
  const auto has = [](const std::string& sentence, const char* words) {
    return sentence.find(words) != std::string::npos;
  };
  const std::string good = zip_of({{"Gyroscope.csv", phyphox("Gyroscope")}});
  EXPECT_TRUE(
      has(refusal(zip_of({{"../Gyroscope.csv", "x"}})), "names a file \"../Gyroscope.csv\", which leads out of it"));
  EXPECT_TRUE(has(refusal(zip_of({{"/etc/Gyroscope.csv", "x"}})), "leads out of it"));
  EXPECT_TRUE(has(refusal(good.substr(0, good.size() - 30)), "it has no directory"));
  EXPECT_TRUE(has(refusal(zip_of({{"readme.md", "x"}})), "no file in it is known as a log"));
  std::string lying = good;
  const std::size_t size = lying.find("PK\x01\x02") + 24;
  lying[size] = '\1', lying[size + 1] = '\0', lying[size + 2] = '\0';
  EXPECT_TRUE(has(refusal(lying), "it states 1 bytes, but holds more"));
  lying.replace(size, 4, "\xF0\xFF\xFF\xFF");
  EXPECT_TRUE(has(refusal(lying), "bytes; more than 1073741824 are not read"));
}

TEST_F(ForeignLogs, PhyphoxInTwoFilesIsOneSensorOnTheRowsOfBoth) {
  const auto log = read(
      {write("phone/Accelerometer.csv", phyphox("Accelerometer")), write("phone/Gyroscope.csv", phyphox("Gyroscope"))});
  ASSERT_TRUE(log) << log.error().what;
  ASSERT_EQ(log->sensors.size(), 1U);
  const InsSensor& phone = log->sensors[0];
  EXPECT_EQ(phone.name, "phone");
  ASSERT_EQ(phone.rows(), 2U * sample_rows);
  EXPECT_LT((phone.acceleration.at(2) - sample_force(1)).norm(), 1e-5);
  EXPECT_LT((phone.angular_velocity.at(3) - sample_rates(1)).norm(), 1e-5);
  EXPECT_TRUE(std::isnan(phone.angular_velocity.at(2).x())) << "each row holds one instrument";
}

TEST_F(ForeignLogs, SensorLoggerHasItsColumnsInTheOrderZYX) {
  expect_motion(read({write("phone/TotalAcceleration.csv", sensor_logger(sample_force, 1.0)),
                      write("phone/Gyroscope.csv", sensor_logger(sample_rates, 1.0)),
                      write("phone/Magnetometer.csv", sensor_logger(sample_field, 1.0))}),
                "phone");
}

TEST_F(ForeignLogs, AnInstrumentAloneNamesWhatIsMissing) {
  const auto log = read({write("phone/Accelerometer.csv", phyphox("Accelerometer"))});
  ASSERT_FALSE(log);
  EXPECT_NE(
      log.error().what.find("sensor phone has no angular rate (gyroscope); where it stands in another file, give both"),
      std::string::npos)
      << log.error().what;
}

TEST_F(ForeignLogs, FreeAccelerationIsRefusedByName) {
  std::string free = movella_dot();
  for (std::size_t at; (at = free.find("Acc_")) != std::string::npos;) free.replace(at, 4, "FreeA_");
  for (std::size_t at; (at = free.find("FreeA_")) != std::string::npos;) free.replace(at, 6, "FreeAcc_");
  const auto log = read({write("free.csv", free)});
  ASSERT_FALSE(log);
  EXPECT_NE(log.error().what.find("free acceleration (FreeAcc), from which gravity is removed"), std::string::npos);
  write("phone/Accelerometer.csv", sensor_logger(sample_force, 1.0));
  EXPECT_NE(read({folder / "phone/Accelerometer.csv"}).error().what.find("holds no gravity"), std::string::npos);
}

TEST_F(ForeignLogs, OurOwnColumnsWithAnotherDelimiterAndDecimalCommasAreRead) {
  const std::string text = lines("t;a_ax;a_ay;a_az;a_gx;a_gy;a_gz\n", [](int row) {
    std::string line =
        fmt::format("{:.3f};{};{}", row / sample_rate, three(sample_force(row), ";"), three(sample_rates(row), ";"));
    std::ranges::replace(line, '.', ',');
    return line;
  });
  expect_motion(read({write("semicolons.csv", text)}), "a");
}

TEST_F(ForeignLogs, SeveralSensorsInOneFileAreToldByTheirNames) {
  const std::string text = lines(
      "time\tboom AccX\tboom AccY\tboom AccZ\tboom GyrX\tboom GyrY\tboom GyrZ\tstick AccX\tstick AccY\tstick "
      "AccZ\tstick GyrX\tstick GyrY\tstick GyrZ\n",
      [](int row) {
        const std::string one = three(sample_force(row), "\t") + "\t" + three(sample_rates(row), "\t");
        return fmt::format("{}\t{}\t{}", row / sample_rate, one, one);
      });
  const auto log = read({write("two.txt", text)});
  ASSERT_TRUE(log) << log.error().what;
  ASSERT_EQ(log->sensors.size(), 2U);
  EXPECT_EQ(log->sensors[0].name, "boom");
  EXPECT_EQ(log->sensors[1].name, "stick");
}

constexpr const char* map_by_number = R"(header = "none"
comment = "%"
sensor = "arm"
clock = { column = "#1", rate = 100, wraps = 256 }
axes = ["-y", "x", "z"]
[columns]
ax = "#2 [g]"
ay = "#3 [g]"
az = "#4 [g]"
gx = "#5 [deg/s]"
gy = "#6 [deg/s]"
gz = "#7 [deg/s]"
[sign]
force = -1
)";

TEST_F(ForeignLogs, AMapReadsAFileWithoutHeaderInOtherAxesAndSigns) {
  const std::string text = lines("% a maker's file\n", [](int row) {
    const Vec3 f = sample_force(row), w = sample_rates(row);  // theirs: x = our y, y = our -x
    return fmt::format("{}  {}  {}", (250 + row) % 256, three(-Vec3(f.y(), -f.x(), f.z()), "  ", standard_gravity),
                       three(Vec3(w.y(), -w.x(), w.z()), "  ", degree));
  });
  expect_motion(read_mapped_recording(std::vector<fs::path>{write("raw.txt", text)}, write("map.toml", map_by_number)),
                "arm");
}

TEST_F(ForeignLogs, BadInputGetsOneSentence) {
  const std::string good = "time;AccX;AccY;AccZ;GyrX;GyrY;GyrZ\n";
  const auto has = [](const std::string& sentence, const char* words) {
    return sentence.find(words) != std::string::npos;
  };
  EXPECT_TRUE(has(error_of(good + "0;1;2;9;0;0;0\n0.01;1;x;9;0;0;0\n"),
                  "log.csv:3: column AccY: expected a number, found \"x\""));
  EXPECT_TRUE(has(error_of(good + "0;1;2;9;0;0;0\n0.01;1;2\n"), "log.csv:3: expected 7 columns, found 3"));
  EXPECT_TRUE(has(error_of(good + "1;1;2;9;0;0;0\n0.01;1;2;9;0;0;0\n"),
                  "log.csv:3: the time goes backwards, from 1 s to 0.01 s"));
  EXPECT_TRUE(has(error_of(good), "log.csv: the file has a header but no rows with a time"));
  EXPECT_TRUE(has(error_of(good, "header = \"Packet\""), "log.csv: the file has no line with \"Packet\""));
  EXPECT_TRUE(has(error_of(good, "[columns]\nt = \"time\"\nax = \"Beschl_X\""), "no column is named \"Beschl_X\""));
  EXPECT_TRUE(
      has(error_of(good, "[columns]\nspeed = \"AccX\""), "the column map has \"speed\", expected t, or SENSOR_ax"));
  EXPECT_TRUE(
      has(error_of(good, "axes = [\"x\", \"x\", \"z\"]"), "map.toml:1: \"axes\": expected three different axes"));
  EXPECT_TRUE(has(error_of(good, "[sign]\nforce = 2"), "expected 1 or -1"));
  EXPECT_TRUE(has(error_of("\xFF\xFE" + good, "comment = \"%\""), "the file is UTF-16, expected UTF-8"));
  EXPECT_TRUE(has(error_of("a;b;c\n1;2;3\n", "comment = \"%\""), "no column is known as that of an accelerometer"));
}

TEST(HeaderGuess, InstrumentsAreToldByTheWordsOfTheirMakers) {
  const auto kind = [](const char* name) { return guess_column(name).kind; };
  EXPECT_EQ(kind("Acceleration x"), ChannelKind::force);
  EXPECT_EQ(kind("Gyr_Y"), ChannelKind::rate);
  EXPECT_EQ(kind("X Accel"), ChannelKind::force);
  EXPECT_EQ(kind("Magnetic field z"), ChannelKind::field);
  EXPECT_EQ(kind("angular_velocity.z"), ChannelKind::rate);
  EXPECT_EQ(kind("linear_acceleration.x"), ChannelKind::free_acceleration);
  EXPECT_EQ(kind("FreeAcc_E"), ChannelKind::other);
  EXPECT_EQ(kind("Absolute acceleration"), ChannelKind::other);
  EXPECT_EQ(kind("x"), ChannelKind::other);
  EXPECT_EQ(guess_column("IMU 2 Acc_X").sensor, "IMU 2");
  EXPECT_EQ(guess_column("boom_gz").sensor, "boom");
}

TEST(InsPresets, AllCanBeReadAndHaveATitle) {
  EXPECT_GE(ins_presets().size(), 16U);
  for (const InsMap& preset : ins_presets()) EXPECT_FALSE(preset.title.empty() || preset.recognise.empty());
}

TEST(ForeignLogMutations, AnyBytesAreReadOrRefusedWithOneSentence) {
  constexpr std::string_view bytes = "0123456789.,-+eE\n\r#\"[]()/t_;\tagmxyz nan:\xff";
  const std::vector<std::string> samples{xsens_txt(), movella_dot(), phyphox("Gyroscope"), x_io(), microstrain()};
  Rng rng(5);
  int accepted = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = samples[static_cast<std::size_t>(i) % samples.size()];
    for (std::uint64_t n = 1 + rng.index(6); n > 0 && !text.empty(); --n) {
      const std::size_t at = rng.index(text.size());
      if (rng.index(2))
        text[at] = bytes[rng.index(bytes.size())];
      else
        text.erase(at, 1 + rng.index(30));
    }
    const InsMap* preset = find_preset(text, "log.csv");
    auto log = parse_foreign_log(text, "log.csv", preset ? *preset : InsMap{});
    if (!log) {
      ASSERT_EQ(log.error().what.rfind("log.csv", 0), 0U) << log.error().what;
      continue;
    }
    ++accepted;
    for (const InsSensor& sensor : log->sensors)
      for (const TriadColumns* triad : {&sensor.acceleration, &sensor.angular_velocity, &sensor.field})
        ASSERT_TRUE(!triad->present() || triad->axis[0].size() == log->time.size());
  }
  EXPECT_GT(accepted, 50);
}

TEST(ForeignLogMutations, AnyMapIsReadOrRefused) {
  Rng rng(6);
  for (int i = 0; i < 2000; ++i) {
    std::string text = map_by_number;
    for (int n = 0; n < 3; ++n) text[rng.index(text.size())] = "[]{}=\"#\n,-.019ax"[rng.index(16)];
    const auto map = parse_ins_map(text, "map.toml");
    if (!map) {
      ASSERT_EQ(map.error().what.rfind("map.toml", 0), 0U) << map.error().what;
    }
  }
}

}  // namespace
}  // namespace kinfer
