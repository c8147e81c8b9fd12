// SPDX-License-Identifier: Apache-2.0
#include "cli/program.hpp"

namespace kinfer::test {
namespace {

class CompensateProgram : public Program {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(in(name)) << text; }

  /// The rows of a file without its header.
  std::string rows_of(const std::string& name) const {
    const std::string text = slurp(in(name));
    return text.substr(text.find('\n'));
  }
};

TEST_F(CompensateProgram, ColumnsOfLoadsCountAndThoseOfOtherSetUpsAreRefused) {
  std::string robot = slurp(source("examples/robot6/robot.toml"));
  write("robot.toml", robot);
  const std::string joint = "a = 166.605\n";
  ASSERT_NE(robot.find(joint), std::string::npos);
  write("chain.toml", robot.replace(robot.find(joint), joint.size(), joint + "compliance = 2e-6\n"));
  const std::string posture = "10,-40,20,10,30,5";
  write("alone.csv", "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg]\n" + posture + "\n");
  write("loaded.csv", "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg],payload[kg]\n" + posture + ",20\n");
  write("moved.csv",
        "q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg],setup\n" + posture + ",first\n" + posture + ",second\n");
  const std::string verb = "compensate --chain chain.toml --nominal robot.toml --frames world ";
  ASSERT_EQ(kinfer(verb + "--joints alone.csv -o alone_sent.csv").code, 0);
  ASSERT_EQ(kinfer(verb + "--joints loaded.csv -o loaded_sent.csv").code, 0);
  EXPECT_NE(rows_of("alone_sent.csv"), rows_of("loaded_sent.csv"));
  const Outcome refused = kinfer(verb + "--joints moved.csv -o moved_sent.csv");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("another set-up or arm"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(in("moved_sent.csv")));
}

}  // namespace
}  // namespace kinfer::test
