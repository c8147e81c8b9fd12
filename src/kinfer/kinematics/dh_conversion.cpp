// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/dh_conversion.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

std::vector<int> moving_joints(const Chain& chain) {
  std::vector<int> moving = path_to(chain, chain.tip_joint());
  std::erase_if(moving, [&](int j) { return !has_position(chain.joints[j].type); });
  return moving;
}

/// Intersection of line b with the plane through `origin` perpendicular to a.
Vec3 intersect_with_plane(const Vec3& origin, const AxisLine& a, const AxisLine& b) {
  return b.point + (origin - b.point).dot(a.direction) / b.direction.dot(a.direction) * b.direction;
}

/// The position of a prismatic axis is arbitrary: it is put through the axis before it.
std::vector<AxisLine> located_axis_lines(const Chain& chain) {
  std::vector<AxisLine> lines = axis_lines(chain);
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i].is_prismatic) lines[i].point = lines[i - 1].point;
  return lines;
}

/// Frame on axis a towards axis b: x along the common perpendicular, or towards a parallel axis. `reached`: the point
/// of a where the common perpendicular with the previous axis ends.
Pose frame_towards(const AxisLine& a, const AxisLine& b, const Vec3& reached, const Vec3& x_before) {
  Vec3 origin = reached, x;
  if (nearly_parallel(a, b)) {
    x = intersect_with_plane(origin, a, b) - origin;
    constexpr double same_line = 1e-6;  // [m]
    if (x.norm() < same_line) x = x_before;
  } else {
    origin = common_normal_foot(a, b);
    x = a.direction.cross(b.direction);
    if (x.dot(b.point - origin) < 0.0) x = -x;  // so that a is positive
  }
  x = (x - x.dot(a.direction) * a.direction).normalized();
  Pose frame;
  frame.position = origin;
  frame.rotation << x, a.direction.cross(x), a.direction;
  return frame;
}

/// RotX(alpha) TransX(a) RotY(beta) RotZ(theta) TransZ(d) from one frame to the next, both in the world; the next
/// frame's axis meets the x axis of the first.
MdhLink row_between(const Pose& before, const Pose& frame) {
  MdhLink row;
  const Vec3 u = before.rotation.transpose() * frame.rotation.col(2);  // = Rx(alpha) Ry(beta) z
  row.beta = std::asin(std::clamp(u.x(), -1.0, 1.0));
  row.alpha = std::atan2(-u.y(), u.z());
  const Vec3 offset = before.rotation.transpose() * (frame.position - before.position);  // = a x + d u
  row.d = (offset.y() * u.y() + offset.z() * u.z()) / (u.y() * u.y() + u.z() * u.z());
  row.a = offset.x() - row.d * u.x();
  const Mat3 turn = (before.rotation * rot_x(row.alpha) * rot_y(row.beta)).transpose() * frame.rotation;
  row.theta = std::atan2(turn(1, 0), turn(0, 0));
  return row;
}

/// The moving joints in series; their links are filled in later.
Chain serial_skeleton(const Chain& chain) {
  Chain bare = chain;
  bare.joints.clear();
  bare.masses.clear();
  bare.mountings.clear();
  bare.tip = -1;
  for (const int j : moving_joints(chain)) {
    bare.joints.push_back(chain.joints[j]);
    bare.joints.back().parent = static_cast<int>(bare.joints.size()) - 2;
  }
  return bare;
}

/// The tool frame that gives `chain` the tool pose of `same` at q = 0.
Frame matching_tool(Chain chain, const Chain& reference) {
  chain.tool = Frame{};
  const VectorXd zero = VectorXd::Zero(dof(chain));
  return Frame::from_pose(forward(chain, zero).inverse() * forward(reference, zero));
}

/// Frames on the axes, each towards the next. The last one keeps the x axis before it.
std::vector<Pose> mdh_frames(const std::vector<AxisLine>& lines) {
  std::vector<Pose> frames;
  Vec3 reached = lines.front().point, x = any_perpendicular(lines.front().direction);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) {
      const AxisLine& last = lines[i - 1];
      reached = nearly_parallel(last, lines[i]) ? intersect_with_plane(frames.back().position, last, lines[i])
                                                : common_normal_foot(lines[i], last);
      x = frames.back().rotation.col(0);
    }
    const bool leads = i + 1 < lines.size();
    const AxisLine beside{reached + x, lines[i].direction, false};
    frames.push_back(frame_towards(lines[i], leads ? lines[i + 1] : beside, reached, x));
  }
  return frames;
}

}  // namespace

std::vector<AxisLine> axis_lines(const Chain& chain) {
  const std::vector<JointPlacement> placed = joint_placements(chain, VectorXd::Zero(dof(chain)));
  std::vector<AxisLine> lines;
  for (const int j : moving_joints(chain)) {
    const Vec3 &u = placed[j].axis, &p = placed[j].point;
    lines.push_back({p - p.dot(u) * u, u, translates(chain.joints[j].type)});
  }
  return lines;
}

bool nearly_parallel(const AxisLine& a, const AxisLine& b) {
  return a.direction.cross(b.direction).norm() < std::sin(2.0 * degree);
}

Vec3 common_normal_foot(const AxisLine& a, const AxisLine& b) {
  const Vec3 between = b.point - a.point, normal = a.direction.cross(b.direction);
  return a.point + between.cross(b.direction).dot(normal) / normal.squaredNorm() * a.direction;
}

bool is_serial_chain(const Chain& chain) {
  const std::vector<int> moving = moving_joints(chain);
  return !moving.empty() && static_cast<int>(moving.size()) == dof(chain) &&
         std::all_of(moving.begin(), moving.end(),
                     [&](int j) { return chain.joints[j].is_active && chain.joints[j].couplings.empty(); });
}

std::optional<Chain> as_mdh(const Chain& chain) {
  if (!is_serial_chain(chain)) return std::nullopt;
  const std::vector<Pose> frames = mdh_frames(located_axis_lines(chain));
  Chain mdh = serial_skeleton(chain);
  mdh.base = Frame::from_pose(frames.front());
  mdh.joints.front().link = MdhLink{};
  for (std::size_t i = 1; i < frames.size(); ++i) mdh.joints[i].link = row_between(frames[i - 1], frames[i]);
  mdh.tool = matching_tool(mdh, chain);
  return mdh;
}

std::optional<Chain> as_dh(const Chain& chain) {
  const auto mdh = as_mdh(chain);
  if (!mdh) return std::nullopt;
  Chain dh = *mdh;
  // Row i has theta and d of MDH row i, and a, alpha, beta of row i + 1, as Rx and Tx commute.
  for (std::size_t i = 0; i < dh.joints.size(); ++i) {
    const auto& turn = std::get<MdhLink>(mdh->joints[i].link);
    DhLink row;
    row.theta = turn.theta, row.d = turn.d;
    if (i + 1 < dh.joints.size()) {
      const auto& next = std::get<MdhLink>(mdh->joints[i + 1].link);
      row.a = next.a, row.alpha = next.alpha, row.beta = next.beta;
    }
    dh.joints[i].link = row;
  }
  return dh;
}

}  // namespace kinfer
