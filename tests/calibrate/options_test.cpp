// SPDX-License-Identifier: Apache-2.0
// Options: which have an effect, and how they are recorded.
#include "kinfer/calibrate/problem/options.hpp"

#include <gtest/gtest.h>

#include <map>

#include "support/robots.hpp"

namespace kinfer {
using namespace calibrate;
namespace {

std::map<std::string, std::string> described(const CalibrationTask& task, const CalibrationOptions& options) {
  const auto list = describe(task, options);
  return {list.begin(), list.end()};
}

const CalibrationTask nominal_task{.nominal = test::er20()};

TEST(Options, DefaultsAreTheCompleteSetWithModelSelection) {
  EXPECT_EQ(described(nominal_task, {}),
            (std::map<std::string, std::string>{{"--model", "auto"}, {"--parameters", "auto"}}));
}

TEST(Options, AModelChoiceIsParsedAndDescribedAlike) {
  for (const char* text : {"auto", "geometry", "gravity+gear", "temperature"})
    EXPECT_EQ(described(nominal_task, {.model = parse_model_choice(text).value()}).at("--model"), text);
  EXPECT_EQ(parse_model_choice("geometry+gravitation").error().what,
            "--model geometry+gravitation: expected auto, geometry or some of gains, coupling, gravity, torques, gear, "
            "spectrum, backlash, temperature, field joined by +");
}

TEST(Options, TheModelOfASubsetOfTheParametersIsGeometryAlone) {
  EXPECT_EQ(described(nominal_task, {.parameters = PaperDhParameters{}}).at("--model"), "geometry");
  const CalibrationOptions contradictory{.parameters = PaperDhParameters{}, .model = FixedModel{{Term::gain}}};
  EXPECT_FALSE(check_options(nominal_task, contradictory).has_value());
  EXPECT_TRUE(check_options(nominal_task, {.parameters = PaperDhParameters{}}).has_value());
}

TEST(Options, OnlyTheOptionsOfTheSearchMethodAreDescribed) {
  const auto pso = described(nominal_task, {.swarm_search = SwarmSearchOptions{}});
  EXPECT_EQ(pso.at("--method"), "pso");
  EXPECT_EQ(pso.at("--iterations"), "20000");
  EXPECT_EQ(pso.at("--inertia"), "0.8");
  EXPECT_EQ(pso.at("--box-length"), "1");
  EXPECT_EQ(pso.at("--box-angle"), "1");
  EXPECT_FALSE(pso.contains("--net-use"));
  const auto qpso =
      described(nominal_task,
                {.swarm_search = SwarmSearchOptions{.search = QpsoOptions{.particles = 30}, .box = ToleranceBox{2.5}}});
  EXPECT_EQ(qpso.at("--particles"), "30");
  EXPECT_EQ(qpso.at("--box-tolerances"), "2.5");
  EXPECT_FALSE(qpso.contains("--inertia"));
  EXPECT_FALSE(qpso.contains("--box-length"));
  const auto bpnn = described(nominal_task, {.swarm_search = SwarmSearchOptions{.search = BpnnPsoOptions{}}});
  EXPECT_EQ(bpnn.at("--net-use"), "initial-swarm");
}

TEST(Options, ARefitChoosesParametersAndModelItself) {
  EXPECT_EQ(described(nominal_task, {.parameters = JointOffsetParameters{}}),
            (std::map<std::string, std::string>{{"--refit", "offsets"}}));
}

TEST(Options, JointTypesAreDescribedAsTheyAreGiven) {
  const auto r = JointType::revolute, p = JointType::prismatic;
  const CalibrationTask scara{.nominal = {}, .joint_types = {r, r, p, r}};
  EXPECT_EQ(described(scara, {}).at("--robot"), "unknown:2RPR");
}

}  // namespace
}  // namespace kinfer
