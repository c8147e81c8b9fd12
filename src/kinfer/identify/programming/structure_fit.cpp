// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/structure_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/programming/angle_start.hpp"
#include "kinfer/identify/programming/linear_columns.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;
constexpr std::int64_t whole_pass = 8;  // eighths of a pass over all rows

/// The constants of the leaves' angles, in order.
std::vector<double*> constant_angles(const LinkStructure& structure, std::vector<DhLeaf>& leaves) {
  std::vector<double*> constants;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (has_constant(structure.leaves[i].theta)) constants.push_back(&leaves[i].theta);
    if (has_constant(structure.leaves[i].alpha)) constants.push_back(&leaves[i].alpha);
  }
  return constants;
}

/// The index of the leaf of each of them.
std::vector<std::size_t> constant_leaves(const LinkStructure& structure) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < structure.leaves.size(); ++i) {
    if (has_constant(structure.leaves[i].theta)) list.push_back(i);
    if (has_constant(structure.leaves[i].alpha)) list.push_back(i);
  }
  return list;
}

std::vector<DhLeaf> leaves_of(const LinkStructure& structure) {
  const auto signal = [](AngleKind kind) {
    return kind == AngleKind::signal || kind == AngleKind::offset_signal ? 0 : DhLeaf::constant;
  };
  std::vector<DhLeaf> leaves;
  for (const LeafStructure& leaf : structure.leaves)
    leaves.push_back({.theta_signal = signal(leaf.theta), .alpha_signal = signal(leaf.alpha)});
  return leaves;
}

MatrixXd full_symmetric(const MatrixXd& lower) {
  return lower.selfadjointView<Eigen::Lower>();
}

void set_lengths(std::vector<DhLeaf>& leaves, const VectorXd& x) {
  for (std::size_t l = 0; l < leaves.size(); ++l) {
    leaves[l].d = x[2 * static_cast<Index>(l)];
    leaves[l].a = x[2 * static_cast<Index>(l) + 1];
  }
}

}  // namespace

/// Normal equations of the linear unknowns (last) and, on request, of the angles before them.
struct StructureFitter::Normal {
  MatrixXd matrix;
  VectorXd right;
  double square = 0.0;  // of the residual at zero linear unknowns
  double rows = 0.0;
};

StructureFitter::~StructureFitter() = default;

StructureFitter::StructureFitter(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                                 std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                                 const StructureFitOptions& options)
    : blocks_(make_link_blocks(parent, child, signals, rows)),
      rows_(rows.size()),
      screening_blocks_((blocks_.size() + 7) / 8),
      options_(options) {
  KINFER_EXPECT(signals.size() == 1, "{} signals", signals.size());
  moments_.fill(Mat3::Zero());
  for (const std::size_t row : rows) {
    const Mat3 relative = parent[row].rotation.transpose() * child[row].rotation;
    const double q = signals.front().angle[row];
    moments_[0] += relative;
    moments_[1] += std::cos(q) * relative;
    moments_[2] += std::sin(q) * relative;
  }
  const AngleStart at = initial_angles(revolute_structure());
  revolute_chord_ = at.square;
  std::int64_t eighths = 0;
  revolute_screening_ = screening_cost(revolute_structure(), at.leaves, eighths);
  const StructureFit revolute = fit_all_parameters(revolute_structure(), at.leaves, eighths);
  revolute_j_ = revolute.j;
  std::array<std::vector<double>, 3> series;
  for (auto& s : series) s.resize(blocks_.size() * block_width, 0.0);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const FrameLanes state = blocks_[b].propagate(revolute.leaves);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < block_width; ++i)
        series[c][i * blocks_.size() + b] = blocks_[b].acceleration[c][i] - state.acceleration[c][i];
  }
  effective_sample_count_ = 0.0;
  for (auto& s : series) effective_sample_count_ += effective_samples(std::span(s).first(rows_));
}

