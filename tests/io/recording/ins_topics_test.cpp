// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_topics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <fstream>

#include "kinfer/base/rng.hpp"
#include "kinfer/io/recording/ins_mcap.hpp"
#include "kinfer/io/recording/recording_formats.hpp"
#include "kinfer/io/robot_log/mcap_writer.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"
#include "support/ros_messages.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RobotLog : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  fs::path write(const char* name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return folder / name;
  }
  static Result<InsRecording> read(const fs::path& path) { return read_recording(std::span(&path, 1)); }
  static std::string slurp(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_robot_log_" + std::to_string(getpid()));
};

/// Two loggers, three sensors, one without magnetometer, some values missing.
InsRecording example_recording() {
  InsRecording recording;
  Rng rng(4);
  recording.loggers = {{.name = "a", .time = {}}, {.name = "b", .time = {}}};
  for (int row = 0; row < 400; ++row) {
    recording.loggers[0].time.push_back(0.005 * row);
    recording.loggers[1].time.push_back(0.01 * row + 0.002);
  }
  for (const char* name : {"boom", "arm", "bucket"}) {
    InsSensor sensor{.name = name,
                     .logger = recording.sensors.size() == 2,
                     .acceleration = {},
                     .angular_velocity = {},
                     .field = {},
                     .faults = {}};
    for (std::size_t k = 0; k < 3; ++k)
      for (int row = 0; row < 400; ++row) {
        sensor.acceleration.axis[k].push_back(static_cast<float>((k == 2 ? 9.8 : 0.0) + 0.1 * rng.normal()));
        sensor.angular_velocity.axis[k].push_back(static_cast<float>(0.1 * rng.normal()));
        if (sensor.name != "arm") sensor.field.axis[k].push_back(static_cast<float>(20.0 + rng.normal()));
      }
    sensor.angular_velocity.axis[1][7] = std::numeric_limits<float>::quiet_NaN();
    flag_faults(sensor);
    recording.sensors.push_back(sensor);
  }
  return recording;
}

TEST_F(RobotLog, AnInsRecordingComesBackFromMcap) {
  const InsRecording written = example_recording();
  ASSERT_TRUE(write_ins_mcap(folder / "log.mcap", written));
  const auto found = read(folder / "log.mcap");
  ASSERT_TRUE(found) << found.error().what;
  ASSERT_EQ(found->sensors.size(), 3u);
  for (std::size_t s = 0; s < 3; ++s) {
    const InsSensor &was = written.sensors[s], &is = found->sensors[s];
    EXPECT_EQ(is.name, was.name);
    ASSERT_EQ(is.rows(), was.rows());
    EXPECT_EQ(is.faults, was.faults) << was.name;
    EXPECT_EQ(is.has_magnetometer(), was.has_magnetometer());
    EXPECT_TRUE(share_clock(*found, 0, is.logger));
    for (std::size_t row = 0; row < was.rows(); ++row) {
      EXPECT_NEAR(found->time(is)[row], written.time(was)[row], 1e-9);
      for (std::size_t k = 0; k < 3; ++k) {
        if (row != 7) {
          EXPECT_EQ(is.angular_velocity.axis[k][row], was.angular_velocity.axis[k][row]);
        }
        EXPECT_EQ(is.acceleration.axis[k][row], was.acceleration.axis[k][row]);
        if (was.has_magnetometer()) {
          EXPECT_NEAR(is.field.axis[k][row], was.field.axis[k][row], 1e-4);
        }
      }
    }
  }
}

TEST_F(RobotLog, NamesComeBackFromMcapWhateverIsInThem) {
  InsRecording written = example_recording();
  const std::array names{"a/b", "a/c d", "imu"};
  for (std::size_t s = 0; s < 3; ++s) written.sensors[s].name = names[s];
  ASSERT_TRUE(write_ins_mcap(folder / "log.mcap", written));
  const auto found = read(folder / "log.mcap");
  ASSERT_TRUE(found) << found.error().what;
  for (std::size_t s = 0; s < 3; ++s) EXPECT_EQ(found->sensors[s].name, names[s]);
  EXPECT_TRUE(found->loggers[0].states_unit);
}

