// J_RMSE of one link (paper 1, eqs. 20-26): what a product of DH leaves behind a known parent predicts, against what
// the child's INS measured.
//
// The fast form: rows lie in blocks, each an even sample of the whole recording; the state of a block runs through the
// leaves in plain loops; an evaluation is given up as soon as its blocks so far exceed the bound.
#pragma once

#include <memory>

#include "kinfer/identify/link_motion.hpp"

namespace kinfer {

/// How eq. (20) measures an orientation.
enum class OrientationError {
  euler,  ///< roll, pitch and yaw of eq. (23), differences wrapped
  chord   ///< |R - R~| (Frobenius) over sqrt 2: the angle between the two to third order, without gimbal lock
};

struct LinkCostOptions {
  OrientationError orientation = OrientationError::chord;
  double length_prior = 1e-3;  ///< [m/s² per m] adds (length_prior · length)² to J²: keeps what no signal sees short
  double leaf_penalty = 2e-3;  ///< of J a leaf beyond the first: the simpler of two equal chains
  double use_penalty = 0.2;    ///< of J a signal beyond the first in the leaves: they explain the filter's errors
};

/// What eq. (20) sums over one link, and where it comes from.
struct JRmse {
  double total = 0.0;         ///< sqrt(acceleration² + orientation²)
  double acceleration = 0.0;  ///< [m/s²] root of the mean square, x y z summed
  double orientation = 0.0;   ///< [rad] likewise
};

struct LinkBlock;

class LinkCost {
 public:
  /// `rows` choose from parent, child and signals; their order does not matter. At least 1.
  LinkCost(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
           std::span<const JointSignal> signals, const std::vector<std::size_t>& rows, const LinkCostOptions& options);
  ~LinkCost();
  LinkCost(LinkCost&&) noexcept;

  /// J with its penalties; infinity where that is not below `bound`, and for a tree without a signal: it may come close
  /// for a joint that moves little, and then the whole population would settle there.
  double operator()(const DhTree& tree, double bound) const;

  /// Eq. (20) alone.
  JRmse j_rmse(std::span<const DhLeaf> leaves) const;

 private:
  std::vector<LinkBlock> blocks_;
  std::size_t rows_ = 0;
  LinkCostOptions options_;
};

/// Eq. (20) on the given rows by the slow way: judge of the fast one, and for rows that were not fitted.
JRmse j_rmse(const std::vector<FrameState>& predicted, const std::vector<FrameState>& measured,
             const std::vector<std::size_t>& rows, OrientationError orientation);

/// At most `count` of the rows, evenly spread.
std::vector<std::size_t> evenly_chosen(const std::vector<std::size_t>& rows, std::size_t count);

}  // namespace kinfer