StructureFitter::AngleStart StructureFitter::initial_angles(const LinkStructure& structure) const {
  const int start_count = revolute_chord_ < 0.0 ? 16 : 4;    // more for the general revolute joint, once
  constexpr double convergence = 1e-7, same_optimum = 1e-4;  // [rad²] of the mean squared chord
  const auto n = static_cast<double>(rows_);
  AngleStart best{{}, std::numeric_limits<double>::infinity()};
  for (int s = 0; s < start_count && best.square > revolute_chord_ + same_optimum; ++s) {
    std::vector<DhLeaf> leaves = leaves_of(structure);
    const auto angles = constant_angles(structure, leaves);
    for (std::size_t i = 0; i < angles.size(); ++i) *angles[i] = 2.4 * s + 1.7 * static_cast<double>(i) + 0.3;
    const double square = 3.0 - maximise_agreement(leaves, angles, moments_, convergence * n) / n;
    if (square < best.square) best = {std::move(leaves), square};
  }
  return best;
}

StructureFitter::Normal StructureFitter::normal(const LinkStructure& structure, const std::vector<DhLeaf>& leaves,
                                                std::span<const LinkBlock> blocks, bool with_angles) const {
  constexpr double difference_step = 1e-6;  // [rad]
  std::vector<DhLeaf> moved = leaves;
  const auto angles = with_angles ? constant_angles(structure, moved) : std::vector<double*>{};
  const auto k = static_cast<Index>(angles.size()), linear = 2 * static_cast<Index>(leaves.size()) + bias_count;
  Normal sum{MatrixXd::Zero(k + linear, k + linear), VectorXd::Zero(k + linear)};
  FrameLanes frame;
  const std::vector<std::size_t> leaf = constant_leaves(structure);
  std::vector<FrameLanes> shifted(angles.size());
  for (const LinkBlock& block : blocks) {
    std::vector<Lanes3> columns = linear_columns(block, leaves, frame);
    std::vector<FrameLanes> before;  // state before each leaf, shared by all angles from there on
    FrameLanes state = with_angles ? block.parent : frame;
    for (std::size_t l = 0; with_angles && l < leaves.size(); ++l) {
      before.push_back(state);
      block.apply_leaves(state, std::span(leaves).subspan(l, 1));
    }
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double angle = *angles[i];
      *angles[i] = angle + difference_step;
      shifted[i] = before[leaf[i]];
      block.apply_leaves(shifted[i], std::span(moved).subspan(leaf[i]));
      *angles[i] = angle;
      Lanes3 derivative = difference(shifted[i].acceleration, state.acceleration);
      for (Lane& lane : derivative)
        for (double& value : lane) value /= difference_step;
      columns.insert(columns.begin() + static_cast<std::ptrdiff_t>(i), derivative);
    }
    const Lanes3 left = difference(block.acceleration, frame.acceleration);
    for (Index i = 0; i < k + linear; ++i) {
      sum.right[i] += dot(columns[static_cast<std::size_t>(i)], left, block.weight);
      for (Index j = 0; j <= i; ++j)
        sum.matrix(i, j) +=
            dot(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)], block.weight);
    }
    sum.square += dot(left, left, block.weight) + block.squared_chord(state);
    for (const double w : block.weight) sum.rows += w;
    for (std::size_t axis = 0; axis < 3 && k > 0; ++axis) {
      const Lanes3 turned = difference(block.axes[axis], state.axes[axis]);
      std::vector<Lanes3> derivatives;
      for (const FrameLanes& s : shifted) derivatives.push_back(difference(s.axes[axis], state.axes[axis]));
      const double scale = 0.5 / difference_step;
      for (Index i = 0; i < k; ++i) {
        sum.right[i] += scale * dot(derivatives[static_cast<std::size_t>(i)], turned, block.weight);
        for (Index j = 0; j <= i; ++j)
          sum.matrix(i, j) +=
              scale / difference_step *
              dot(derivatives[static_cast<std::size_t>(i)], derivatives[static_cast<std::size_t>(j)], block.weight);
      }
    }
  }
  for (Index i = k; i < k + linear; ++i) {
    const double prior = i < k + linear - bias_count ? options_.length_prior : options_.bias_prior;
    sum.matrix(i, i) += sum.rows * prior * prior;
  }
  return sum;
}