std::string bag_records(int rows) {
  std::string records = test::bag_connection(0, "/boom/imu/data", "sensor_msgs/Imu", "") +
                        test::bag_connection(1, "/arm/imu/data", "sensor_msgs/Imu", "") +
                        test::bag_connection(2, "/chatter", "std_msgs/String", "string data\n");
  for (int row = 0; row < rows; ++row) {
    const auto ns = static_cast<std::uint32_t>(10'000'000 * row);
    records += test::bag_message(0, 100, ns + 5000, test::ros1_imu(100, ns, "boom", {0.1, 0, 0}, {0, 0, 9.8}));
    records += test::bag_message(2, 100, ns, test::with_length("hello"));
    records += test::bag_message(1, 100, ns, test::ros1_imu(0, 0, "arm", {0, 0.2, 0}, {0, 9.8, 0}));
  }
  return records;
}

TEST_F(RobotLog, BagsOfEveryCompressionAreReadAlike) {
  const std::string records = bag_records(50);
  for (const char* method : {"none", "bz2", "lz4", "zstd"}) {
    const auto found = read(write("drive.bag", test::bag_of(test::bag_chunk(method, records))));
    ASSERT_TRUE(found) << method << found.error().what;
    ASSERT_EQ(found->sensors.size(), 2u);
    EXPECT_EQ(found->sensors[0].name, "boom");
    EXPECT_EQ(found->sensors[1].name, "arm");
    ASSERT_EQ(found->sensors[1].rows(), 50u);
    EXPECT_FLOAT_EQ(found->sensors[1].angular_velocity.axis[1][3], 0.2f);
    EXPECT_NEAR(found->time(found->sensors[0])[49], 0.49, 1e-9);
    EXPECT_NEAR(found->time(found->sensors[1])[49], 0.49, 1e-9) << "without a stamp the time of the log counts";
  }
}

TEST_F(RobotLog, ADb3IsReadWithoutDefinitions) {
  const fs::path path = folder / "drive.db3";
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database,
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, "
               "offered_qos_profiles TEXT);"
               "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
               "INSERT INTO topics VALUES(1, '/imu/data', 'sensor_msgs/msg/Imu', 'cdr', '');"
               "INSERT INTO topics VALUES(2, '/unknown', 'my_msgs/msg/Strange', 'cdr', '');",
               nullptr, nullptr, nullptr);
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)", -1, &insert, nullptr);
  for (int row = 0; row < 20; ++row) {
    CdrMessage imu;
    imu.time(1'000'000'000 + 5'000'000 * row).text("base");
    for (int i = 0; i < 4 + 9; ++i) imu.number(0.0);
    for (const double v : {0.5, 0.0, 0.0}) imu.number(v);
    for (int i = 0; i < 9; ++i) imu.number(i == 0 ? -1.0 : 0.0);  // the rates are not measured
    for (const double v : {0.0, 0.0, 9.8}) imu.number(v);
    for (int i = 0; i < 9; ++i) imu.number(0.0);
    sqlite3_bind_int64(insert, 1, row);
    sqlite3_bind_blob(insert, 2, imu.bytes().data(), static_cast<int>(imu.bytes().size()), SQLITE_TRANSIENT);
    sqlite3_step(insert), sqlite3_reset(insert);
  }
  sqlite3_finalize(insert), sqlite3_close(database);
  InsRecording found;
  const auto done = append_all_ins_topics(path, found);
  ASSERT_TRUE(done) << done.error().what;
  ASSERT_EQ(found.sensors.size(), 1u);
  EXPECT_EQ(found.sensors[0].rows(), 20u);
  EXPECT_NEAR(found.time(found.sensors[0])[19], 0.095, 1e-9);
  EXPECT_EQ(count(found.sensors[0], angular_velocity_missing), 20u) << "covariance −1: not measured";
}

