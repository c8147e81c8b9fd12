#include "kinfer/kinematics/joint_table.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

std::vector<int> moving_joints(const Chain& chain) {
  std::vector<int> moving = path_to(chain, chain.tip_joint());
  std::erase_if(moving, [&](int j) { return chain.joints[j].type == JointType::fixed; });
  return moving;
}

/// Where line b goes through the plane across a at `origin`.
Vec3 pierced(const Vec3& origin, const AxisLine& a, const AxisLine& b) {
  return b.point + (origin - b.point).dot(a.direction) / b.direction.dot(a.direction) * b.direction;
}

/// A sliding axis may lie anywhere: through the axis before it.
std::vector<AxisLine> laid_lines(const Chain& chain) {
  std::vector<AxisLine> lines = axis_lines(chain);
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i].slides) lines[i].point = lines[i - 1].point;
  return lines;
}

/// Frame on axis a that leads to axis b: x along the common perpendicular, or towards a parallel axis. `reached` is the
/// point of a that the frame before leads to.
Pose frame_towards(const AxisLine& a, const AxisLine& b, const Vec3& reached, const Vec3& x_before) {
  Vec3 origin = reached, x;
  if (nearly_parallel(a, b)) {
    x = pierced(origin, a, b) - origin;
    constexpr double same_line = 1e-6;  // [m]
    if (x.norm() < same_line) x = x_before;
  } else {
    origin = foot_on(a, b);
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

/// The moving joints alone, one after the other; their links are to be filled in.
Chain bare_chain(const Chain& chain) {
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

/// The tool that gives `chain` the tool pose of `same` at zero readings.
Frame closing_tool(Chain chain, const Chain& same) {
  chain.tool = Frame{};
  const VectorXd zero = VectorXd::Zero(dof(chain));
  return Frame::from_pose(forward(chain, zero).inverse() * forward(same, zero));
}

/// Frames on the axes, each leading to the next. The last keeps the x axis before it.
std::vector<Pose> mdh_frames(const std::vector<AxisLine>& lines) {
  std::vector<Pose> frames;
  Vec3 reached = lines.front().point, x = any_perpendicular(lines.front().direction);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) {
      const AxisLine& last = lines[i - 1];
      reached =
          nearly_parallel(last, lines[i]) ? pierced(frames.back().position, last, lines[i]) : foot_on(lines[i], last);
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
  const std::vector<PlacedJoint> placed = placed_joints(chain, VectorXd::Zero(dof(chain)));
  std::vector<AxisLine> lines;
  for (const int j : moving_joints(chain)) {
    const Vec3 &u = placed[j].axis, &p = placed[j].point;
    lines.push_back({p - p.dot(u) * u, u, chain.joints[j].type == JointType::prismatic});
  }
  return lines;
}

bool nearly_parallel(const AxisLine& a, const AxisLine& b) {
  return a.direction.cross(b.direction).norm() < std::sin(2.0 * degree);
}

Vec3 foot_on(const AxisLine& a, const AxisLine& b) {
  const Vec3 between = b.point - a.point, normal = a.direction.cross(b.direction);
  return a.point + between.cross(b.direction).dot(normal) / normal.squaredNorm() * a.direction;
}

bool is_straight(const Chain& chain) {
  const std::vector<int> moving = moving_joints(chain);
  return !moving.empty() && static_cast<int>(moving.size()) == dof(chain) &&
         std::all_of(moving.begin(), moving.end(),
                     [&](int j) { return chain.joints[j].has_reading && chain.joints[j].couplings.empty(); });
}

std::optional<Chain> as_mdh(const Chain& chain) {
  if (!is_straight(chain)) return std::nullopt;
  const std::vector<Pose> frames = mdh_frames(laid_lines(chain));
  Chain mdh = bare_chain(chain);
  mdh.base = Frame::from_pose(frames.front());
  mdh.joints.front().link = MdhLink{};
  for (std::size_t i = 1; i < frames.size(); ++i) mdh.joints[i].link = row_between(frames[i - 1], frames[i]);
  mdh.tool = closing_tool(mdh, chain);
  return mdh;
}

std::optional<Chain> as_dh(const Chain& chain) {
  const auto mdh = as_mdh(chain);
  if (!mdh) return std::nullopt;
  Chain dh = *mdh;
  // Row i takes the turn of MDH row i, and the constant part of row i + 1, in which Rx and Tx commute.
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
