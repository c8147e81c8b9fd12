#include "kinfer/identify/link_cost.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr std::size_t width = 64;  // rows of a block: its state of 18 numbers a row then fits the first cache
using Lane = std::array<double, width>;
using Lanes3 = std::array<Lane, 3>;

/// States of a block; axes[k] is column k of ground_R_frame.
struct Lanes {
  std::array<Lanes3, 3> axes;
  Lanes3 rate, rate_change, acceleration;
};

struct SignalLanes {
  Lane sine, cosine, rate, rate_change;
};

/// Turns the frame about its axis `k` (0: x, 2: z) by a signal; u and v are the axes that turn, u towards v.
void turn_by_signal(Lanes& s, std::size_t k, std::size_t u, std::size_t v, const SignalLanes& q) {
  const Lanes3& n = s.axes[k];
  for (std::size_t i = 0; i < width; ++i) {
    const double wx = s.rate[0][i], wy = s.rate[1][i], wz = s.rate[2][i], qd = q.rate[i], qdd = q.rate_change[i];
    s.rate_change[0][i] += qdd * n[0][i] + qd * (wy * n[2][i] - wz * n[1][i]);
    s.rate_change[1][i] += qdd * n[1][i] + qd * (wz * n[0][i] - wx * n[2][i]);
    s.rate_change[2][i] += qdd * n[2][i] + qd * (wx * n[1][i] - wy * n[0][i]);
    s.rate[0][i] += qd * n[0][i];
    s.rate[1][i] += qd * n[1][i];
    s.rate[2][i] += qd * n[2][i];
  }
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < width; ++i) {
      const double a = s.axes[u][c][i], b = s.axes[v][c][i];
      s.axes[u][c][i] = q.cosine[i] * a + q.sine[i] * b;
      s.axes[v][c][i] = q.cosine[i] * b - q.sine[i] * a;
    }
}

void turn_by_constant(Lanes& s, std::size_t u, std::size_t v, double angle) {
  if (angle == 0.0) return;
  const double sine = std::sin(angle), cosine = std::cos(angle);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < width; ++i) {
      const double a = s.axes[u][c][i], b = s.axes[v][c][i];
      s.axes[u][c][i] = cosine * a + sine * b;
      s.axes[v][c][i] = cosine * b - sine * a;
    }
}

/// p'' += ω' × r + ω × (ω × r), r = d z + a x
void step(Lanes& s, double d, double a) {
  if (d == 0.0 && a == 0.0) return;
  for (std::size_t i = 0; i < width; ++i) {
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

double shortest(double angle) {  // of a difference of two angles in (−pi, pi]
  constexpr double pi = std::numbers::pi;
  return angle > pi ? angle - 2.0 * pi : angle < -pi ? angle + 2.0 * pi : angle;
}

}  // namespace

struct LinkCost::Block {
  Lanes parent;
  std::vector<SignalLanes> signals;
  Lanes3 acceleration;         // measured
  std::array<Lanes3, 3> axes;  // columns of the measured rotation
  Lanes3 angles;               // measured roll, pitch, yaw
  Lane weight;                 // 1; 0 for lanes that no row fills

  Lanes carried(std::span<const DhLeaf> leaves) const {
    Lanes s = parent;
    for (const DhLeaf& leaf : leaves) {
      turn_by_constant(s, 0, 1, leaf.theta);
      if (leaf.theta_signal != DhLeaf::constant)
        turn_by_signal(s, 2, 0, 1, signals[static_cast<std::size_t>(leaf.theta_signal)]);
      step(s, leaf.d, leaf.a);
      turn_by_constant(s, 1, 2, leaf.alpha);
      if (leaf.alpha_signal != DhLeaf::constant)
        turn_by_signal(s, 0, 1, 2, signals[static_cast<std::size_t>(leaf.alpha_signal)]);
    }
    return s;
  }

  double acceleration_square(const Lanes& s) const {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < width; ++i) {
        const double difference = acceleration[c][i] - s.acceleration[c][i];
        sum += weight[i] * difference * difference;
      }
    return sum;
  }

  double chord_square(const Lanes& s) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < width; ++i) {
          const double difference = axes[k][c][i] - s.axes[k][c][i];
          sum += weight[i] * difference * difference;
        }
    return 0.5 * sum;
  }

  /// Eq. (23), with R33 for its misprint: R31 is axes[0][2], R32 axes[1][2], R33 axes[2][2], R21 axes[0][1], R11
  /// axes[0][0].
  double euler_square(const Lanes& s) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < width; ++i) {
      const double phi = shortest(angles[0][i] - std::atan2(s.axes[1][2][i], s.axes[2][2][i]));
      const double theta = angles[1][i] + std::asin(std::fmin(1.0, std::fmax(-1.0, s.axes[0][2][i])));
      const double psi = shortest(angles[2][i] - std::atan2(s.axes[0][1][i], s.axes[0][0][i]));
      sum += weight[i] * (phi * phi + theta * theta + psi * psi);
    }
    return sum;
  }

  double orientation_square(const Lanes& s, OrientationError error) const {
    return error == OrientationError::euler ? euler_square(s) : chord_square(s);
  }

  void fill(std::size_t i, const FrameState& p, const FrameState& c, const SignalRow& q) {
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
};

