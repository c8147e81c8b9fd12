// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/screening/connection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "kinfer/base/parallel.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/screening/thresholds.hpp"
#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using Rows = std::vector<std::size_t>;

constexpr std::size_t connection_rows = 400;     // of a fit: the code length per row does not need more
constexpr std::size_t min_connection_rows = 60;  // of a fit
constexpr std::size_t time_shifts = 7;
constexpr std::size_t max_parts = 6;
constexpr double min_part_time = 6.0;  // [s]

Rows usable_rows(const RecordedMotion& motion) {
  Rows rows;
  for (std::size_t row = motion.first_motion_row; row < motion.rows(); ++row)
    if (motion.usable[row]) rows.push_back(row);
  return rows;
}

/// At most so many of them, evenly spread.
Rows thinned(std::span<const std::size_t> rows, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, (rows.size() + most - 1) / most);
  Rows chosen;
  for (std::size_t i = 0; i < rows.size(); i += stride) chosen.push_back(rows[i]);
  return chosen;
}

/// The rows of a segment in place of which those that follow `shift` rows later are taken. Its headings restart where
/// they did in between.
SegmentMotion rows_of(const SegmentMotion& segment, std::span<const double> time, const Rows& rows, std::size_t shift) {
  SegmentMotion part;
  part.name = segment.name;
  const auto restarts_before = [&](std::size_t row) {
    return std::ranges::lower_bound(segment.restarts, time[row]) - segment.restarts.begin();
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = rows[(i + shift) % rows.size()];
    if (i > 0 && restarts_before(row) != restarts_before(rows[(i + shift - 1) % rows.size()]))
      part.restarts.push_back(0.5 * (time[rows[i - 1]] + time[rows[i]]));
    part.rotation.push_back(segment.rotation[row]);
    part.angular_velocity.push_back(segment.angular_velocity[row]);
    part.angular_acceleration.push_back(segment.angular_acceleration[row]);
    part.acceleration.push_back(segment.acceleration[row]);
  }
  return part;
}

/// The two segments alone, the second one's rows shifted circularly.
RecordedMotion shifted_pair(const RecordedMotion& motion, std::size_t first, std::size_t second, const Rows& rows,
                            std::size_t shift) {
  RecordedMotion pair;
  pair.gravity = motion.gravity;
  for (const std::size_t row : rows) pair.time.push_back(motion.time[row]);
  pair.usable.assign(rows.size(), true);
  pair.segments = {rows_of(motion.segments[first], motion.time, rows, 0),
                   rows_of(motion.segments[second], motion.time, rows, shift)};
  return pair;
}

Rows all_rows(const RecordedMotion& pair) {
  Rows all(pair.rows());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

double force_length(const PairFit& fit) {
  return code_length(fit.acceleration, pair_acceleration_floor);
}

double rate_length(const PairFit& fit) {
  return code_length(fit.angular_velocity, pair_rate_floor);
}

Mat3 mean_square_of(const std::vector<Vec3>& vectors) {
  Mat3 sum = Mat3::Zero();
  for (const Vec3& v : vectors) sum += v * v.transpose() / static_cast<double>(vectors.size());
  return sum;
}

bool is_motionless(const SegmentMotion& segment) {
  return mean_square_of(segment.acceleration).trace() < min_connection_excitation * min_connection_excitation &&
         mean_square_of(segment.angular_velocity).trace() < min_connection_rate * min_connection_rate;
}

/// Whether the pair may be a prismatic joint: neither turns relative to the other.
bool may_slide(const PairFit& fit) {
  return fit.relative_rate() < min_rotating_rate;
}

/// [m/s²] rms acceleration that no joint explains: across the axis, where the pair may be a prismatic joint.
double unexplained_acceleration(const PairFit& fit) {
  if (!may_slide(fit)) return fit.residual();
  const VectorXd squares = symmetric_eigen(fit.acceleration).values;
  return std::sqrt(std::max(0.0, squares[0] + squares[1]));
}

/// Code length of a vector along a line; nothing but its size is known of what it is across.
double line_length(const Mat3& mean_square, double floor) {
  const VectorXd squares = symmetric_eigen(mean_square).values;
  const double noise = floor * floor, across = 0.5 * (squares[0] + squares[1]) + noise;
  return 0.5 * std::log(squares[2] + noise) + std::log(across);
}

/// Code length of a vector of which nothing but its size is known.
double isotropic_length(const Mat3& mean_square, double floor) {
  return code_length(mean_square.trace() / 3.0 * Mat3::Identity(), floor);
}

/// Beside a segment at rest. Every machine that moves in a plane rotates about one axis of the world, so the rate
/// speaks for a joint there only if a point is at rest, too. Of a prismatic joint no point is at rest: it is a segment
/// that does not rotate, whose accelerations have one direction.
JointConnection connection_with_ground(const SegmentMotion& moving, const PairFit& fit) {
  const Mat3 acceleration = mean_square_of(moving.acceleration);
  JointConnection found{.residual = unexplained_acceleration(fit),
                        .shifted_residual = std::sqrt(acceleration.trace()),
                        .shifted_rate = fit.relative_rate()};
  if (may_slide(fit)) {
    found.force_gain = isotropic_length(acceleration, pair_acceleration_floor) -
                       line_length(fit.acceleration, pair_acceleration_floor);
    return found;
  }
  found.force_gain = isotropic_length(acceleration, min_connection_excitation) -
                     isotropic_length(fit.acceleration, min_connection_excitation);
  if (found.residual < small_residual || found.residual < 0.3 * found.shifted_residual)
    found.rate_gain = isotropic_length(fit.angular_velocity, pair_rate_floor) - rate_length(fit);
  return found;
}

struct FittedConnection {
  JointConnection connection;
  double length = 0.0;  // [nats per row]
};

FittedConnection connection_in(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                               std::span<const std::size_t> part) {
  const Rows rows = thinned(part, connection_rows);
  const RecordedMotion recorded = shifted_pair(motion, parent, child, rows, 0);
  const PairFit fit = fit_pair(recorded, 0, 1, all_rows(recorded));
  const double length = force_length(fit) + rate_length(fit);
  for (const std::size_t moving : {std::size_t{1}, std::size_t{0}})
    if (is_motionless(recorded.segments[1 - moving]))
      return {connection_with_ground(recorded.segments[moving], fit), length};
  std::vector<double> force, rate, sum, residual, off_axis;
  for (std::size_t k = 1; k <= time_shifts; ++k) {
    const RecordedMotion pair = shifted_pair(motion, parent, child, rows, k * rows.size() / (time_shifts + 1));
    const PairFit shifted = fit_pair(pair, 0, 1, all_rows(pair));
    force.push_back(force_length(shifted));
    rate.push_back(rate_length(shifted));
    sum.push_back(force.back() + rate.back());
    residual.push_back(shifted.residual());
    off_axis.push_back(shifted.off_axis_rate());
  }
  return {{.force_gain = median(force) - force_length(fit),
           .rate_gain = median(rate) - rate_length(fit),
           .gain_spread = standard_deviation(sum),
           .residual = unexplained_acceleration(fit),
           .shifted_residual = median(residual),
           .shifted_rate = median(off_axis)},
          length};
}

/// Whether the pair is connected in `one` part, and there was something to explain in the `other` without a connection.
bool is_connected_only_in(const JointConnection& one, const JointConnection& other) {
  return strength_of(one) == ConnectionStrength::strong && strength_of(other) == ConnectionStrength::none &&
         other.shifted_residual > excited_residual_ratio * one.residual;
}

/// Of so many parts of equal numbers of rows.
std::vector<PartConnection> connections_of_parts(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                                 const Rows& rows, std::size_t count) {
  std::vector<PartConnection> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = i * rows.size() / count, end = (i + 1) * rows.size() / count;
    const auto part = std::span(rows).subspan(begin, end - begin);
    const auto [connection, length] = connection_in(motion, parent, child, part);
    parts.push_back({motion.time[part.front()], motion.time[part.back()], connection, length});
  }
  return parts;
}

