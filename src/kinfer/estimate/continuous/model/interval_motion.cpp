// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/interval_motion.hpp"

#include "kinfer/linalg/block_products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

double spline_dimension_value(const MatrixXd& coefficients, Index spline_dimension, Index interval,
                              const SplineBasis& basis, Index order) {
  double sum = 0.0;
  for (Index i = 0; i < spline_order; ++i)
    sum += basis.at[static_cast<std::size_t>(order)][static_cast<std::size_t>(i)] *
           coefficients(spline_dimension, interval + i);
  return sum;
}

InsState root_state(const InsProblem& problem, const InsUnknowns& x, Index interval, const SplineBasis& basis) {
  InsState state;
  if (problem.root_at_rest) {
    state.force = x.root_force;
    return state;
  }
  for (Index i = 0; i < 3; ++i) {
    state.angular_velocity[i] = spline_dimension_value(x.spline_coefficients, i, interval, basis, 0);
    state.angular_acceleration[i] = spline_dimension_value(x.spline_coefficients, i, interval, basis, 1);
    state.force[i] = spline_dimension_value(x.spline_coefficients, 3 + i, interval, basis, 0);
  }
  return state;
}

JointKinematicState joint_state(const InsLayout& layout, const InsUnknowns& x, std::size_t body, Index interval,
                                const SplineBasis& basis) {
  JointKinematicState q{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (Index i = 0; i < degrees_of_freedom(x.bodies[body].motion); ++i)
    for (Index order = 0; order < 3; ++order)
      q[static_cast<std::size_t>(order)][i] =
          spline_dimension_value(x.spline_coefficients, layout.spline_dimension[body] + i, interval, basis, order);
  return q;
}

constexpr Index orders = derivative_orders;

/// View of some components at one node, restricted to the first rows.
template <class Matrix>
auto at_node(Matrix& derivatives, Index rows, Index first, Index components, Index node) {
  using Plain = std::conditional_t<std::is_const_v<Matrix>, const MatrixXd, MatrixXd>;
  return Eigen::Map<Plain, 0, Eigen::OuterStride<>>(
      derivatives.data() + (first * block_nodes + node) * derivatives.rows(), rows, components,
      Eigen::OuterStride<>(block_nodes * derivatives.rows()));
}

}  // namespace

std::vector<InsPath> paths_of(const InsProblem& problem, const InsLayout& layout, const InsBodies& bodies) {
  std::vector<InsPath> paths(bodies.size());
  const auto append = [](std::vector<Index>& to, Index first, Index count) {
    for (Index i = 0; i < count; ++i) to.push_back(first + i);
  };
  if (!problem.root_at_rest) append(paths[0].spline_dimensions, 0, 6);
  if (problem.root_at_rest) append(paths[0].translational, layout.root_force, 3);
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    paths[b] = paths[static_cast<std::size_t>(bodies[b].parent)];
    append(paths[b].spline_dimensions, layout.spline_dimension[b], degrees_of_freedom(bodies[b].motion));
    const Index turns = bodies[b].turns(), points = bodies[b].unknowns() - turns;
    append(paths[b].rotational, layout.body[b], turns);
    append(paths[b].translational, layout.body[b] + turns, points);
  }
  return paths;
}

std::array<SplineBasis, block_nodes> node_bases(const SplineGrid& grid) {
  std::array<SplineBasis, block_nodes> bases;
  for (std::size_t i = 0; i < block_nodes; ++i) bases[i] = spline_basis(block_nodes_u()[i], grid.period);
  return bases;
}

std::vector<InsState> body_states(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                  Index interval, const SplineBasis& basis) {
  std::vector<InsState> states{root_state(problem, x, interval, basis)};
  for (std::size_t b = 1; b < x.bodies.size(); ++b)
    states.push_back(propagated(x.bodies[b], joint_state(layout, x, b, interval, basis),
                                states[static_cast<std::size_t>(x.bodies[b].parent)]));
  return states;
}

