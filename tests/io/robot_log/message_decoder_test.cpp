// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/message_decoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinfer/io/robot_log/mcap_writer.hpp"
#include "support/ros_messages.hpp"

namespace kinfer {
namespace {

using test::raw_bytes;
using test::with_length;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* mixed =
    "uint8 small\nfloat64 wide\nstring[] names\nbool[3] flags\nPart[] parts\nEmpty nothing\nint16 last\n"
    "===\nMSG: a/Part\nint8 code\nfloat32[] values\n===\nMSG: a/Empty\nint32 NONE=1\n";

TEST(MessageDecoder, AlignsFieldsInCdr) {
  const std::vector<WantedField> wanted{{"wide"},
                                        {"names", FieldBase::text, true},
                                        {"flags", FieldBase::number, true},
                                        {"parts.values", FieldBase::number, true},
                                        {"last"}};
  const auto decoder = MessageDecoder::make({.name = "/t", .type = "a/B", .definition = mixed}, wanted);
  ASSERT_TRUE(decoder) << decoder.error().what;
  std::string cdr{'\0', '\1', '\0', '\0'};
  cdr += raw_bytes(std::uint8_t{9}) + std::string(7, '\0') + raw_bytes(2.5);
  cdr += raw_bytes(std::uint32_t{2}) + with_length(std::string("ab\0", 3)) + std::string(1, '\0') +
         with_length(std::string("c\0", 2));
  cdr += std::string("\1\0\1", 3);                            // flags, at 34..36
  cdr += std::string(3, '\0') + raw_bytes(std::uint32_t{1});  // parts, at 40
  cdr += raw_bytes(std::int8_t{-1}) + std::string(3, '\0') + raw_bytes(std::uint32_t{2}) + raw_bytes(1.5f) +
         raw_bytes(-2.f);
  cdr += std::string(1, '\0');  // the empty message
  cdr += std::string(1, '\0') + raw_bytes(std::int16_t{-300});
  std::vector<DecodedField> found;
  ASSERT_TRUE(decoder->decode(cdr, found));
  EXPECT_THAT(found[0].numbers, ElementsAre(2.5));
  EXPECT_THAT(found[1].texts, ElementsAre("ab", "c"));
  EXPECT_THAT(found[2].numbers, ElementsAre(1, 0, 1));
  EXPECT_THAT(found[3].numbers, ElementsAre(1.5, -2.0));
  EXPECT_THAT(found[4].numbers, ElementsAre(-300));
}

TEST(MessageDecoder, PacksFieldsInRos1) {
  const std::vector<WantedField> wanted{
      {"header.stamp", FieldBase::time}, {"header.frame_id", FieldBase::text}, {"linear_acceleration.z"}};
  const auto decoder = MessageDecoder::make(
      {.name = "/t", .type = "sensor_msgs/Imu", .definition = "", .serialization = Serialization::ros1}, wanted);
  ASSERT_TRUE(decoder) << decoder.error().what;
  std::vector<DecodedField> found;
  ASSERT_TRUE(decoder->decode(test::ros1_imu(3, 5, "boom", {1, 2, 3}, {4, 5, 6}), found));
  EXPECT_THAT(found[0].times, ElementsAre(3'000'000'005));
  EXPECT_THAT(found[1].texts, ElementsAre("boom"));
  EXPECT_THAT(found[2].numbers, ElementsAre(6.0));
}

TEST(MessageDecoder, ReadsWhatTheWriterOfCdrWrites) {
  CdrMessage message;
  message.time(-1).text("f").count(2).text("a").text("bcd").count(1).number(0.5).count(0).count(0);
  const std::vector<WantedField> wanted{
      {"header.stamp", FieldBase::time}, {"name", FieldBase::text, true}, {"position", FieldBase::number, true}};
  const auto decoder = MessageDecoder::make({.name = "/j", .type = "sensor_msgs/JointState"}, wanted);
  std::vector<DecodedField> found;
  ASSERT_TRUE(decoder->decode(message.bytes(), found));
  EXPECT_THAT(found[0].times, ElementsAre(-1));
  EXPECT_THAT(found[1].texts, ElementsAre("a", "bcd"));
  EXPECT_THAT(found[2].numbers, ElementsAre(0.5));
}

TEST(MessageDecoder, ShortMessagesAndLyingCountsAreRefused) {
  const std::vector<WantedField> wanted{{"last"}};
  const auto decoder = MessageDecoder::make({.name = "/t", .type = "a/B", .definition = mixed}, wanted);
  std::vector<DecodedField> found;
  EXPECT_FALSE(decoder->decode("", found));
  EXPECT_FALSE(decoder->decode(std::string("\0\1\0\0\7", 5), found));
  std::string lie{'\0', '\1', '\0', '\0'};
  lie += std::string(8, '\0') + raw_bytes(1.0) + raw_bytes(std::uint32_t{4'000'000'000u});
  EXPECT_FALSE(decoder->decode(lie, found));
  lie[1] = '\0';
  EXPECT_FALSE(decoder->decode(lie, found)) << "big-endian";
}

/// The error of asking for a field of a type with this definition.
std::string error_of(const WantedField& wanted, const std::string& definition) {
  const auto decoder =
      MessageDecoder::make({.name = "/t", .type = "a/B", .definition = definition}, std::span(&wanted, 1));
  return decoder ? "" : decoder.error().what;
}

TEST(MessageDecoder, FieldsOfAnotherKindThanIsAskedForAreNamed) {
  EXPECT_EQ(error_of({"x"}, "float32 x\n"), "");
  EXPECT_EQ(error_of({"x"}, "string x\n"), "topic /t: field x of its type a/B is no number");
  EXPECT_EQ(error_of({"x"}, "wstring x\n"), "topic /t: field x of its type a/B is no number");
  EXPECT_EQ(error_of({"x"}, "float64[] x\n"), "topic /t: field x of its type a/B is no number");
  EXPECT_EQ(error_of({"x"}, "float64[3] x\n"), "topic /t: field x of its type a/B is no number");
  EXPECT_EQ(error_of({"x", FieldBase::number, true}, "float64 x\n"),
            "topic /t: field x of its type a/B is no list of numbers");
  EXPECT_EQ(error_of({"stamp", FieldBase::time}, "float64 stamp\n"),
            "topic /t: field stamp of its type a/B is no time");
  EXPECT_EQ(error_of({"part", FieldBase::text}, "Part part\n===\nMSG: a/Part\nint8 code\n"),
            "topic /t: field part of its type a/B is no text");
  EXPECT_EQ(error_of({"part.code"}, "Part[] part\n===\nMSG: a/Part\nint8 code\n"),
            "topic /t: field part.code of its type a/B is no number");
  EXPECT_EQ(error_of({"x"}, "float64 x\nstring x\n"), "topic /t: field x of its type a/B is no number");
}

TEST(MessageDecoder, FieldsThatAreNotThereAreNamed) {
  const std::vector<WantedField> wanted{{"weight"}};
  EXPECT_THAT(MessageDecoder::make({.name = "/t", .type = "sensor_msgs/Imu"}, wanted).error().what,
              HasSubstr("topic /t: its type sensor_msgs/Imu has no field weight"));
  EXPECT_THAT(MessageDecoder::make(
                  {.name = "/t", .type = "a/B", .definition = "", .serialization = Serialization::other}, wanted)
                  .error()
                  .what,
              HasSubstr("neither by ROS 1 nor by CDR"));
}

}  // namespace
}  // namespace kinfer
