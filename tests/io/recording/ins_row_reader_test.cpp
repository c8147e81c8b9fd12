// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/recording/ins_row_reader.hpp"

#include <gmock/gmock.h>

#include "kinfer/io/recording/ins_csv.hpp"

namespace kinfer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct ReadRows {
  std::vector<InsRow> rows;
  std::string error;
  std::vector<std::string> remarks;
};

/// The text in pieces of `size` bytes.
ReadRows read_rows(const std::string& text, std::size_t size, std::vector<std::string> sensors = {"b", "a"}) {
  ReadRows result;
  InsRowReader reader(std::move(sensors), "log.csv");
  const auto keep = [&](const InsRow& row) -> Result<void> {
    result.rows.push_back(row);
    return {};
  };
  Result<void> done;
  for (std::size_t at = 0; at < text.size() && done; at += size) done = reader.add(text.substr(at, size), keep);
  if (done) done = reader.finish(keep);
  if (!done) result.error = done.error().what;
  result.remarks = reader.remarks();
  return result;
}

const std::string header =
    "# a comment\nt,a_ax,a_ay,a_az,a_gx[deg/s],a_gy[deg/s],a_gz[deg/s],b_ax[g],b_ay[g],b_az[g],b_gx,b_gy,b_gz\n";

std::string example_log(int rows) {
  std::string text = header;
  for (int i = 0; i < rows; ++i)
    text += fmt::format("{},0.1,0.2,9.8,{},2,3,0,0,1,0.1,{},0.3\r\n", 0.01 * i, i, i % 7 == 3 ? "" : "0.2");
  return text;
}

TEST(InsRowReader, ReadsTheSameRowsWhateverThePieces) {
  const std::string text = example_log(40);
  const ReadRows whole = read_rows(text, text.size());
  ASSERT_EQ(whole.rows.size(), 40u);
  for (const std::size_t size : {1u, 7u, 64u, 1000u}) {
    const ReadRows pieces = read_rows(text, size);
    ASSERT_EQ(pieces.rows.size(), 40u) << size;
    for (std::size_t i = 0; i < 40; ++i) {
      EXPECT_EQ(pieces.rows[i].time, whole.rows[i].time);
      EXPECT_EQ(pieces.rows[i].sensors[1].angular_velocity, whole.rows[i].sensors[1].angular_velocity);
    }
  }
}

TEST(InsRowReader, AgreesWithTheReaderOfWholeLogs) {
  const std::string text = example_log(40);
  const ReadRows stream = read_rows(text, 100);
  const auto log = parse_ins_csv(text, "log.csv");
  ASSERT_TRUE(log);
  for (std::size_t i = 0; i < 40; ++i)
    for (std::size_t s = 0; s < 2; ++s) {
      const InsSensor& sensor = log->sensors[1 - s];  // a, b in the log; b, a in the rows
      const InsSample whole = sample(sensor, log->time(sensor), i), one = stream.rows[i].sensors[s];
      EXPECT_LT((whole.acceleration - one.acceleration).norm(), 1e-5);
      EXPECT_EQ(whole.has_angular_velocity, one.has_angular_velocity) << i;
      if (one.has_angular_velocity) {
        EXPECT_LT((whole.angular_velocity - one.angular_velocity).norm(), 1e-6);
      }
    }
}

TEST(InsRowReader, ACutOffLastRowIsARemark) {
  std::string text = example_log(3);
  text.resize(text.size() - 12);
  const ReadRows cut = read_rows(text, 50);
  EXPECT_EQ(cut.error, "");
  EXPECT_EQ(cut.rows.size(), 2u);
  EXPECT_THAT(cut.remarks, ElementsAre("log.csv: the last line is cut off and is not used"));
}

TEST(InsRowReader, BadInputIsOneSentence) {
  const std::string row = ",0,0,9.8,0,0,0,0,0,1,0,0,0\n";
  EXPECT_THAT(read_rows(header + "0.1" + row + "0.05" + row, 99).error,
              HasSubstr("log.csv:4: the time goes backwards, from 0.1 s to 0.05 s"));
  EXPECT_THAT(read_rows(header + "0.1" + row + "0.1" + row, 99).error, HasSubstr("duplicate time"));
  EXPECT_THAT(read_rows(header + "x" + row, 99).error, HasSubstr("log.csv:3: column t: expected a number"));
  EXPECT_THAT(read_rows(header + row, 99).error, HasSubstr("log.csv:3: column t: expected a time, found none"));
  EXPECT_THAT(read_rows(header + "1,2\n2,3\n", 99).error, HasSubstr("log.csv:3: expected 13 columns, found 2"));
  EXPECT_EQ(read_rows("", 99).error, "log.csv: the file is empty");
  EXPECT_EQ(read_rows(header, 99).error, "log.csv: the file has a header but no rows");
  EXPECT_THAT(read_rows(example_log(3), 99, {"a", "c"}).error,
              HasSubstr("the chain has a sensor c, the log has none of that name; it has a, b"));
  EXPECT_THAT(read_rows(example_log(3), 99, {"a"}).remarks, ElementsAre(HasSubstr("not used: b")));
  std::string in_g = header;
  for (int i = 0; i < 200; ++i) in_g += fmt::format("{},0,0,1,0,0,0,0,0,1,0,0,0\n", 0.01 * i);
  EXPECT_THAT(read_rows(in_g, 99).error, HasSubstr("a: gravity reads 1.00 m/s² instead of 9.81"));
  for (const int rows : {5, 200}) {
    std::string in_ms = header;
    for (int i = 0; i < rows; ++i) in_ms += fmt::format("{}{}", 10 * i, row);
    const ReadRows read = read_rows(in_ms, 99);
    EXPECT_THAT(read.error, HasSubstr("log.csv: rows are 10 s apart, expected 1e-05 to 0.5 s of an INS"));
    EXPECT_LT(read.rows.size(), 20u);
  }
}

}  // namespace
}  // namespace kinfer
