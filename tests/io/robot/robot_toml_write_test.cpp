// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "laws/example_chains.hpp"

namespace kinfer {
namespace {

class RobotTomlRoundTrip : public testing::TestWithParam<Chain> {};

double largest_difference(const Chain& a, const Chain& b) {
  double largest = 0.0;
  for (int i = 0; i < 20; ++i) {
    const VectorXd q = laws::random_q(a, Rng(7).stream(i));
    const Load load{.payload = 3.0};
    const Pose pa = forward(a, q, load), pb = forward(b, q, load);
    largest =
        std::max({largest, (pa.position - pb.position).norm(), (pa.rotation - pb.rotation).cwiseAbs().maxCoeff()});
  }
  return largest;
}

Chain read_back(const RobotModel& robot, FileUnits units, const StandardDeviations& sd = {}) {
  const std::string text = format_robot_toml(robot, sd, units);
  const auto read = parse_robot_toml(text, "chain.toml");
  EXPECT_TRUE(read.has_value()) << (read ? "" : read.error().what) << "\n" << text;
  return read ? read->chain : Chain{};
}

TEST_P(RobotTomlRoundTrip, PredictsTheSamePoses) {
  for (const FileUnits units : {FileUnits::si, FileUnits::mm_deg})
    EXPECT_LT(largest_difference(GetParam(), read_back({.chain = GetParam()}, units)), 1e-12);
}

TEST_P(RobotTomlRoundTrip, StandardDeviationsDoNotChangeTheNumbers) {
  StandardDeviations sd;
  for (const Parameter& parameter : all_parameters(GetParam(), {}).parameters) sd[parameter.name] = 1e-4;
  const std::string text = format_robot_toml({.chain = GetParam()}, sd);
  EXPECT_NE(text.find("_sd = "), std::string::npos);
  EXPECT_LT(largest_difference(GetParam(), read_back({.chain = GetParam()}, FileUnits::mm_deg, sd)), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Every, RobotTomlRoundTrip, testing::ValuesIn(laws::examples_with_joints()),
                         [](const auto& chain) { return laws::test_name(chain.param); });

/// Exact in the seven digits that are written.
PredictionModel example_prediction() {
  PredictionModel model{.parameters = {"theta1", "a2"}, .rows = MatrixXd(2, 3), .spread = VectorXd(2)};
  model.root = MatrixXd{{1e-4, 0.0}, {-2e-5, 3e-4}};
  model.model_error.diagonal() << 1e-10, 2e-10, 3e-10, 1e-8, 2e-8, 3e-8;
  model.rows << 0.5, -1.25, 2, 0.125, 3, -0.75;
  model.spread << 0.5, 1.5;
  model.outside_error = MatrixXd(0.25 * model.model_error);
  model.reach = 0.75, model.edge = 1.25, model.noise = 3e-5;
  model.beyond = VectorXd{{1e-3, -2e-3}};
  return model;
}

TEST(RobotTomlWriting, ThePredictionModelIsReadBack) {
  Chain chain;
  chain.joints.resize(2);
  const PredictionModel model = example_prediction();
  const auto read = parse_robot_toml(format_robot_toml({.chain = chain, .prediction = model}), "chain.toml");
  ASSERT_TRUE(read.has_value() && read->prediction) << (read ? "" : read.error().what);
  const PredictionModel& again = *read->prediction;
  EXPECT_EQ(again.parameters, model.parameters);
  EXPECT_TRUE(again.root.isApprox(model.root, 1e-7));
  EXPECT_TRUE(again.model_error.isApprox(model.model_error, 1e-7));
  EXPECT_EQ(again.rows, model.rows);
  EXPECT_EQ(again.spread, model.spread);
  EXPECT_EQ(again.beyond, model.beyond);
  EXPECT_TRUE(again.outside_error.isApprox(model.outside_error, 1e-7));
  EXPECT_EQ((std::array{again.reach, again.edge, again.noise}), (std::array{model.reach, model.edge, model.noise}));
}

/// `text` with the line that starts with `key` replaced.
std::string with_line(const std::string& text, const std::string& key, const std::string& line) {
  const std::size_t start = text.find("\n" + key + " = ") + 1, end = text.find('\n', start);
  return text.substr(0, start) + line + text.substr(end);
}

TEST(RobotTomlWriting, PredictionModelsOfOlderVersionsAreRead) {
  Chain chain;
  chain.joints.resize(2);
  const PredictionModel model = example_prediction();
  std::string text = with_line(format_robot_toml({.chain = chain, .prediction = model}), "edge", "");
  const std::size_t error = text.find("\noutside_error = "), end = text.find('\n', error + 1);
  const std::string numbers = text.substr(error + 17, end - error - 17);
  const auto growth = parse_robot_toml(with_line(text, "outside_error", "growth = " + numbers), "chain.toml");
  ASSERT_TRUE(growth.has_value() && growth->prediction) << (growth ? "" : growth.error().what);
  EXPECT_TRUE(growth->prediction->outside_error.isApprox(4.0 * model.outside_error, 1e-6)) << "at twice the reach";
  const auto rate = parse_robot_toml(with_line(text, "outside_error", "rate = 0.25"), "chain.toml");
  ASSERT_TRUE(rate.has_value() && rate->prediction) << (rate ? "" : rate.error().what);
  EXPECT_TRUE(rate->prediction->outside_error.isApprox(model.model_error, 1e-6));
}

TEST(RobotTomlWriting, NonGeometricValuesAreReadBackToo) {
  RobotModel robot{.chain = laws::compliant_tree()};
  robot.chain.targets = {{"left \"eye\"", Vec3(0.1, 0.2, 0.3)}};
  robot.chain.gravity = Vec3(0, 9.81, 0);
  robot.chain.joints[3].lower = -0.1, robot.chain.joints[3].upper = 0.4;
  robot.chain.joints[1].name = "base";
  robot.tolerances.length = 0.2e-3, robot.tolerances.base_angle = 3 * degree;
  robot.instrument = Instrument{.sigma = 1e-5, .sigma_angle = 1e-4, .ppm = 5};
  robot.chain.fixtures.anchors = {Vec3(1.8, -0.9, 0.1), Vec3(0, 1, 2)};
  const auto read = parse_robot_toml(format_robot_toml(robot), "chain.toml");
  ASSERT_TRUE(read.has_value()) << read.error().what;
  EXPECT_EQ(read->chain.name, "compliant tree");
  EXPECT_EQ(read->chain.targets[0].name, "left \"eye\"");
  EXPECT_EQ(read->chain.targets[0].xyz, robot.chain.targets[0].xyz);
  EXPECT_EQ(read->chain.gravity, robot.chain.gravity);
  EXPECT_EQ(read->chain.joints[3].lower, -0.1);
  EXPECT_EQ(read->chain.joints[3].upper, 0.4);
  EXPECT_EQ(read->chain.joints[1].name, "base");
  EXPECT_EQ(read->chain.joints[4].parent, 0);
  EXPECT_EQ(read->chain.tip, 3);
  EXPECT_EQ(read->chain.masses[1].com, robot.chain.masses[1].com);
  EXPECT_EQ(read->tolerances.length, 0.2e-3);
  EXPECT_EQ(read->tolerances.base_angle, 3 * degree);
  EXPECT_EQ(read->instrument->sigma_angle, 1e-4);
  EXPECT_EQ(read->chain.fixtures.anchors, robot.chain.fixtures.anchors);
}

TEST(RobotTomlWriting, RoundNumbersAreWrittenRound) {
  RobotModel robot;
  robot.chain.joints.push_back(laws::revolute<MdhLink>(0.166605, -90, 0.504));
  const std::string text = format_robot_toml(robot, {{"a1", 12.5e-6}, {"base_x", 1e-3}, {"base_rz", 0.01 * degree}});
  EXPECT_NE(text.find("a = 166.605\na_sd = 0.0125\nalpha = -90\nd = 504\n"), std::string::npos) << text;
  EXPECT_NE(text.find("base_sd = { xyz = [1, nan, nan], turn = [nan, nan, 0.01] }\n"), std::string::npos) << text;
}

TEST(RobotTomlWriting, AToolAtGimbalLockKeepsItsPose) {
  for (const double pitch : {90.0, -90.0, 90.0 - 1e-7, 90.0 - 1e-10}) {
    Chain chain = laws::er20();
    chain.tool.rotation = rot_x(0.3) * from_rpy({0.7, pitch * degree, -1.1});
    chain.base.rotation = from_rpy({0.7, pitch * degree, -1.1});
    EXPECT_LT(largest_difference(chain, read_back({.chain = chain}, FileUnits::mm_deg)), 1e-12) << pitch;
  }
}

TEST(Digits, ReadBackGivesTheSameBitsWhereverTheUnitAllows) {
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const double value = rng.normal();
    EXPECT_EQ(std::stod(format_number(value)), value);
    EXPECT_NEAR(1e-3 * std::stod(format_number(value, 1e-3)), value, 1e-15 * std::abs(value));
  }
  EXPECT_EQ(format_number(0.7, 1e-3), "700");
  EXPECT_EQ(format_number(0.504, 1e-3), "504");
  EXPECT_EQ(format_number(-90 * degree, degree), "-90");
}

TEST(RobotTomlWriting, ALoopClosureIsReadBackWithItsFramesByName) {
  RobotModel robot{.chain = laws::compliant_tree()};
  const int last = static_cast<int>(robot.chain.joints.size()) - 1;
  robot.chain.closures = {{.name = "coupler-bucket",
                           .first = -1,
                           .second = last,
                           .point_in_first = Vec3(0.1, -0.2, 0.3),
                           .point_in_second = Vec3(1.5, 0.0, -0.25),
                           .axis_in_first = Vec3(0.0, 0.6, 0.8),
                           .axis_in_second = Vec3::UnitX()}};
  for (const FileUnits units : {FileUnits::si, FileUnits::mm_deg}) {
    const Chain chain = read_back(robot, units);
    ASSERT_EQ(chain.closures.size(), 1U);
    const LoopClosure &read = chain.closures[0], &written = robot.chain.closures[0];
    EXPECT_EQ(read.name, written.name);
    EXPECT_EQ(read.first, -1);
    EXPECT_EQ(read.second, last);
    EXPECT_LT((read.point_in_first - written.point_in_first).norm(), 1e-12);
    EXPECT_LT((read.point_in_second - written.point_in_second).norm(), 1e-12);
    EXPECT_LT((read.axis_in_first - written.axis_in_first).norm(), 1e-12);
    EXPECT_LT((read.axis_in_second - written.axis_in_second).norm(), 1e-12);
  }
}

TEST(RobotTomlReading, AClosureThatJoinsNothingIsRefused) {
  const auto message = [](const std::string& closure) {
    const auto read = parse_robot_toml(
        "convention = \"urdf\"\n[[joint]]\nname = \"boom\"\ntype = \"revolute\"\nxyz = [0, 0, 1]\naxis = [0, 1, 0]\n"
        "[[closure]]\npoint_in_first = [0, 0, 0]\naxis_in_first = [0, 1, 0]\npoint_in_second = [0, 0, 0]\n" +
            closure,
        "chain.toml");
    return read ? std::string() : read.error().what;
  };
  EXPECT_EQ(message("first = \"base\"\nsecond = \"boom\"\naxis_in_second = [0, 2, 0]\n"), "");
  EXPECT_NE(message("first = \"rod\"\nsecond = \"boom\"\naxis_in_second = [0, 1, 0]\n").find("no joint is named"),
            std::string::npos);
  EXPECT_NE(message("first = \"boom\"\nsecond = \"boom\"\naxis_in_second = [0, 1, 0]\n").find("two frames"),
            std::string::npos);
  EXPECT_NE(message("first = \"base\"\nsecond = \"boom\"\naxis_in_second = [0, 0, 0]\n").find("expected a direction"),
            std::string::npos);
}

}  // namespace
}  // namespace kinfer
