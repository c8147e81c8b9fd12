// SPDX-License-Identifier: Apache-2.0
// Builds a chain from DH rows and computes its tool position and the derivative by one parameter.
#include <fmt/core.h>

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/kinematics/forward.hpp"

int main() {
  using namespace kinfer;
  Chain arm;
  for (const double length : {0.4, 0.3}) {
    DhLink link;
    link.a = length;
    Joint joint;
    joint.link = link;
    joint.parent = static_cast<int>(arm.joints.size()) - 1;
    arm.joints.push_back(joint);
  }
  const VectorXd q = (VectorXd(2) << 30 * degree, 45 * degree).finished();
  const Vec3 tip = forward(arm, q).position;
  fmt::print("tool at {:.4f} {:.4f} {:.4f} m\n", tip.x(), tip.y(), tip.z());

  const ParameterSet a1 = with_only_free(all_parameters(arm, Tolerances{}), {"a1"});
  Twists by_a1;
  PoseEvaluator(arm, a1).pose_and_derivative(q, {}, by_a1);
  fmt::print("one millimetre more in a1 moves it by {:.4f} {:.4f} {:.4f} mm\n", by_a1(0, 0), by_a1(1, 0), by_a1(2, 0));

  const double expected_x = 0.4 * std::cos(30 * degree) + 0.3 * std::cos(75 * degree);
  return std::abs(tip.x() - expected_x) < 1e-15 ? 0 : 1;
}
