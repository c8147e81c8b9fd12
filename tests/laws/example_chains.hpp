// SPDX-License-Identifier: Apache-2.0
// The machines that every law of kinematics is tested on. A new convention or joint type gets all laws by a line in
// `examples`.
#pragma once

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// Name of a chain in test names.
inline void PrintTo(const Chain& chain, std::ostream* out) {
  *out << chain.name;
}

}  // namespace kinfer

namespace kinfer::laws {

template <class Row>
Joint revolute(double a, double alpha_deg, double d, double theta_deg = 0.0, double beta_deg = 0.0) {
  Row row;
  row.a = a, row.alpha = alpha_deg * degree, row.d = d, row.theta = theta_deg * degree, row.beta = beta_deg * degree;
  return {.link = row};
}

template <class Row>
Joint prismatic(double a, double alpha_deg, double d, double theta_deg = 0.0, double beta_deg = 0.0) {
  Joint joint = revolute<Row>(a, alpha_deg, d, theta_deg, beta_deg);
  joint.type = JointType::prismatic;
  return joint;
}

inline Joint urdf(JointType type, const Vec3& xyz, const Vec3& rpy, const Vec3& axis) {
  return {.type = type, .link = UrdfLink{{.xyz = xyz, .rotation = from_rpy(rpy)}, axis.normalized()}};
}

/// Serial chain with a base and a tool in general position.
inline Chain serial(std::string name, std::vector<Joint> joints) {
  Chain chain;
  chain.name = std::move(name);
  chain.base = {.xyz = {0.3, -0.2, 0.7}, .rotation = from_rpy({0.1, -0.2, 2.0}), .small_rotation = {0.01, -0.02, 0.03}};
  chain.tool = {
      .xyz = {0.05, -0.03, 0.12}, .rotation = from_rpy({-0.4, 0.5, 0.6}), .small_rotation = {-0.02, 0.01, 0.04}};
  chain.joints = std::move(joints);
  for (int j = 0; j < static_cast<int>(chain.joints.size()); ++j) {
    chain.joints[j].name = "J" + std::to_string(j + 1);
    chain.joints[j].parent = j - 1;
  }
  return chain;
}

/// A 6R arm with the proportions of a small collaborative robot, standard DH.
inline Chain dh_6r() {
  return serial("dh 6R",
                {revolute<DhLink>(0, 90, 0.089), revolute<DhLink>(-0.425, 0, 0), revolute<DhLink>(-0.392, 0, 0),
                 revolute<DhLink>(0, 90, 0.109), revolute<DhLink>(0, -90, 0.095), revolute<DhLink>(0, 0, 0.082)});
}

/// ER20-C10 of paper 2, table 1.
inline Chain er20() {
  return serial("ER20", {revolute<MdhLink>(0, 0, 0.504), revolute<MdhLink>(0.166605, -90, 0),
                         revolute<MdhLink>(0.782270, 0, 0), revolute<MdhLink>(0.138826, -90, 0.76135),
                         revolute<MdhLink>(0, 90, 0), revolute<MdhLink>(0, -90, 0.125)});
}

/// ER20 with errors in every number, Hayati's beta included: general position.
inline Chain er20_with_errors() {
  Chain chain = er20();
  chain.name = "ER20 with errors";
  Rng rng(20);
  for (Joint& joint : chain.joints) {
    auto& row = std::get<MdhLink>(joint.link);
    for (double* number : {&row.a, &row.alpha, &row.d, &row.theta, &row.beta}) *number += 0.01 * rng.normal();
    joint.gain += 0.01 * rng.normal();
  }
  return chain;
}

inline Chain scara() {
  Chain chain = serial("SCARA", {revolute<DhLink>(0.325, 0, 0.4), revolute<DhLink>(0.275, 180, 0),
                                 prismatic<DhLink>(0, 0, 0.05), revolute<DhLink>(0, 0, 0.02)});
  chain.joints[2].gain = 0.98;
  chain.joints[2].lower = 0.0, chain.joints[2].upper = 0.2;
  return chain;
}

inline Chain dh_with_prismatic() {
  return serial("dh with prismatic", {revolute<DhLink>(0.1, 90, 0.3, 10, 2), prismatic<DhLink>(0.05, -80, 0.2, 30, -1),
                                      revolute<DhLink>(0.2, 70, 0.1, 5), prismatic<DhLink>(0.1, 20, 0.15, -60)});
}

inline Chain urdf_arm() {
  using enum JointType;
  return serial(
      "urdf",
      {urdf(fixed, {0, 0, 0.2}, {0.1, 0.2, 0.3}, {0, 0, 1}), urdf(revolute, {0.1, 0, 0.3}, {0, 0, 0.5}, {0, 0, 1}),
       urdf(revolute, {0, 0.1, 0.2}, {1.2, 0, 0}, {0, 1, 0}),
       urdf(prismatic, {0.3, 0.1, 0.2}, {0, 1.5707963267948966, 0}, {1, -2, 0.5}),
       urdf(fixed, {0.1, 0.1, 0}, {0, 0, 0}, {1, 0, 0}), urdf(revolute, {0.2, 0, 0}, {0.4, -0.3, 0.2}, {0, 0, -1}),
       urdf(revolute, {0, 0, 0.1}, {0, 0.3, 0}, {0.3, 0.4, -0.8})});
}

/// Wrist whose belts couple it to the joints before it, and a joint that follows another (URDF's mimic).
inline Chain coupled() {
  Chain chain = er20_with_errors();
  chain.name = "coupled";
  chain.joints[2].couplings = {{1, 1.0}};
  chain.joints[4].couplings = {{3, -0.02}};
  chain.joints[5].couplings = {{3, 0.5}, {4, -0.25}};
  chain.joints[3].is_active = true;
  Joint mimic = urdf(JointType::revolute, {0.02, 0.03, 0.1}, {0.1, 0, 0}, {1, 0, 0});
  mimic.name = "follower", mimic.parent = 5, mimic.is_active = false;
  mimic.couplings = {{0, -0.7}};
  chain.joints.push_back(mimic);
  return chain;
}

inline Chain seven_r() {
  return serial("7R", {revolute<MdhLink>(0, 0, 0.333), revolute<MdhLink>(0, -90, 0), revolute<MdhLink>(0, 90, 0.316),
                       revolute<MdhLink>(0.0825, 90, 0), revolute<MdhLink>(-0.0825, -90, 0.384),
                       revolute<MdhLink>(0, 90, 0), revolute<MdhLink>(0.088, 90, 0.107)});
}

/// Torso with two arms of different conventions; the tool sits on the first arm.
inline Chain two_arms() {
  Chain chain = serial(
      "two arms", {revolute<MdhLink>(0, 0, 0.5), revolute<MdhLink>(0.2, -90, 0.1), revolute<DhLink>(0.3, 10, 0.05),
                   prismatic<MdhLink>(0.1, 40, 0.2), revolute<DhLink>(0.25, 80, 0.1), revolute<DhLink>(0.2, -30, 0.0)});
  chain.joints[4].parent = 0;
  chain.tip = 3;
  chain.joints[2].couplings = {{5, 0.3}};  // joint position of the other arm
  return chain;
}

/// The same machine with its tool on fixed joints of the base: no joint moves it.
inline Chain with_tool_on_the_base(Chain chain) {
  for (int parent : {-1, static_cast<int>(chain.joints.size())}) {
    Joint joint = revolute<DhLink>(0.3, 20, 0.2);
    joint.name = parent < 0 ? "post" : "head";
    joint.parent = parent, joint.type = JointType::fixed, joint.is_active = false;
    chain.joints.push_back(joint);
  }
  chain.tip = static_cast<int>(chain.joints.size()) - 1;
  return chain;
}

/// Heavy arm with compliant joints.
inline Chain compliant() {
  Chain chain = er20_with_errors();
  chain.name = "compliant";
  chain.masses = {{1, {0.3, 0.05, -0.1}, 60.0}, {2, {0.1, 0.0, 0.2}, 40.0}, {4, {0.0, 0.1, 0.0}, 8.0}};
  for (Joint& joint : chain.joints) joint.compliance = 5e-6;
  chain.joints[5].compliance = 0.0;
  return chain;
}

/// Two compliant arms: the other arm's masses load the torso only.
inline Chain compliant_tree() {
  Chain chain = two_arms();
  chain.name = "compliant tree";
  chain.masses = {{3, {0.1, 0.2, 0.0}, 5.0}, {5, {0.2, 0.1, 0.1}, 10.0}};
  for (Joint& joint : chain.joints) joint.compliance = rotates(joint.type) ? 1e-4 : 0.0;
  return chain;
}

inline Chain without_joints() {
  return serial("no joints", {});
}

inline std::vector<Chain> examples() {
  return {dh_6r(),   er20(),    er20_with_errors(), scara(),     dh_with_prismatic(), urdf_arm(),
          coupled(), seven_r(), two_arms(),         compliant(), compliant_tree(),    without_joints()};
}

inline std::vector<Chain> examples_with_joints() {
  std::vector<Chain> chains = examples();
  std::erase_if(chains, [](const Chain& chain) { return chain.joints.empty(); });
  return chains;
}

inline std::string test_name(const Chain& chain) {
  std::string name = chain.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

inline VectorXd random_q(const Chain& chain, Rng rng) {
  VectorXd q(dof(chain));
  for (double& reading : q) reading = rng.uniform(-2.5, 2.5);
  return q;
}

}  // namespace kinfer::laws
