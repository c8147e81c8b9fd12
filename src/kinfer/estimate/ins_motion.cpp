#include "kinfer/estimate/ins_motion.hpp"

#include "kinfer/linalg/block_products.hpp"

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

constexpr Index orders = channel_orders;

/// Some components at one node, of the first rows.
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
  if (!problem.root_stands_still) append(paths[0].channels, 0, 6);
  if (problem.root_stands_still) append(paths[0].shifting, layout.root_force, 3);
  if (layout.has_field) append(paths[0].turning, layout.root_field, 3);
  for (std::size_t b = 1; b < bodies.size(); ++b) {
    paths[b] = paths[static_cast<std::size_t>(bodies[b].parent)];
    append(paths[b].channels, layout.channel[b], freedoms(bodies[b].motion));
    const Index turns = bodies[b].turns(), points = bodies[b].unknowns() - turns;
    append(paths[b].turning, layout.body[b], turns);
    append(paths[b].shifting, layout.body[b] + turns, points);
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

IntervalMotion::IntervalMotion(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, InsScope scope)
    : problem_(problem),
      layout_(layout),
      x_(x),
      scope_(scope),
      bases_(node_bases(problem.grid)),
      paths_(paths_of(problem, layout, x.bodies)),
      carried_(x.bodies.size()) {
  for (InsPath& path : paths_) {
    if (scope == InsScope::band) path.turning.clear(), path.shifting.clear();
    bodies_.push_back({.state = {},
                       .band = MatrixXd::Zero(orders * number_of(path.channels), 12 * block_nodes),
                       .turning = MatrixXd::Zero(number_of(path.turning), 12 * block_nodes),
                       .shifting = MatrixXd::Zero(number_of(path.shifting), 3 * block_nodes)});
  }
  start_root();
}

/// Its derivatives are the same everywhere.
void IntervalMotion::start_root() {
  BodyMotion& root = bodies_.front();
  for (Index node = 0; node < block_nodes; ++node)
    for (Index i = 0; i < 3; ++i) {
      const auto column = [&](Index component) { return component * block_nodes + node; };
      if (!problem_.root_stands_still) {
        root.band(orders * i, column(i)) = root.band(orders * i + 1, column(3 + i)) = 1.0;
        root.band(orders * (3 + i), column(6 + i)) = 1.0;
      }
      if (root.shifting.size() > 0) root.shifting(i, column(i)) = 1.0;
      if (root.turning.size() > 0) root.turning(i, column(9 + i)) = 1.0;
    }
}

void IntervalMotion::go_to(Index interval) {
  for (std::size_t node = 0; node < block_nodes; ++node)
    bodies_.front().state[node] = root_state(problem_, x_, interval, bases_[node]);
  for (std::size_t b = 1; b < bodies_.size(); ++b) {
    BodyMotion& body = bodies_[b];
    const BodyMotion& parent = bodies_[static_cast<std::size_t>(x_.bodies[b].parent)];
    body.band.setZero();
    body.turning.setZero();
    body.shifting.setZero();
    for (std::size_t node = 0; node < block_nodes; ++node) {
      carry(x_.bodies[b], joint_reading(layout_, x_, b, interval, bases_[node]), parent.state[node], carried_[b]);
      body.state[node] = carried_[b].state;
      carry_on(b, static_cast<Index>(node));
      put_own(b, static_cast<Index>(node));
    }
  }
}

/// What reached the parent reaches the body.
void IntervalMotion::carry_on(std::size_t b, Index node) {
  const BodyMotion& parent = bodies_[static_cast<std::size_t>(x_.bodies[b].parent)];
  BodyMotion& body = bodies_[b];
  const Eigen::Matrix<double, 12, 12>& by = carried_[b].by_parent;
  const auto carry = [&](const MatrixXd& from, MatrixXd& to, Index first, const auto& by_components) {
    const Index rows = from.rows(), components = by_components.cols();
    add_product(at_node(from, rows, first, components, node), by_components, 1.0,
                at_node(to, rows, first, components, node));
  };
  carry(parent.band, body.band, 0, by.topLeftCorner<9, 9>());
  carry(parent.turning, body.turning, 0, by.topLeftCorner<9, 9>());
  carry(parent.shifting, body.shifting, 0, by.block<3, 3>(6, 6));
  if (!layout_.has_field) return;
  carry(parent.band, body.band, 9, by.bottomRightCorner<3, 3>());
  carry(parent.turning, body.turning, 9, by.bottomRightCorner<3, 3>());
}

/// The joint's readings and what holds for good of it stand behind what reached the parent.
void IntervalMotion::put_own(std::size_t b, Index node) {
  const StateColumns& own = carried_[b].by_own;
  BodyMotion& body = bodies_[b];
  const Index read = orders * freedoms(x_.bodies[b].motion), turns = x_.bodies[b].turns(),
              points = x_.bodies[b].unknowns() - turns;
  at_node(body.band, body.band.rows(), 0, 12, node).bottomRows(read) = own.leftCols(read).transpose();
  if (scope_ == InsScope::band) return;
  at_node(body.turning, body.turning.rows(), 0, 12, node).bottomRows(turns) = own.middleCols(read, turns).transpose();
  at_node(body.shifting, body.shifting.rows(), 0, 3, node).bottomRows(points) =
      own.middleRows<3>(6).rightCols(points).transpose();
}

}  // namespace kinfer
