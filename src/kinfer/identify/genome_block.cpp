#include "kinfer/identify/genome_block.hpp"

#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

double shortest(double angle) {  // of a difference of two angles in (−pi, pi]
  constexpr double pi = std::numbers::pi;
  return angle > pi ? angle - 2.0 * pi : angle < -pi ? angle + 2.0 * pi : angle;
}

}  // namespace

void turn_by_signal(FrameLanes& s, std::size_t k, std::size_t u, std::size_t v, const SignalLanes& q) {
  const Lanes3& n = s.axes[k];
  for (std::size_t i = 0; i < block_width; ++i) {
    const double wx = s.rate[0][i], wy = s.rate[1][i], wz = s.rate[2][i], qd = q.rate[i], qdd = q.rate_change[i];
    s.rate_change[0][i] += qdd * n[0][i] + qd * (wy * n[2][i] - wz * n[1][i]);
    s.rate_change[1][i] += qdd * n[1][i] + qd * (wz * n[0][i] - wx * n[2][i]);
    s.rate_change[2][i] += qdd * n[2][i] + qd * (wx * n[1][i] - wy * n[0][i]);
    s.rate[0][i] += qd * n[0][i];
    s.rate[1][i] += qd * n[1][i];
    s.rate[2][i] += qd * n[2][i];
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) {
      const double a = s.axes[u][c][i], b = s.axes[v][c][i];
      s.axes[u][c][i] = q.cosine[i] * a + q.sine[i] * b;
      s.axes[v][c][i] = q.cosine[i] * b - q.sine[i] * a;
    }
}

void turn_by_constant(FrameLanes& s, std::size_t u, std::size_t v, double angle) {
  if (angle == 0.0) return;
  const double sine = std::sin(angle), cosine = std::cos(angle);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) {
      const double a = s.axes[u][c][i], b = s.axes[v][c][i];
      s.axes[u][c][i] = cosine * a + sine * b;
      s.axes[v][c][i] = cosine * b - sine * a;
    }
}

void step(FrameLanes& s, double d, double a) {
  if (d == 0.0 && a == 0.0) return;
  for (std::size_t i = 0; i < block_width; ++i) {
    const double rx = d * s.axes[2][0][i] + a * s.axes[0][0][i];
    const double ry = d * s.axes[2][1][i] + a * s.axes[0][1][i];
    const double rz = d * s.axes[2][2][i] + a * s.axes[0][2][i];
    const double wx = s.rate[0][i], wy = s.rate[1][i], wz = s.rate[2][i];
    const double along = wx * rx + wy * ry + wz * rz, square = wx * wx + wy * wy + wz * wz;  // ω×(ω×r) = ω(ω·r) − r ω²
    s.acceleration[0][i] += s.rate_change[1][i] * rz - s.rate_change[2][i] * ry + wx * along - rx * square;
    s.acceleration[1][i] += s.rate_change[2][i] * rx - s.rate_change[0][i] * rz + wy * along - ry * square;
    s.acceleration[2][i] += s.rate_change[0][i] * ry - s.rate_change[1][i] * rx + wz * along - rz * square;
  }
}

void lever_column(const FrameLanes& s, std::size_t k, Lanes3& column) {
  for (std::size_t i = 0; i < block_width; ++i) {
    const double rx = s.axes[k][0][i], ry = s.axes[k][1][i], rz = s.axes[k][2][i];
    const double wx = s.rate[0][i], wy = s.rate[1][i], wz = s.rate[2][i];
    const double along = wx * rx + wy * ry + wz * rz, square = wx * wx + wy * wy + wz * wz;
    column[0][i] = s.rate_change[1][i] * rz - s.rate_change[2][i] * ry + wx * along - rx * square;
    column[1][i] = s.rate_change[2][i] * rx - s.rate_change[0][i] * rz + wy * along - ry * square;
    column[2][i] = s.rate_change[0][i] * ry - s.rate_change[1][i] * rx + wz * along - rz * square;
  }
}

void LinkBlock::turn_theta(FrameLanes& s, const DhLeaf& leaf) const {
  turn_by_constant(s, 0, 1, leaf.theta);
  if (leaf.theta_signal != DhLeaf::constant)
    turn_by_signal(s, 2, 0, 1, signals[static_cast<std::size_t>(leaf.theta_signal)]);
}

void LinkBlock::turn_alpha(FrameLanes& s, const DhLeaf& leaf) const {
  turn_by_constant(s, 1, 2, leaf.alpha);
  if (leaf.alpha_signal != DhLeaf::constant)
    turn_by_signal(s, 0, 1, 2, signals[static_cast<std::size_t>(leaf.alpha_signal)]);
}

void LinkBlock::carry(FrameLanes& s, std::span<const DhLeaf> leaves) const {
  for (const DhLeaf& leaf : leaves) {
    turn_theta(s, leaf);
    step(s, leaf.d, leaf.a);
    turn_alpha(s, leaf);
  }
}

FrameLanes LinkBlock::carried(std::span<const DhLeaf> leaves) const {
  FrameLanes s = parent;
  carry(s, leaves);
  return s;
}

double LinkBlock::acceleration_square(const FrameLanes& s) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < block_width; ++i) {
      const double difference = acceleration[c][i] - s.acceleration[c][i];
      sum += weight[i] * difference * difference;
    }
  return sum;
}

double LinkBlock::chord_square(const FrameLanes& s) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < block_width; ++i) {
        const double difference = axes[k][c][i] - s.axes[k][c][i];
        sum += weight[i] * difference * difference;
      }
  return 0.5 * sum;
}

/// Eq. (23), with R33 for its misprint: R31 is axes[0][2], R32 axes[1][2], R33 axes[2][2], R21 axes[0][1], R11
/// axes[0][0].
double LinkBlock::euler_square(const FrameLanes& s) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < block_width; ++i) {
    const double phi = shortest(angles[0][i] - std::atan2(s.axes[1][2][i], s.axes[2][2][i]));
    const double theta = angles[1][i] + std::asin(std::fmin(1.0, std::fmax(-1.0, s.axes[0][2][i])));
    const double psi = shortest(angles[2][i] - std::atan2(s.axes[0][1][i], s.axes[0][0][i]));
    sum += weight[i] * (phi * phi + theta * theta + psi * psi);
  }
  return sum;
}

void LinkBlock::fill(std::size_t i, const FrameState& p, const FrameState& c, const SignalRow& q) {
  const Vec3 euler = euler_angles(c.rotation);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto e = static_cast<Eigen::Index>(k);
    parent.rate[k][i] = p.rate[e];
    parent.rate_change[k][i] = p.rate_change[e];
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
    signals[k].rate[i] = q.rate[k];
    signals[k].rate_change[i] = q.rate_change[k];
  }
}

std::vector<LinkBlock> link_blocks(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                   std::span<const JointSignal> signals, const std::vector<std::size_t>& rows) {
  KINFER_EXPECT(!rows.empty() && parent.size() == child.size());
  const std::size_t count = (rows.size() + block_width - 1) / block_width;
  std::vector<LinkBlock> blocks(count);
  for (std::size_t b = 0; b < count; ++b) {
    blocks[b].signals.resize(signals.size());
    for (std::size_t i = 0; i < block_width; ++i) {
      const std::size_t k = i * count + b;
      const std::size_t row = rows[std::min(k, rows.size() - 1)];
      blocks[b].fill(i, parent[row], child[row], signals_at(signals, row));
      blocks[b].weight[i] = k < rows.size() ? 1.0 : 0.0;
    }
  }
  return blocks;
}

}  // namespace kinfer
