// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/link_block.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"

namespace kinfer::identify {
namespace {

double wrap_difference(double angle) {  // wraps a difference of two angles in (−pi, pi]
  constexpr double pi = std::numbers::pi;
  return angle > pi ? angle - 2.0 * pi : angle < -pi ? angle + 2.0 * pi : angle;
}

}  // namespace

void rotate_by_signal(FrameLanes& s, std::size_t k, std::size_t u, std::size_t v, const SignalLanes& q) {
  const Lanes3& n = s.axes[k];
  for (std::size_t i = 0; i < block_width; ++i) {
    const double wx = s.angular_velocity[0][i], wy = s.angular_velocity[1][i], wz = s.angular_velocity[2][i],
                 qd = q.angular_velocity[i], qdd = q.angular_acceleration[i];
    s.angular_acceleration[0][i] += qdd * n[0][i] + qd * (wy * n[2][i] - wz * n[1][i]);
    s.angular_acceleration[1][i] += qdd * n[1][i] + qd * (wz * n[0][i] - wx * n[2][i]);
    s.angular_acceleration[2][i] += qdd * n[2][i] + qd * (wx * n[1][i] - wy * n[0][i]);
    s.angular_velocity[0][i] += qd * n[0][i];
    s.angular_velocity[1][i] += qd * n[1][i];
    s.angular_velocity[2][i] += qd * n[2][i];
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) {
      const double a = s.axes[u][c][i], b = s.axes[v][c][i];
      s.axes[u][c][i] = q.cosine[i] * a + q.sine[i] * b;
      s.axes[v][c][i] = q.cosine[i] * b - q.sine[i] * a;
    }
}

void rotate_by_constant(FrameLanes& s, std::size_t u, std::size_t v, double angle) {
  if (angle == 0.0) return;
  const double sine = std::sin(angle), cosine = std::cos(angle);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) {
      const double a = s.axes[u][c][i], b = s.axes[v][c][i];
      s.axes[u][c][i] = cosine * a + sine * b;
      s.axes[v][c][i] = cosine * b - sine * a;
    }
}

void translate_origin(FrameLanes& s, double d, double a) {
  if (d == 0.0 && a == 0.0) return;
  for (std::size_t i = 0; i < block_width; ++i) {
    const double rx = d * s.axes[2][0][i] + a * s.axes[0][0][i];
    const double ry = d * s.axes[2][1][i] + a * s.axes[0][1][i];
    const double rz = d * s.axes[2][2][i] + a * s.axes[0][2][i];
    const double wx = s.angular_velocity[0][i], wy = s.angular_velocity[1][i], wz = s.angular_velocity[2][i];
    const double along = wx * rx + wy * ry + wz * rz, square = wx * wx + wy * wy + wz * wz;  // ω×(ω×r) = ω(ω·r) − r ω²
    s.acceleration[0][i] +=
        s.angular_acceleration[1][i] * rz - s.angular_acceleration[2][i] * ry + wx * along - rx * square;
    s.acceleration[1][i] +=
        s.angular_acceleration[2][i] * rx - s.angular_acceleration[0][i] * rz + wy * along - ry * square;
    s.acceleration[2][i] +=
        s.angular_acceleration[0][i] * ry - s.angular_acceleration[1][i] * rx + wz * along - rz * square;
  }
}

void lever_arm_column(const FrameLanes& s, std::size_t k, Lanes3& column) {
  for (std::size_t i = 0; i < block_width; ++i) {
    const double rx = s.axes[k][0][i], ry = s.axes[k][1][i], rz = s.axes[k][2][i];
    const double wx = s.angular_velocity[0][i], wy = s.angular_velocity[1][i], wz = s.angular_velocity[2][i];
    const double along = wx * rx + wy * ry + wz * rz, square = wx * wx + wy * wy + wz * wz;
    column[0][i] = s.angular_acceleration[1][i] * rz - s.angular_acceleration[2][i] * ry + wx * along - rx * square;
    column[1][i] = s.angular_acceleration[2][i] * rx - s.angular_acceleration[0][i] * rz + wy * along - ry * square;
    column[2][i] = s.angular_acceleration[0][i] * ry - s.angular_acceleration[1][i] * rx + wz * along - rz * square;
  }
}