/// The parts that are connected, if there are `needed` such and as many others with something to explain that are not.
std::optional<PartConnection> connected_span(const std::vector<PartConnection>& parts, std::size_t needed) {
  std::vector<PartConnection> strong;
  for (const PartConnection& part : parts)
    if (strength_of(part.connection) == ConnectionStrength::strong) strong.push_back(part);
  if (strong.size() < needed) return std::nullopt;
  const auto unconnected = static_cast<std::size_t>(std::ranges::count_if(parts, [&](const PartConnection& part) {
    return is_connected_only_in(strong.front().connection, part.connection);
  }));
  if (unconnected < needed) return std::nullopt;
  return PartConnection{strong.front().begin, strong.back().end, strong.front().connection, strong.front().length};
}

}  // namespace

PairConnection pair_connection(const RecordedMotion& motion, std::size_t parent, std::size_t child) {
  const Rows rows = usable_rows(motion);
  PairConnection found{.parent = parent, .child = child};
  if (rows.size() < min_connection_rows) return found;
  const auto [whole, length] = connection_in(motion, parent, child, rows);
  found.whole = whole;
  found.length = length;
  const double seconds = motion.time[rows.back()] - motion.time[rows.front()];
  if (rows.size() < 2 * min_connection_rows || seconds < 2.0 * min_connection_time) return found;
  found.halves = connections_of_parts(motion, parent, child, rows, 2);
  const auto parts = std::min(max_parts, static_cast<std::size_t>(seconds / min_part_time));
  if (strength_of(found.whole) != ConnectionStrength::strong && parts > 2 && rows.size() > parts * min_connection_rows)
    found.parts = connections_of_parts(motion, parent, child, rows, parts);
  return found;
}

std::vector<PairConnection> tree_connections(const RecordedMotion& motion, const SegmentTree& tree, int threads) {
  std::vector<PairConnection> all;
  for (const std::size_t child : tree.order)
    if (tree.parent[child]) all.push_back({.parent = *tree.parent[child], .child = child});
  parallel_for(all.size(), threads,
               [&](std::size_t i) { all[i] = pair_connection(motion, all[i].parent, all[i].child); });
  return all;
}

ConnectionStrength strength_of(const JointConnection& connection) {
  const bool explains_all = connection.gain() >= no_connection_gain && connection.residual < small_residual;
  if (connection.gain() >= strong_connection_gain || explains_all) return ConnectionStrength::strong;
  if (connection.gain() >= no_connection_gain) return ConnectionStrength::weak;
  const bool something_moves =
      connection.shifted_residual > min_connection_excitation || connection.shifted_rate > min_connection_rate;
  return something_moves ? ConnectionStrength::none : ConnectionStrength::unexcited;
}

std::optional<PartConnection> only_connected_part(const PairConnection& pair) {
  if (const auto half = connected_span(pair.halves, 1)) return half;
  return connected_span(pair.parts, 2);
}

bool has_changed(const PairConnection& pair) {
  const auto is_explained_better = [&](const PartConnection& half) {
    return std::min(half.connection.gain() - pair.whole.gain(), pair.length - half.length) > max_gain_of_halves;
  };
  return pair.halves.size() == 2 && std::ranges::all_of(pair.halves, is_explained_better);
}

}  // namespace kinfer::identify
