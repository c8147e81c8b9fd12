// SPDX-License-Identifier: Apache-2.0
// Motion of all bodies at the nodes of an interval, with derivatives with respect to the spline coefficients and the
// global parameters.
#pragma once

#include "kinfer/estimate/continuous/model/problem.hpp"

namespace kinfer {

inline Eigen::Index number_of(const std::vector<Eigen::Index>& unknowns) {
  return static_cast<Eigen::Index>(unknowns.size());
}

/// The unknowns on which a body's state depends.
struct InsPath {
  std::vector<Eigen::Index> spline_dimensions;  ///< spline dimensions, ascending
  std::vector<Eigen::Index> rotational;         ///< global parameters: frame rotations
  std::vector<Eigen::Index> translational;  ///< global parameters that only affect specific force: points, root's force
};
std::vector<InsPath> paths_of(const InsProblem& problem, const InsLayout& layout, const InsBodies& bodies);

/// Bases at the nodes; the same in every interval.
std::array<SplineBasis, block_nodes> node_bases(const SplineGrid& grid);

/// States of all bodies at the position in an interval for which `basis` was evaluated.
std::vector<InsState> body_states(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                  Eigen::Index interval, const SplineBasis& basis);

constexpr Eigen::Index derivative_orders = 3;  // states depend on time derivatives 0 .. 2 of a spline dimension

/// States of one body at the nodes, and their transposed Jacobians with respect to the unknowns of its path. Column
/// component · nodes + node belongs to a state's component (in the order of the members of InsState) at a node.
struct BodyMotion {
  std::array<InsState, block_nodes> state;
  MatrixXd by_spline;      ///< dimensions · orders x 9 · nodes: by each spline dimension's time derivatives
  MatrixXd rotational;     ///< unknowns x 9·nodes
  MatrixXd translational;  ///< unknowns x 3·nodes: of the specific force
};

/// Unknowns of a linearisation.
enum class LinearisationScope {
  everything,
  spline_only  ///< spline coefficients only; global parameters are held
};

/// Motion of all bodies, interval by interval. The constructor's arguments must outlive it.
class IntervalMotion {
 public:
  IntervalMotion(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, LinearisationScope scope);

  void move_to(Eigen::Index interval);

  const InsPath& path(std::size_t body) const { return paths_[body]; }
  const BodyMotion& body(std::size_t body) const { return bodies_[body]; }
  const std::array<SplineBasis, block_nodes>& bases() const { return bases_; }

 private:
  void start_root();
  void propagate_from_parent(std::size_t body, Eigen::Index node);
  void append_own_derivatives(std::size_t body, Eigen::Index node);

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  LinearisationScope scope_;
  std::array<SplineBasis, block_nodes> bases_;
  std::vector<InsPath> paths_;
  std::vector<BodyMotion> bodies_;
  std::vector<PropagatedDerivative> propagated_;  // of each body; reused buffers
};

}  // namespace kinfer
