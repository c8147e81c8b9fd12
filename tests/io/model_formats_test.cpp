// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/model_formats.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;

/// One joint of every type with and without limits, in a row.
Chain every_joint_type() {
  Chain chain;
  chain.name = "types";
  for (const JointTypeTraits& row : joint_types)
    for (const bool limited : {true, false}) {
      const int index = static_cast<int>(chain.joints.size());
      Joint joint{.name = std::string(row.name) + (limited ? "_limited" : "_free"),
                  .parent = index - 1,
                  .type = row.type,
                  .link = UrdfLink{.origin = {.xyz = {0.1, 0.2, 0.3 + index}, .rotation = from_rpy({0.1, 0.2, 0.3})},
                                   .axis = Vec3::UnitX()},
                  .is_active = has_position(row.type)};
      if (limited && has_position(row.type)) joint.lower = -0.7, joint.upper = 0.9;
      chain.joints.push_back(joint);
    }
  return chain;
}

class ModelFormats : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  std::string complaint(const fs::path& path) const {
    const auto read = read_robot_model(path);
    return read ? "(accepted)" : read.error().what;
  }
  const fs::path folder = fs::path(::testing::TempDir()) / ("kinfer_model_formats_" + std::to_string(getpid()));
  const RobotModel robot{.chain = every_joint_type()};
};

TEST_F(ModelFormats, WhatAFormatWritesItReadsWithAllJointTypesAndLimits) {
  const VectorXd q = VectorXd::LinSpaced(dof(robot.chain), -0.5, 0.6);
  for (const ModelFormat& format : model_formats()) {
    if (!format.format || !format.parse) continue;
    const auto read = format.parse(format.format(robot, {}), "file", {.base_link = "", .tip_link = "tool"});
    ASSERT_TRUE(read) << format.name << ": " << read.error().what;
    ASSERT_EQ(dof(read->chain), q.size()) << format.name;
    const Pose expected = forward(robot.chain, q), found = forward(read->chain, q);
    EXPECT_LT((expected.position - found.position).norm(), 1e-9) << format.name;
    EXPECT_LT((expected.rotation - found.rotation).norm(), 1e-9) << format.name;
    for (const Joint& joint : read->chain.joints)
      for (const Joint& original : robot.chain.joints)
        if (joint.name == original.name) {
          EXPECT_EQ(traits(joint.type).urdf, traits(original.type).urdf) << format.name << " " << joint.name;
          EXPECT_DOUBLE_EQ(joint.lower, original.lower) << format.name << " " << joint.name;
        }
  }
}

TEST_F(ModelFormats, EveryFormatNamesEveryJointTypeThatMoves) {
  for (const ModelFormat& format : model_formats()) {
    if (!format.format) continue;
    const std::string text = format.format(robot, {});
    for (const JointTypeTraits& row : joint_types) {
      if (!has_position(row.type)) continue;
      const bool is_named = text.find(row.name) != std::string::npos || text.find(row.mjcf) != std::string::npos;
      EXPECT_TRUE(is_named) << format.name << ": " << row.name;
    }
  }
}

TEST_F(ModelFormats, TheExtensionChoosesTheFormat) {
  for (const ModelFormat& format : model_formats()) {
    if (!format.format) continue;
    for (const std::string_view extension : format.write_extensions) {
      const fs::path path = folder / ("robot" + std::string(extension));
      ASSERT_TRUE(write_robot_model(path, robot));
      EXPECT_EQ(read_text_file(path).value(), format.format(robot, {})) << path;
    }
    if (!format.parse) continue;
    EXPECT_EQ(complaint(folder / ("robot" + std::string(format.read_extensions[0]))), "(accepted)");
  }
}

TEST_F(ModelFormats, AFileThatIsNoRobotIsToldWhatIsExpected) {
  const fs::path table = folder / "poses.csv", chain = folder / "robot.toml";
  ASSERT_TRUE(write_text_file(table, "q1[deg],x[mm]\n1,2\n"));
  ASSERT_TRUE(write_text_file(chain, "q1[deg],x[mm]\n1,2\n"));
  EXPECT_NE(complaint(table).find("; expected a robot as TOML, URDF or MJCF"), std::string::npos) << complaint(table);
  EXPECT_EQ(complaint(chain).find("; expected a robot"), std::string::npos) << "it was meant as TOML";
}

TEST_F(ModelFormats, TheOutermostElementChoosesAmongXmlFormats) {
  const std::string before = "\xEF\xBB\xBF<?xml version='1.0'?>\n<!-- <mujoco> <robot> -->\n";
  const fs::path path = folder / "robot.xml";
  for (const ModelFormat& format : model_formats()) {
    if (format.root_element.empty()) continue;
    std::string text = format.format(robot, {});
    text.erase(0, text.find('<' + std::string(format.root_element)));
    ASSERT_TRUE(write_text_file(path, before + text));
    const auto read = read_robot_model(path, {.base_link = "", .tip_link = "tool"});
    ASSERT_TRUE(read) << format.name << ": " << read.error().what;
    ASSERT_TRUE(read->source) << format.name;
    EXPECT_EQ(name(read->source->format), format.name);
    EXPECT_EQ(read->source->text, before + text);
  }
  ASSERT_TRUE(write_text_file(path, before + "<sdf/>"));
  EXPECT_EQ(complaint(path), path.string() + ":3: expected <robot> (URDF) or <mujoco> (MJCF), found <sdf>");
  ASSERT_TRUE(write_text_file(path, "units = 1"));
  EXPECT_NE(complaint(path).find(":1: malformed XML"), std::string::npos) << complaint(path);
}

TEST_F(ModelFormats, UnknownAndUnreadableExtensionsAreNamed) {
  EXPECT_EQ(readable_model_formats(), "TOML, URDF or MJCF");
  EXPECT_EQ(writable_model_extensions(), ".toml, .urdf or .mjcf");
  const auto done = write_robot_model(folder / "robot.obj", robot);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().what, (folder / "robot.obj").string() + ": expected an ending .toml, .urdf or .mjcf");
  EXPECT_FALSE(fs::exists(folder / "robot.obj"));
  EXPECT_EQ(complaint(folder / "none.toml"), (folder / "none.toml").string() + ": no such file");
  ASSERT_TRUE(write_text_file(folder / "robot.txt", format_robot_toml(robot)));
  EXPECT_EQ(complaint(folder / "robot.txt"), "(accepted)") << "unknown extensions are read as TOML";
}

}  // namespace
}  // namespace kinfer