LinkCost::~LinkCost() = default;
LinkCost::LinkCost(LinkCost&&) noexcept = default;

LinkCost::LinkCost(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                   std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                   const LinkCostOptions& options)
    : rows_(rows.size()), options_(options) {
  KINFER_EXPECT(!rows.empty() && parent.size() == child.size());
  const std::size_t count = (rows.size() + width - 1) / width;
  blocks_.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    blocks_[b].signals.resize(signals.size());
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t k = i * count + b;  // every block spans the whole recording
      const std::size_t row = rows[std::min(k, rows.size() - 1)];
      blocks_[b].fill(i, parent[row], child[row], signals_at(signals, row));
      blocks_[b].weight[i] = k < rows.size() ? 1.0 : 0.0;
    }
  }
}

double LinkCost::operator()(const DhTree& tree, double bound) const {
  const std::vector<DhLeaf> factors = leaves(tree);
  double lengths = 0.0;
  for (const DhLeaf& leaf : factors) lengths += leaf.d * leaf.d + leaf.a * leaf.a;
  const int uses = signal_uses(factors);
  if (uses == 0) return std::numeric_limits<double>::infinity();  // a joint that moves is no constant
  const double penalty =
      1.0 + options_.leaf_penalty * static_cast<double>(factors.size() - 1) + options_.use_penalty * (uses - 1);
  const auto n = static_cast<double>(rows_);
  double sum = n * options_.length_prior * options_.length_prior * lengths;
  const double limit =
      bound < std::numeric_limits<double>::infinity() ? n * (bound / penalty) * (bound / penalty) : bound;
  for (const Block& block : blocks_) {
    const Lanes state = block.carried(factors);
    sum += block.acceleration_square(state);
    if (!(sum < limit)) return std::numeric_limits<double>::infinity();
    sum += block.orientation_square(state, options_.orientation);
    if (!(sum < limit)) return std::numeric_limits<double>::infinity();
  }
  return penalty * std::sqrt(sum / n);
}

JRmse LinkCost::j_rmse(std::span<const DhLeaf> leaves) const {
  double acceleration = 0.0, orientation = 0.0;
  for (const Block& block : blocks_) {
    const Lanes state = block.carried(leaves);
    acceleration += block.acceleration_square(state);
    orientation += block.orientation_square(state, options_.orientation);
  }
  const auto n = static_cast<double>(rows_);
  return {std::sqrt((acceleration + orientation) / n), std::sqrt(acceleration / n), std::sqrt(orientation / n)};
}

JRmse j_rmse(const std::vector<FrameState>& predicted, const std::vector<FrameState>& measured,
             const std::vector<std::size_t>& rows, OrientationError orientation) {
  double acceleration = 0.0, angles = 0.0;
  for (const std::size_t row : rows) {
    acceleration += (measured[row].acceleration - predicted[row].acceleration).squaredNorm();
    if (orientation == OrientationError::chord)
      angles += 0.5 * (measured[row].rotation - predicted[row].rotation).squaredNorm();
    else
      angles += Vec3(euler_angles(measured[row].rotation) - euler_angles(predicted[row].rotation))
                    .unaryExpr([](double x) { return wrapped(x); })
                    .squaredNorm();
  }
  const double n = std::max(1.0, static_cast<double>(rows.size()));
  return {std::sqrt((acceleration + angles) / n), std::sqrt(acceleration / n), std::sqrt(angles / n)};
}

std::vector<std::size_t> evenly_chosen(const std::vector<std::size_t>& rows, std::size_t count) {
  if (rows.size() <= count) return rows;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(rows[(2 * i + 1) * rows.size() / (2 * count)]);
  return chosen;
}

}  // namespace kinfer
