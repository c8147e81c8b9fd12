// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/slide_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/identify/structure/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

constexpr double window_length = 4.0;  // [s] noise that is integrated twice leaves some millimetres
constexpr std::size_t most_windows = 150, least_rows = 10;  // all of ten minutes; a longer log is sampled
constexpr int first_steps = 4, further_steps = 15;          // of each start, and of the best one
constexpr Eigen::Index shared = 6;                          // unknowns of all windows: p, b
constexpr Eigen::Index unknowns = 8;                        // and of one: x and ẋ at its beginning
constexpr Eigen::Index columns = unknowns + 1;

using RowOf = Eigen::Matrix<double, 1, columns>;  // linear in (p, b, x, ẋ, 1)

/// What d and K are at a row, in the parent.
struct RelativeRow {
  Vec3 difference, rate;
  Mat3 lever;  // K
};

using Window = std::vector<RelativeRow>;

RelativeRow relative_row(const SegmentMotion& parent, const SegmentMotion& child, std::size_t row) {
  const Mat3 parent_R_world = parent.rotation[row].transpose();
  const Vec3 rate = parent_R_world * parent.angular_velocity[row];
  const Mat3 w = skew(rate);
  return {parent_R_world * (child.acceleration[row] - parent.acceleration[row]), rate,
          skew(parent_R_world * parent.angular_acceleration[row]) + w * w};
}

/// Evenly spread over the motion; each ends at a gap.
std::vector<Window> windows_of(const RecordedMotion& motion, const SegmentMotion& parent, const SegmentMotion& child) {
  std::vector<Window> windows;
  if (!(motion.period > 0.0)) return windows;
  const auto length = std::max<std::size_t>(least_rows, static_cast<std::size_t>(window_length / motion.period));
  const std::size_t stride = length * (1 + (motion.rows() - motion.first_motion_row) / (length * most_windows));
  for (std::size_t first = motion.first_motion_row; first < motion.rows(); first += stride) {
    Window window;
    for (std::size_t row = first; row < std::min(first + length, motion.rows()); ++row)
      if (motion.usable[row])
        window.push_back(relative_row(parent, child, row));
      else if (!window.empty())
        break;
    if (window.size() >= least_rows) windows.push_back(std::move(window));
  }
  return windows;
}

/// x, ẋ and ẍ at a row, each linear in the unknowns.
struct SlideState {
  RowOf position = RowOf::Zero(), velocity = RowOf::Zero(), acceleration = RowOf::Zero();
};

/// ẍ = e · (d − K p − b) − (e · K e) x.
RowOf slide_acceleration(const RelativeRow& row, const RowOf& position, const Vec3& axis) {
  RowOf acceleration = -axis.dot(row.lever * axis) * position;
  acceleration.head<3>() -= axis.transpose() * row.lever;
  acceleration.segment<3>(3) -= axis.transpose();
  acceleration[unknowns] += axis.dot(row.difference);
  return acceleration;
}

/// From x and ẋ at the beginning of the window, by the velocity Verlet method (Swope et al. 1982).
std::vector<SlideState> slide_states(const Window& window, const Vec3& axis, double period) {
  std::vector<SlideState> states(window.size());
  states[0].position[shared] = states[0].velocity[shared + 1] = 1.0;
  states[0].acceleration = slide_acceleration(window[0], states[0].position, axis);
  for (std::size_t k = 1; k < window.size(); ++k) {
    const SlideState& before = states[k - 1];
    SlideState& at = states[k];
    at.position = before.position + period * before.velocity + 0.5 * period * period * before.acceleration;
    at.acceleration = slide_acceleration(window[k], at.position, axis);
    at.velocity = before.velocity + 0.5 * period * (before.acceleration + at.acceleration);
  }
  return states;
}

/// d − K p − b − 2 ẋ ω × e − x K e, across the axis.
Eigen::Matrix<double, 3, columns> residual_across(const RelativeRow& row, const SlideState& state, const Vec3& axis) {
  Eigen::Matrix<double, 3, columns> residual =
      -2.0 * row.rate.cross(axis) * state.velocity - row.lever * axis * state.position;
  residual.leftCols<3>() -= row.lever;
  residual.middleCols<3>(3) -= Mat3::Identity();
  residual.col(unknowns) += row.difference;
  return residual - axis * (axis.transpose() * residual);
}

/// The unknowns of each window, and what they leave.
struct WindowFit {
  std::vector<Eigen::Matrix<double, unknowns, 1>> unknowns_of;
  double mean_square = 0.0;
};

Eigen::Matrix<double, unknowns, 1> prior_weights() {
  const auto of = [](double sd) { return pair_acceleration_floor * pair_acceleration_floor / (sd * sd); };
  Eigen::Matrix<double, unknowns, 1> weights;
  weights << Vec3::Constant(of(lever_arm_sd)), Vec3::Constant(of(pair_bias_sd)), of(lever_arm_sd), of(lever_arm_sd);
  return weights;
}

