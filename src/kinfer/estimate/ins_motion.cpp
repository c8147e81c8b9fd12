#include "kinfer/estimate/ins_motion.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

double band_value(const MatrixXd& band, Index channel, Index interval, const SplineBasis& basis, Index order) {
  double sum = 0.0;
  for (Index i = 0; i < spline_order; ++i)
    sum += basis.at[static_cast<std::size_t>(order)][static_cast<std::size_t>(i)] * band(channel, interval + i);
  return sum;
}

InsState root_state(const InsProblem& problem, const InsUnknowns& x, Index interval, const SplineBasis& basis) {
  InsState state;
  if (problem.root_stands_still) {
    state.force = x.root_force;
    state.field = x.root_field;
    return state;
  }
  for (Index i = 0; i < 3; ++i) {
    state.rate[i] = band_value(x.band, i, interval, basis, 0);
    state.rate_change[i] = band_value(x.band, i, interval, basis, 1);
    state.force[i] = band_value(x.band, 3 + i, interval, basis, 0);
  }
  return state;
}

JointReading joint_reading(const InsLayout& layout, const InsUnknowns& x, std::size_t body, Index interval,
                           const SplineBasis& basis) {
  JointReading q{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (Index i = 0; i < freedoms(x.bodies[body].motion); ++i)
    for (Index order = 0; order < 3; ++order)
      q[static_cast<std::size_t>(order)][i] = band_value(x.band, layout.channel[body] + i, interval, basis, order);
  return q;
}

NodeMotion root_motion(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, Index interval,
                       const SplineBasis& basis) {
  NodeMotion motion;
  motion.state.push_back(root_state(problem, x, interval, basis));
  StateColumns columns = StateColumns::Zero(12, problem.root_stands_still ? (layout.has_field ? 6 : 3) : 9);
  if (problem.root_stands_still) {
    columns.block<3, 3>(6, 0).setIdentity();
    if (layout.has_field) columns.block<3, 3>(9, 3).setIdentity();
  } else {
    columns.topRows<9>().setIdentity();
  }
  motion.columns.push_back(std::move(columns));
  return motion;
}

}  // namespace

InsPaths paths_of(const InsProblem& problem, const InsLayout& layout, const InsBodies& bodies) {
  InsPaths paths{std::vector<std::vector<InsColumn>>(bodies.size()), std::vector<std::vector<Index>>(bodies.size())};
  auto& root = paths.columns.front();
  if (problem.root_stands_still) {
    for (Index i = 0; i < 3; ++i) root.push_back({.border = layout.root_force + i});
    if (layout.has_field)
      for (Index i = 0; i < 3; ++i) root.push_back({.border = layout.root_field + i});
  } else {
    for (Index i = 0; i < 3; ++i) root.push_back({.channel = i, .order = 0});
    for (Index i = 0; i < 3; ++i) root.push_back({.channel = i, .order = 1});
    for (Index i = 3; i < 6; ++i) root.push_back({.channel = i, .order = 0});
    paths.channels.front() = {0, 1, 2, 3, 4, 5};
  }
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    const auto parent = static_cast<std::size_t>(bodies[b].parent);
    paths.columns[b] = paths.columns[parent];
    paths.channels[b] = paths.channels[parent];
    for (Index i = 0; i < freedoms(bodies[b].motion); ++i) {
      paths.channels[b].push_back(layout.channel[b] + i);
      for (Index order = 0; order < 3; ++order)
        paths.columns[b].push_back({.channel = layout.channel[b] + i, .order = order});
    }
    for (Index i = 0; i < bodies[b].unknowns(); ++i) paths.columns[b].push_back({.border = layout.body[b] + i});
  }
  return paths;
}

std::array<SplineBasis, block_nodes> node_bases(const SplineGrid& grid) {
  std::array<SplineBasis, block_nodes> bases;
  for (std::size_t i = 0; i < block_nodes; ++i) bases[i] = spline_basis(block_places()[i], grid.period);
  return bases;
}

std::vector<InsState> body_states(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                  Index interval, const SplineBasis& basis) {
  std::vector<InsState> states{root_state(problem, x, interval, basis)};
  for (std::size_t b = 1; b < x.bodies.size(); ++b)
    states.push_back(carried(x.bodies[b], joint_reading(layout, x, b, interval, basis),
                             states[static_cast<std::size_t>(x.bodies[b].parent)]));
  return states;
}

NodeMotion node_motion(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, Index interval,
                       const SplineBasis& basis) {
  NodeMotion motion = root_motion(problem, layout, x, interval, basis);
  CarriedDerivative derivative;
  for (std::size_t b = 1; b < x.bodies.size(); ++b) {
    const auto parent = static_cast<std::size_t>(x.bodies[b].parent);
    carry(x.bodies[b], joint_reading(layout, x, b, interval, basis), motion.state[parent], derivative);
    const Index inherited = motion.columns[parent].cols();
    StateColumns columns(12, inherited + derivative.by_own.cols());
    columns.leftCols(inherited).noalias() = derivative.by_parent * motion.columns[parent];
    columns.rightCols(derivative.by_own.cols()) = derivative.by_own;
    motion.state.push_back(derivative.state);
    motion.columns.push_back(std::move(columns));
  }
  return motion;
}

}  // namespace kinfer