TEST_F(RobotLog, DamageIsOneSentenceAndTruncationLosesOnlyTheEnd) {
  const std::string bag = test::bag_of(bag_records(50));
  const auto cut = read(write("cut.bag", bag.substr(0, bag.size() - 100)));
  ASSERT_TRUE(cut) << cut.error().what;
  EXPECT_EQ(cut->sensors[0].rows(), 50u);
  EXPECT_EQ(cut->sensors[1].rows(), 49u);
  EXPECT_THAT(cut->remarks.front(), HasSubstr("ends in the middle of a record"));
  const auto what = [&](const std::string& bytes) {
    const auto found = read(write("bad.bag", bytes));
    return found ? "" : found.error().what;
  };
  EXPECT_THAT(what("#ROSBAG V1.2\n"), HasSubstr("expected a ROS bag of version 2.0, found \"#ROSBAG V1.2\""));
  EXPECT_THAT(what(test::bag_of(test::bag_chunk("zst", bag_records(1)))), HasSubstr("compression \"zst\" is unknown"));
  const std::string lie = test::bag_record(test::bag_field("op", "\x05") + test::bag_field("compression", "lz4") +
                                               test::bag_field("size", test::raw_bytes(std::uint32_t{4'000'000'000u})),
                                           "x");
  EXPECT_THAT(what(test::bag_of(lie)), HasSubstr("a chunk states a size of 4000000000 bytes"));
  std::string damaged = test::bag_chunk("lz4", bag_records(5));
  for (std::size_t i = damaged.size() - 60; i < damaged.size() - 40; ++i) damaged[i] = '\x55';
  EXPECT_THAT(what(test::bag_of(damaged)), HasSubstr("damaged"));
  EXPECT_THAT(what(test::bag_of(test::bag_connection(2, "/chatter", "std_msgs/String", "string data\n"))),
              HasSubstr("no topic of sensor_msgs/Imu has messages; the topics are /chatter (std_msgs/String)"));
  EXPECT_THAT(what(test::bag_of(test::bag_connection(0, "/a", "b/C", "") + test::bag_connection(1, "/a", "b/D", ""))),
              HasSubstr("topic /a is of two types, b/C and b/D"));
  EXPECT_THAT(what(test::bag_of(test::bag_connection(0, "/a", "sensor_msgs/Imu", "string angular_velocity\n"))),
              HasSubstr("bad.bag: topic /a: its type sensor_msgs/Imu has no field"));
  InsRecording recording;
  const std::vector<std::string> topics{"/leg"};
  EXPECT_THAT(append_ins_topics(write("drive.bag", bag), topics, recording).error().what,
              HasSubstr("there is no topic /leg; the topics are /boom/imu/data (sensor_msgs/Imu)"));
}

TEST_F(RobotLog, AnyBytesGiveAValueOrASentence) {
  ASSERT_TRUE(write_ins_mcap(folder / "log.mcap", example_recording()));
  const std::string good[] = {slurp(folder / "log.mcap"), test::bag_of(test::bag_chunk("lz4", bag_records(20))),
                              test::bag_of(bag_records(20))};
  int refused = 0;
  for (const std::string& bytes : good)
    for (std::uint64_t trial = 0; trial < 150; ++trial) {
      std::string mutated = bytes;
      Rng rng = Rng(5).stream(trial);
      for (int edit = 0; edit < 4; ++edit) {
        const std::size_t at = 16 + rng.index(mutated.size() - 20);
        if (rng.index(3) == 0)
          mutated.erase(at, 1 + rng.index(9));
        else
          mutated[at] = static_cast<char>(rng.bits());
      }
      const auto found = read(write("mutated", mutated));
      if (found) continue;
      ++refused;
      EXPECT_EQ(found.error().what.find('\n'), std::string::npos) << found.error().what;
      EXPECT_LT(found.error().what.size(), 2000u);
    }
  EXPECT_GT(refused, 20);
}

TEST(ShortTopicNames, AreThePartsThatTell) {
  const auto names = [](std::vector<std::string> topics) { return short_topic_names(topics); };
  EXPECT_THAT(names({"/boom/imu/data", "/arm/imu/data"}), ElementsAre("boom", "arm"));
  EXPECT_THAT(names({"/robot/imu_1", "/robot/imu_2"}), ElementsAre("imu_1", "imu_2"));
  EXPECT_THAT(names({"/imu/data"}), ElementsAre("imu"));
  EXPECT_THAT(names({"/boom/imu"}), ElementsAre("boom"));
  EXPECT_THAT(names({"/left/front/imu", "/left/rear/imu", "/right/front/imu"}),
              ElementsAre("left_front", "left_rear", "right_front"));
}

}  // namespace
}  // namespace kinfer
