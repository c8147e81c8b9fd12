// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot_log/message_definition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinfer {
namespace {

using ::testing::HasSubstr;

TEST(MessageDefinition, FieldsConstantsCommentsAndArraysAreTold) {
  const auto fields = parse_message_definition(
      "# a comment\nint32 LIMIT=5\nstring<=8 name  # bounded\nfloat64[3] fixed\nuint8[] open\nint16[<=4] few\n"
      "float32 gain 1.5\nstring unit \"a=b\"\ntime stamp\n",
      "robot_msgs/Thing", true);
  ASSERT_TRUE(fields) << fields.error().what;
  ASSERT_EQ(fields->size(), 7u);
  EXPECT_EQ((*fields)[0].base, FieldBase::text);
  EXPECT_EQ((*fields)[1].count, 3u);
  EXPECT_TRUE((*fields)[2].is_array && (*fields)[2].count == 0);
  EXPECT_TRUE((*fields)[3].is_array && (*fields)[3].count == 0);
  EXPECT_EQ((*fields)[4].name, "gain");
  EXPECT_EQ((*fields)[5].name, "unit");
  EXPECT_EQ((*fields)[6].base, FieldBase::time);
}

TEST(MessageDefinition, PartsComeFromTheTextElseFromTheCommonTypes) {
  const std::string text = "Header header\nPart part\n" + std::string(80, '=') +
                           "\nMSG: robot_msgs/Part\nfloat64 angle\ngeometry_msgs/Vector3 axis\n";
  const auto fields = parse_message_definition(text, "robot_msgs/Thing", true);
  ASSERT_TRUE(fields) << fields.error().what;
  EXPECT_EQ((*fields)[0].fields.size(), 3u) << "ROS 1's header has a sequence number";
  ASSERT_EQ((*fields)[1].fields.size(), 2u);
  EXPECT_EQ((*fields)[1].fields[1].fields.size(), 3u);
  const auto ros2 = parse_message_definition("std_msgs/msg/Header header\n", "robot_msgs/Thing", false);
  EXPECT_EQ((*ros2)[0].fields.size(), 2u);
}

TEST(MessageDefinition, WhatIsUnknownOrEndlessIsRefused) {
  const auto what = [](const char* text) { return parse_message_definition(text, "a/B", false).error().what; };
  EXPECT_THAT(what("c/D part\n"), HasSubstr("does not define message type c/D"));
  EXPECT_THAT(what("B itself\n"), HasSubstr("contains itself"));
  EXPECT_THAT(what("float64\n"), HasSubstr("\"float64\" is no field"));
  EXPECT_THAT(what("float64[x] y\n"), HasSubstr("is no field"));
  EXPECT_THAT(parse_message_definition("", "a/B", false).error().what, HasSubstr("does not define"));
}

TEST(MessageDefinition, TheTextOfACommonTypeDefinesAllItsParts) {
  const std::string text = common_message_definition("geometry_msgs/TransformStamped");
  for (const char* part : {"MSG: std_msgs/Header", "MSG: geometry_msgs/Transform", "MSG: geometry_msgs/Quaternion"})
    EXPECT_THAT(text, HasSubstr(part));
  const auto fields = parse_message_definition(text, "geometry_msgs/TransformStamped", false);
  ASSERT_TRUE(fields) << fields.error().what;
  EXPECT_EQ((*fields)[2].fields[1].fields[3].name, "w");
  EXPECT_EQ(common_message_definition("a/B"), "\n");
}

}  // namespace
}  // namespace kinfer