namespace {

struct LinearSolution {
  VectorXd x;
  double j = std::numeric_limits<double>::infinity();
};

}  // namespace

double StructureFitter::screening_cost(const LinkStructure& structure, const std::vector<DhLeaf>& leaves,
                                       std::int64_t& eighths) const {
  const Normal n = normal(structure, leaves, std::span(blocks_).first(screening_blocks_), false);
  ++eighths;
  const auto x = solve_spd(n.matrix, n.right);
  return x ? std::sqrt(std::max(0.0, n.square - x->dot(n.right)) / n.rows) : std::numeric_limits<double>::infinity();
}

StructureFit StructureFitter::fit_all_parameters(const LinkStructure& structure, std::vector<DhLeaf> leaves,
                                                 std::int64_t eighths) const {
  const auto solve = [&](std::vector<DhLeaf>& at) {
    const Normal n = normal(structure, at, blocks_, false);
    eighths += whole_pass;
    const auto x = solve_spd(n.matrix, n.right);
    if (!x) return LinearSolution{};
    set_lengths(at, *x);
    return LinearSolution{*x, std::sqrt(std::max(0.0, n.square - x->dot(n.right)) / n.rows)};
  };
  LinearSolution best = solve(leaves);
  const auto k = static_cast<Index>(constant_count(structure));
  // Not search/least_squares: each evaluation solves for the lengths, and the fit ends at 1e-5 of J, so that another
  // damping gives another result.
  constexpr double tolerance = 1e-5;  // relative decrease of J
  double damping = 1e-3;
  for (int step = 0; step < options_.max_iterations && k > 0 && best.x.size() > 0; ++step) {
    Normal n = normal(structure, leaves, blocks_, true);
    eighths += whole_pass * (1 + k);
    VectorXd right = n.right - full_symmetric(n.matrix).rightCols(best.x.size()) * best.x;
    const double before = best.j;
    bool is_better = false;
    for (int tries = 0; tries < 5 && !is_better; ++tries, damping *= is_better ? 0.2 : 5.0) {
      MatrixXd damped = n.matrix;
      for (Index i = 0; i < k; ++i) damped(i, i) += damping * damped(i, i) + 1e-12 * n.rows;
      const auto change = solve_spd(damped, right);
      if (!change) continue;
      std::vector<DhLeaf> moved = leaves;
      const auto angles = constant_angles(structure, moved);
      for (Index i = 0; i < k; ++i) *angles[static_cast<std::size_t>(i)] += (*change)[i];
      if (const LinearSolution other = solve(moved); other.j < best.j) {
        leaves = std::move(moved);
        best = other;
        is_better = true;
      }
    }
    if (!is_better || before - best.j < tolerance * before) break;
  }
  for (DhLeaf& leaf : leaves) leaf.theta = wrap_to_pi(leaf.theta), leaf.alpha = wrap_to_pi(leaf.alpha);
  return {std::move(leaves), best.j, (eighths + whole_pass - 1) / whole_pass, true};
}

StructureFit StructureFitter::fit(const LinkStructure& structure) const {
  AngleStart at = initial_angles(structure);
  const double orientation_j = std::sqrt(std::max(0.0, at.square));
  if (orientation_j > options_.rejection_ratio * revolute_j_) return {std::move(at.leaves), orientation_j, 1, false};
  std::int64_t eighths = 0;
  const double screening = screening_cost(structure, at.leaves, eighths);
  if (!(screening < options_.rejection_ratio * revolute_screening_)) return {std::move(at.leaves), screening, 1, false};
  return fit_all_parameters(structure, std::move(at.leaves), eighths);
}

}  // namespace kinfer::identify