WindowFit fit_windows(const std::vector<Window>& windows, const Vec3& axis, double period) {
  const Eigen::Index size = shared + 2 * static_cast<Eigen::Index>(windows.size());
  MatrixXd normal = MatrixXd::Zero(size, size);
  VectorXd right = VectorXd::Zero(size);
  double square = 0.0, count = 0.0;
  normal.diagonal().head<shared>() = prior_weights().head<shared>();
  for (std::size_t w = 0; w < windows.size(); ++w) {
    Eigen::Matrix<double, columns, columns> sums = Eigen::Matrix<double, columns, columns>::Zero();
    const auto states = slide_states(windows[w], axis, period);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const auto residual = residual_across(windows[w][k], states[k], axis);
      sums.noalias() += residual.transpose() * residual;
    }
    count += static_cast<double>(states.size());
    const Eigen::Index own = shared + 2 * static_cast<Eigen::Index>(w);
    normal.topLeftCorner<shared, shared>() += sums.topLeftCorner<shared, shared>();
    normal.block<shared, 2>(0, own) = sums.block<shared, 2>(0, shared);
    normal.block<2, shared>(own, 0) = sums.block<2, shared>(shared, 0);
    normal.block<2, 2>(own, own) = sums.block<2, 2>(shared, shared);
    normal.block<2, 2>(own, own).diagonal() += prior_weights().tail<2>();
    right.head<shared>() += sums.block<shared, 1>(0, unknowns);
    right.segment<2>(own) = sums.block<2, 1>(shared, unknowns);
    square += sums(unknowns, unknowns);
  }
  const VectorXd x = solve_spd(normal, -right).value_or(VectorXd::Zero(size));
  WindowFit fit{{}, std::max(0.0, square + x.dot(right)) / count};
  for (std::size_t w = 0; w < windows.size(); ++w) {
    fit.unknowns_of.emplace_back();
    fit.unknowns_of.back() << x.head<shared>(), x.segment<2>(shared + 2 * static_cast<Eigen::Index>(w));
  }
  return fit;
}

/// The axis by which the slide that was found along `axis` explains all of d best, p and b fitted anew.
Vec3 next_axis(const std::vector<Window>& windows, const WindowFit& fit, const Vec3& axis, double period) {
  using Mat9 = Eigen::Matrix<double, 9, 9>;
  Mat9 normal = Mat9::Zero();
  Eigen::Matrix<double, 9, 1> right = Eigen::Matrix<double, 9, 1>::Zero();
  for (std::size_t w = 0; w < windows.size(); ++w) {
    Eigen::Matrix<double, columns, 1> at;
    at << fit.unknowns_of[w], 1.0;
    const auto states = slide_states(windows[w], axis, period);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const RelativeRow& row = windows[w][k];
      Eigen::Matrix<double, 3, 9> design;
      design << states[k].acceleration.dot(at.transpose()) * Mat3::Identity() +
                    2.0 * states[k].velocity.dot(at.transpose()) * skew(row.rate) +
                    states[k].position.dot(at.transpose()) * row.lever,
          row.lever, Mat3::Identity();
      normal.noalias() += design.transpose() * design;
      right.noalias() += design.transpose() * row.difference;
    }
  }
  normal.diagonal().tail<shared>() += prior_weights().head<shared>();
  const auto solution = solve_spd(normal, right);
  return solution && solution->head<3>().norm() > 0.0 ? Vec3(solution->head<3>().normalized()) : axis;
}

struct SlideCandidate {
  Vec3 axis;
  WindowFit fit;
};

/// Each step halves the error of the axis.
void refine(SlideCandidate& candidate, const std::vector<Window>& windows, double period, int steps) {
  constexpr double settled = 1e-3;  // [rad]
  for (int k = 0; k < steps; ++k) {
    const Vec3 axis = next_axis(windows, candidate.fit, candidate.axis, period);
    WindowFit fit = fit_windows(windows, axis, period);
    if (!(fit.mean_square < candidate.fit.mean_square)) return;
    const double change = axis.cross(candidate.axis).norm();
    candidate = {axis, std::move(fit)};
    if (change < settled) return;
  }
}

/// Directions of d.
Mat3 starts_of(const std::vector<Window>& windows) {
  Mat3 spread = Mat3::Zero();
  for (const Window& window : windows)
    for (const RelativeRow& row : window) spread += row.difference * row.difference.transpose();
  return symmetric_eigen(spread).vectors;
}

}  // namespace

std::optional<SlideFit> fit_slide(const RecordedMotion& motion, const SegmentMotion& parent,
                                  const SegmentMotion& child) {
  const auto windows = windows_of(motion, parent, child);
  if (windows.empty()) return std::nullopt;
  const Mat3 starts = starts_of(windows);
  std::optional<SlideCandidate> best;
  for (const Eigen::Index start : {2, 1, 0}) {
    SlideCandidate candidate{starts.col(start), fit_windows(windows, starts.col(start), motion.period)};
    refine(candidate, windows, motion.period, first_steps);
    if (!best || candidate.fit.mean_square < best->fit.mean_square) best = std::move(candidate);
  }
  refine(*best, windows, motion.period, further_steps);
  return SlideFit{best->axis, best->fit.unknowns_of.front().head<3>(), std::sqrt(best->fit.mean_square)};
}

Vec3 acceleration_beyond(const SegmentMotion& parent, const SegmentMotion& child, const Vec3& offset, std::size_t row) {
  const RelativeRow at = relative_row(parent, child, row);
  return at.difference - at.lever * offset;
}

}  // namespace kinfer::identify
