// SPDX-License-Identifier: Apache-2.0
#include <kinfer/io/robot/toml/robot_toml.hpp>
#include <kinfer/kinematics/forward.hpp>

#include <cmath>

int main() {
  const auto robot = kinfer::parse_robot_toml(R"(
convention = "dh"
[[joint]]
type = "revolute"
a = 0.5
alpha = 0.0
d = 0.0
theta = 0.0
)",
                                              "user.toml");
  if (!robot) return 1;
  const kinfer::Vec3 tip = kinfer::forward(robot->chain, kinfer::VectorXd::Zero(1)).position;
  return std::abs(tip.x() - 0.5) < 1e-15 ? 0 : 1;
}
