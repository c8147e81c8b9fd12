// SPDX-License-Identifier: Apache-2.0
// Reference of kinematics: the printed matrices of the papers, entry by entry, multiplied out. Slow and obvious.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer::laws {

using Mat4 = Eigen::Matrix4d;

inline Mat4 rotation_about_y(double beta) {
  Mat4 m;
  // clang-format off
  m <<  std::cos(beta), 0, std::sin(beta), 0,
        0,              1, 0,              0,
       -std::sin(beta), 0, std::cos(beta), 0,
        0,              0, 0,              1;
  // clang-format on
  return m;
}

/// Paper 1, eq. (1), then Hayati's rotation about y.
inline Mat4 slow_link(const DhLink& row, JointType type, double moved) {
  const double theta = row.theta + (rotates(type) ? moved : 0.0);
  const double d = row.d + (translates(type) ? moved : 0.0);
  const double ct = std::cos(theta), st = std::sin(theta), ca = std::cos(row.alpha), sa = std::sin(row.alpha);
  Mat4 m;
  // clang-format off
  m << ct, -st * ca,  st * sa, row.a * ct,
       st,  ct * ca, -ct * sa, row.a * st,
       0,   sa,       ca,      d,
       0,   0,        0,       1;
  // clang-format on
  return m * rotation_about_y(row.beta);
}

/// Paper 2, eq. (3); Hayati's rotation about y stands between the equation's halves.
inline Mat4 slow_link(const MdhLink& row, JointType type, double moved) {
  const double theta = row.theta + (rotates(type) ? moved : 0.0);
  const double d = row.d + (translates(type) ? moved : 0.0);
  const auto eq3 = [](double alpha, double a, double angle, double along) {
    const double ct = std::cos(angle), st = std::sin(angle), ca = std::cos(alpha), sa = std::sin(alpha);
    Mat4 m;
    // clang-format off
    m << ct,      -st,       0,   a,
         st * ca,  ct * ca, -sa, -along * sa,
         st * sa,  ct * sa,  ca,  along * ca,
         0,        0,        0,   1;
    // clang-format on
    return m;
  };
  if (row.beta == 0.0) return eq3(row.alpha, row.a, theta, d);
  return eq3(row.alpha, row.a, 0, 0) * rotation_about_y(row.beta) * eq3(0, 0, theta, d);
}

inline Mat4 slow_frame(const Frame& frame) {
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() = frame.rotation *
                            Eigen::AngleAxisd(frame.small_rotation.x(), Vec3::UnitX()).toRotationMatrix() *
                            Eigen::AngleAxisd(frame.small_rotation.y(), Vec3::UnitY()).toRotationMatrix() *
                            Eigen::AngleAxisd(frame.small_rotation.z(), Vec3::UnitZ()).toRotationMatrix();
  m.topRightCorner<3, 1>() = frame.xyz;
  return m;
}

inline Mat4 slow_link(const UrdfLink& link, JointType type, double moved) {
  Mat4 motion = Mat4::Identity();
  if (rotates(type)) motion.topLeftCorner<3, 3>() = Eigen::AngleAxisd(moved, link.axis).toRotationMatrix();
  if (translates(type)) motion.topRightCorner<3, 1>() = moved * link.axis;
  return slow_frame(link.origin) * motion;
}

/// variable - offset = gain · joint position + couplings + compliance · torque
inline double slow_movement(const Chain& chain, int j, const VectorXd& q, const VectorXd& torque) {
  const std::vector<int> reads = active_joints(chain);
  double moved = chain.joints[j].compliance * torque[j];
  for (int k = 0; k < static_cast<int>(reads.size()); ++k) {
    if (reads[k] == j) moved += chain.joints[j].gain * q[k];
    for (const Coupling& c : chain.joints[j].couplings) {
      if (reads[k] == c.joint) moved += c.factor * q[k];
    }
  }
  return moved;
}

/// world_T_frame of joint j (-1: the base), for given torques.
inline Mat4 slow_joint(const Chain& chain, int j, const VectorXd& q, const VectorXd& torque) {
  if (j < 0) return slow_frame(chain.base);
  const Joint& joint = chain.joints[j];
  const double moved = slow_movement(chain, j, q, torque);
  return slow_joint(chain, joint.parent, q, torque) *
         std::visit([&](const auto& link) { return slow_link(link, joint.type, moved); }, joint.link);
}

inline Mat4 slow_tool(const Chain& chain, const VectorXd& q, const VectorXd& torque) {
  return slow_joint(chain, chain.tip_joint(), q, torque) * slow_frame(chain.tool);
}

/// The torque of gravity about a joint is minus the derivative of the potential energy of what it carries, the chain
/// being undeflected: taken by central differences of the height.
inline VectorXd slow_torques(const Chain& chain, const VectorXd& q, double payload) {
  const int n = static_cast<int>(chain.joints.size());
  const auto energy = [&](int bent, double angle) {
    Chain rigid = chain;
    for (Joint& joint : rigid.joints) joint.compliance = 0.0;
    VectorXd bend = VectorXd::Zero(n);
    rigid.joints[bent].compliance = 1.0, bend[bent] = angle;
    double sum = -payload * chain.gravity.dot(slow_tool(rigid, q, bend).topRightCorner<3, 1>());
    for (const PointMass& mass : chain.masses) {
      const Vec3 at = (slow_joint(rigid, mass.joint, q, bend) * mass.com.homogeneous()).head<3>();
      sum -= mass.mass * chain.gravity.dot(at);
    }
    return sum;
  };
  VectorXd torques = VectorXd::Zero(n);
  constexpr double step = 1e-5;
  for (int j = 0; j < n; ++j) {
    if (rotates(chain.joints[j].type)) torques[j] = -(energy(j, step) - energy(j, -step)) / (2 * step);
  }
  return torques;
}

}  // namespace kinfer::laws
