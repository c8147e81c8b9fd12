// SPDX-License-Identifier: Apache-2.0
// Robots of several types for simulation studies.
#pragma once

#include <string>

#include "kinfer/base/angle.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer::study {

/// A row of a DH table after the one numbered `parent`.
inline Joint dh_joint(double a, double alpha_deg, double d, int parent, JointType type = JointType::revolute) {
  Joint joint;
  DhLink link;
  link.a = a, link.alpha = alpha_deg * degree, link.d = d;
  joint.link = link, joint.parent = parent, joint.type = type;
  joint.name = "J" + std::to_string(parent + 2);
  return joint;
}

/// Three parallel axes, the tool off the last one.
inline Chain ur10_like() {
  Chain chain;
  chain.name = "UR10-like";
  chain.joints = {dh_joint(0, 90, 0.1273, -1),  dh_joint(-0.612, 0, 0, 0),   dh_joint(-0.5723, 0, 0, 1),
                  dh_joint(0, 90, 0.163941, 2), dh_joint(0, -90, 0.1157, 3), dh_joint(0, 0, 0.0922, 4)};
  chain.tool.xyz = Vec3(0.02, -0.015, 0.1);
  return chain;
}

inline Chain scara() {
  Chain chain;
  chain.name = "SCARA";
  chain.joints = {dh_joint(0.4, 0, 0.3, -1), dh_joint(0.3, 180, 0, 0), dh_joint(0, 0, 0.05, 1, JointType::prismatic),
                  dh_joint(0, 0, 0.1, 2)};
  chain.joints[2].lower = 0.0, chain.joints[2].upper = 0.2;
  chain.tool.xyz = Vec3(0.03, 0.01, 0.05);
  return chain;
}

inline Chain seven_axes() {
  Chain chain;
  chain.name = "7 axes";
  chain.joints = {dh_joint(0, -90, 0.34, -1), dh_joint(0, 90, 0, 0), dh_joint(0, 90, 0.4, 1), dh_joint(0, -90, 0, 2),
                  dh_joint(0, -90, 0.4, 3),   dh_joint(0, 90, 0, 4), dh_joint(0, 0, 0.126, 5)};
  chain.tool.xyz = Vec3(0.03, 0.02, 0.08);
  return chain;
}

}  // namespace kinfer::study