void LinkBlock::rotate_theta(FrameLanes& s, const DhLeaf& leaf) const {
  rotate_by_constant(s, 0, 1, leaf.theta);
  if (leaf.theta_signal != DhLeaf::constant)
    rotate_by_signal(s, 2, 0, 1, signals[static_cast<std::size_t>(leaf.theta_signal)]);
}

void LinkBlock::rotate_alpha(FrameLanes& s, const DhLeaf& leaf) const {
  rotate_by_constant(s, 1, 2, leaf.alpha);
  if (leaf.alpha_signal != DhLeaf::constant)
    rotate_by_signal(s, 0, 1, 2, signals[static_cast<std::size_t>(leaf.alpha_signal)]);
}

void LinkBlock::apply_leaves(FrameLanes& s, std::span<const DhLeaf> leaves) const {
  for (const DhLeaf& leaf : leaves) {
    rotate_theta(s, leaf);
    translate_origin(s, leaf.d, leaf.a);
    rotate_alpha(s, leaf);
  }
}

FrameLanes LinkBlock::propagate(std::span<const DhLeaf> leaves) const {
  FrameLanes s = parent;
  apply_leaves(s, leaves);
  return s;
}

double LinkBlock::squared_acceleration_error(const FrameLanes& s) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) {
      const double difference = acceleration[c][i] - s.acceleration[c][i];
      sum += weight[i] * difference * difference;
    }
  return sum;
}

double LinkBlock::squared_chord(const FrameLanes& s) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < block_width; ++i) {
        const double difference = axes[k][c][i] - s.axes[k][c][i];
        sum += weight[i] * difference * difference;
      }
  return 0.5 * sum;
}

/// Eq. (23), its misprint corrected to R33: R31 is axes[0][2], R32 axes[1][2], R33 axes[2][2], R21 axes[0][1], R11
/// axes[0][0].
double LinkBlock::squared_euler_error(const FrameLanes& s) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < block_width; ++i) {
    const double phi = wrap_difference(angles[0][i] - std::atan2(s.axes[1][2][i], s.axes[2][2][i]));
    const double theta = angles[1][i] + std::asin(std::fmin(1.0, std::fmax(-1.0, s.axes[0][2][i])));
    const double psi = wrap_difference(angles[2][i] - std::atan2(s.axes[0][1][i], s.axes[0][0][i]));
    sum += weight[i] * (phi * phi + theta * theta + psi * psi);
  }
  return sum;
}

void LinkBlock::set_row(std::size_t i, const FrameState& p, const FrameState& c, const SignalRow& q) {
  const Vec3 euler = euler_angles(c.rotation);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto e = static_cast<Eigen::Index>(k);
    parent.angular_velocity[k][i] = p.angular_velocity[e];
    parent.angular_acceleration[k][i] = p.angular_acceleration[e];
    parent.acceleration[k][i] = p.acceleration[e];
    acceleration[k][i] = c.acceleration[e];
    angles[k][i] = euler[e];
    for (std::size_t column = 0; column < 3; ++column) {
      parent.axes[column][k][i] = p.rotation(e, static_cast<Eigen::Index>(column));
      axes[column][k][i] = c.rotation(e, static_cast<Eigen::Index>(column));
    }
  }
  for (std::size_t k = 0; k < signals.size(); ++k) {
    signals[k].sine[i] = std::sin(q.angle[k]);
    signals[k].cosine[i] = std::cos(q.angle[k]);
    signals[k].angular_velocity[i] = q.angular_velocity[k];
    signals[k].angular_acceleration[i] = q.angular_acceleration[k];
  }
}

std::vector<LinkBlock> make_link_blocks(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                        std::span<const JointSignal> signals, const std::vector<std::size_t>& rows) {
  KINFER_EXPECT(!rows.empty() && parent.size() == child.size());
  const std::size_t count = (rows.size() + block_width - 1) / block_width;
  std::vector<LinkBlock> blocks(count);
  for (std::size_t b = 0; b < count; ++b) {
    blocks[b].signals.resize(signals.size());
    for (std::size_t i = 0; i < block_width; ++i) {
      const std::size_t k = i * count + b;
      const std::size_t row = rows[std::min(k, rows.size() - 1)];
      blocks[b].set_row(i, parent[row], child[row], signals_at(signals, row));
      blocks[b].weight[i] = k < rows.size() ? 1.0 : 0.0;
    }
  }
  return blocks;
}

}  // namespace kinfer::identify