IntervalMotion::IntervalMotion(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                               LinearisationScope scope)
    : problem_(problem),
      layout_(layout),
      x_(x),
      scope_(scope),
      bases_(node_bases(problem.grid)),
      paths_(paths_of(problem, layout, x.bodies)),
      propagated_(x.bodies.size()) {
  for (InsPath& path : paths_) {
    if (scope == LinearisationScope::spline_only) path.rotational.clear(), path.translational.clear();
    bodies_.push_back(
        {.state = {},
         .by_spline = MatrixXd::Zero(orders * number_of(path.spline_dimensions), state_size * block_nodes),
         .rotational = MatrixXd::Zero(number_of(path.rotational), state_size * block_nodes),
         .translational = MatrixXd::Zero(number_of(path.translational), 3 * block_nodes)});
  }
  start_root();
}

/// The root's derivatives are constant.
void IntervalMotion::start_root() {
  BodyMotion& root = bodies_.front();
  for (Index node = 0; node < block_nodes; ++node)
    for (Index i = 0; i < 3; ++i) {
      const auto column = [&](Index component) { return component * block_nodes + node; };
      if (!problem_.root_at_rest) {
        root.by_spline(orders * i, column(i)) = root.by_spline(orders * i + 1, column(3 + i)) = 1.0;
        root.by_spline(orders * (3 + i), column(6 + i)) = 1.0;
      }
      if (root.translational.size() > 0) root.translational(i, column(i)) = 1.0;
    }
}

void IntervalMotion::move_to(Index interval) {
  for (std::size_t node = 0; node < block_nodes; ++node)
    bodies_.front().state[node] = root_state(problem_, x_, interval, bases_[node]);
  for (std::size_t b = 1; b < bodies_.size(); ++b) {
    BodyMotion& body = bodies_[b];
    const BodyMotion& parent = bodies_[static_cast<std::size_t>(x_.bodies[b].parent)];
    body.by_spline.setZero();
    body.rotational.setZero();
    body.translational.setZero();
    for (std::size_t node = 0; node < block_nodes; ++node) {
      propagate(x_.bodies[b], joint_state(layout_, x_, b, interval, bases_[node]), parent.state[node], propagated_[b]);
      body.state[node] = propagated_[b].state;
      propagate_from_parent(b, static_cast<Index>(node));
      append_own_derivatives(b, static_cast<Index>(node));
    }
  }
}

/// Propagates the parent's derivatives to the body.
void IntervalMotion::propagate_from_parent(std::size_t b, Index node) {
  const BodyMotion& parent = bodies_[static_cast<std::size_t>(x_.bodies[b].parent)];
  BodyMotion& body = bodies_[b];
  const auto& by = propagated_[b].by_parent;
  const auto propagate = [&](const MatrixXd& from, MatrixXd& to, Index first, const auto& by_components) {
    const Index rows = from.rows(), components = by_components.cols();
    add_product(at_node(from, rows, first, components, node), by_components, 1.0,
                at_node(to, rows, first, components, node));
  };
  propagate(parent.by_spline, body.by_spline, 0, by);
  propagate(parent.rotational, body.rotational, 0, by);
  propagate(parent.translational, body.translational, 0, by.block<3, 3>(force_row, force_row));
}

/// Derivatives with respect to the joint's own trajectory and parameters, behind those inherited from the parent.
void IntervalMotion::append_own_derivatives(std::size_t b, Index node) {
  const StateJacobian& own = propagated_[b].by_own;
  BodyMotion& body = bodies_[b];
  const Index read = orders * degrees_of_freedom(x_.bodies[b].motion), turns = x_.bodies[b].turns(),
              points = x_.bodies[b].unknowns() - turns;
  at_node(body.by_spline, body.by_spline.rows(), 0, state_size, node).bottomRows(read) = own.leftCols(read).transpose();
  if (scope_ == LinearisationScope::spline_only) return;
  at_node(body.rotational, body.rotational.rows(), 0, state_size, node).bottomRows(turns) =
      own.middleCols(read, turns).transpose();
  at_node(body.translational, body.translational.rows(), 0, 3, node).bottomRows(points) =
      own.middleRows<3>(6).rightCols(points).transpose();
}

}  // namespace kinfer
