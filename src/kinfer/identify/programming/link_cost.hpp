// SPDX-License-Identifier: Apache-2.0
// J_RMSE of one link (paper 1, eqs. 20-26): the motion that a product of DH leaves on a known parent predicts, compared
// with what the child's INS measured.
//
// Fast implementation: rows are grouped into blocks, each an even sample of the whole recording; the state of a block
// is propagated through the leaves in plain loops; an evaluation ends as soon as its partial sum exceeds the bound.
#pragma once

#include <memory>

#include "kinfer/identify/programming/frame_state.hpp"
#include "kinfer/identify/programming/thresholds.hpp"

namespace kinfer::identify {

/// Orientation error in eq. (20).
enum class OrientationMetric {
  euler,  ///< roll, pitch and yaw of eq. (23), differences wrapped
  chord   ///< |R - R~| (Frobenius) over sqrt 2: the angle between the two to third order, without gimbal lock
};

struct LinkCostOptions {
  OrientationMetric orientation = OrientationMetric::chord;
  double length_prior = 1e-3;  ///< [m/s² per m] adds (length_prior · length)² to J²: keeps unobservable lengths short
  double leaf_penalty = 2e-3;   ///< of J per leaf beyond the first: prefers the simpler of two equal chains
  double signal_penalty = 0.2;  ///< of J per signal beyond the first: further signals only explain filter errors
};

/// Eq. (20) for one link, and its two parts.
struct JRmse {
  double total = 0.0;         ///< sqrt(acceleration² + orientation²)
  double acceleration = 0.0;  ///< [m/s²] root of the mean square, x y z summed
  double orientation = 0.0;   ///< [rad] likewise
};

struct LinkBlock;

class LinkCost {
 public:
  /// `rows`: indices into parent, child and signals, in any order; at least 1.
  LinkCost(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
           std::span<const JointSignal> signals, const std::vector<std::size_t>& rows, const LinkCostOptions& options);
  ~LinkCost();
  LinkCost(LinkCost&&) noexcept;

  /// J with its penalties; infinity where that is not below `bound`. Infinity, too, for a tree without a signal: for a
  /// joint that moves little it may come close, and the whole population would converge to it.
  double operator()(const DhTree& tree, double bound) const;

  /// Eq. (20) alone.
  JRmse j_rmse(std::span<const DhLeaf> leaves) const;

 private:
  std::vector<LinkBlock> blocks_;
  std::size_t rows_ = 0;
  LinkCostOptions options_;
};

/// Eq. (20) on the given rows, implemented plainly: reference for the fast version, and for rows that were not fitted.
JRmse j_rmse(const std::vector<FrameState>& predicted, const std::vector<FrameState>& measured,
             const std::vector<std::size_t>& rows, OrientationMetric orientation);

/// At most `count` of the rows, evenly spaced.
std::vector<std::size_t> thin_rows(const std::vector<std::size_t>& rows, std::size_t count);

}  // namespace kinfer::identify
