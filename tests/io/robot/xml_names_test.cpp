// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/xml/xml_names.hpp"

#include <gtest/gtest.h>

#include "kinfer/io/robot/urdf/urdf.hpp"

namespace kinfer {
namespace {

const std::vector<std::string> hostile_names{
    "a\x01"
    "b",
    "\n",
    "tab\there",
    "\xff\xfe",
    "\xc3\x28",
    "_x0001_",
    "_x005F_",
    "<joint/>",
    "&amp;",
    "\"quote'",
    "\u00e4\u4e2d",
    "_x",
    "\x7f",
    "\xed\xa0\x80"};

TEST(XmlNames, HostileNamesComeBack) {
  for (const std::string& name : hostile_names) EXPECT_EQ(name_from_xml(xml_name(name)), name);
}

TEST(XmlNames, OrdinaryNamesAreUnchanged) {
  for (const std::string name : {"joint_1", "shoulder pan", "_x0041_", "J1", "\u00e4"}) {
    EXPECT_EQ(xml_name(name), name);
    EXPECT_EQ(name_from_xml(name), name);
  }
}

TEST(XmlNames, AUrdfWithHostileNamesIsReadBack) {
  for (const std::string& name : hostile_names) {
    Chain chain;
    chain.name = name;
    chain.joints = {Joint{.name = name, .link = MdhLink{}}, Joint{.name = name + "2", .parent = 0, .link = MdhLink{}}};
    const auto read = parse_urdf(format_urdf(chain), "chain.urdf", {});
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(active_joint_names(*read), active_joint_names(chain));
  }
}

}  // namespace
}  // namespace kinfer
