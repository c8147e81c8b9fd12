#include "kinfer/estimate/ins_linearisation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/ins_fact_rows.hpp"
#include "kinfer/estimate/ins_motion.hpp"
#include "kinfer/estimate/ins_residual.hpp"
#include "kinfer/estimate/ins_sensor_system.hpp"
#include "kinfer/estimate/ins_wander.hpp"
#include "kinfer/linalg/block_products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;
constexpr Index item_intervals = 8;  // of one work item; fixed, so that sums never depend on the number of threads

// ---- Priors on the band ---------------------------------------------------------------------------------------------

/// Sd of the third difference of a channel's coefficients: [unit/s³] times period cubed. Far above what shaking hands
/// do: it only bridges stretches in which nothing was said.
double roughness_sd(const InsProblem& problem, Index channel) {
  constexpr double joint = 3e4, root_rate = 1e6, root_force = 1e7;
  const double h = problem.grid.period, cubed = h * h * h;
  if (problem.root_stands_still || channel >= 6) return joint * cubed;
  return (channel < 3 ? root_rate : root_force) * cubed;
}

constexpr double anchor_sd = 3.0;  // [rad] or [m]

/// Calls visit(weights over the six coefficients, value, sd) for each prior residual that belongs to the interval.
template <class Visit>
void each_band_prior(const InsProblem& problem, const InsLayout& layout, const MatrixXd& band, Index interval,
                     const Visit& visit) {
  const bool last = interval + 1 == problem.grid.intervals;
  for (Index channel = 0; channel < layout.channels; ++channel) {
    const double sd = roughness_sd(problem, channel);
    for (Index shift = 0; shift <= (last ? 2 : 0); ++shift) {
      Eigen::Matrix<double, spline_order, 1> weights = Eigen::Matrix<double, spline_order, 1>::Zero();
      weights.segment<4>(shift) << -1.0, 3.0, -3.0, 1.0;
      visit(channel, weights, weights.dot(band.row(channel).segment<spline_order>(interval).transpose()), sd);
    }
    const Index joint = channel - (problem.root_stands_still ? 0 : 6);
    if (interval == 0 && joint >= 0) {
      const double start = problem.anchor.empty() ? 0.0 : problem.anchor[static_cast<std::size_t>(joint)];
      visit(channel, Eigen::Matrix<double, spline_order, 1>::Unit(0), band(channel, 0) - start, anchor_sd);
    }
  }
}

void add_band_prior(BandSpan& span, const InsProblem& problem, const InsLayout& layout, const MatrixXd& band,
                    Index interval) {
  each_band_prior(problem, layout, band, interval,
                  [&](Index channel, const Eigen::Matrix<double, spline_order, 1>& w, double value, double sd) {
                    for (Index i = 0; i < spline_order; ++i) {
                      const Index at = i * layout.channels + channel;
                      span.right[at] -= w[i] * value / (sd * sd);
                      for (Index j = 0; j <= i; ++j)
                        span.matrix(at, j * layout.channels + channel) += w[i] * w[j] / (sd * sd);
                    }
                  });
}

// ---- Sums over intervals
// ----------------------------------------------------------------------------------------------

/// `index`: of each column, in the span's local unknowns and behind them the border's.
void accumulate(const std::vector<Index>& index, const MatrixXd& jacobian, const VectorXd& residual, BandSpan& span,
                BorderSum& border) {
  if (residual.size() == 0) return;  // nothing was said
  const Index n = jacobian.cols(), local = span.right.size();
  MatrixXd squares = MatrixXd::Zero(n, n);
  add_square(jacobian.transpose(), 1.0, squares);
  const VectorXd right = jacobian.transpose() * residual;
  for (Index c = 0; c < n; ++c) {
    const Index to = index[static_cast<std::size_t>(c)];
    (to < local ? span.right[to] : border.right[to - local]) += right[c];
    for (Index r = c; r < n; ++r) {
      const Index other = index[static_cast<std::size_t>(r)];
      const Index low = std::max(to, other), high = std::min(to, other);
      if (low < local)
        span.matrix(low, high) += squares(r, c);
      else if (high < local)
        span.coupling(low - local, high) += squares(r, c);
      else
        border.matrix(low - local, high - local) += squares(r, c);
    }
  }
}

/// The band's part alone, the border taking a known step. The columns of the band come first.
void accumulate_behind(const std::vector<Index>& index, const MatrixXd& jacobian, VectorXd residual,
                       ConstVectorRef step, BandSpan& span) {
  if (residual.size() == 0) return;  // nothing was said
  const Index local = span.right.size();
  const Index n = std::ranges::partition_point(index, [&](Index i) { return i < local; }) - index.begin();
  for (Index c = n; c < jacobian.cols(); ++c) {
    const double by = step[index[static_cast<std::size_t>(c)] - local];
    if (std::abs(by) > 0.0) residual -= by * jacobian.col(c);
  }
  MatrixXd squares = MatrixXd::Zero(n, n);
  add_square(jacobian.leftCols(n).transpose(), 1.0, squares);
  const VectorXd right = jacobian.leftCols(n).transpose() * residual;
  for (Index c = 0; c < n; ++c) {
    const Index to = index[static_cast<std::size_t>(c)];
    span.right[to] += right[c];
    for (Index r = c; r < n; ++r) {
      const Index other = index[static_cast<std::size_t>(r)];
      span.matrix(std::max(to, other), std::min(to, other)) += squares(r, c);
    }
  }
}

Index items_of(const InsProblem& problem) {
  return (problem.grid.intervals + item_intervals - 1) / item_intervals;
}

std::pair<Index, Index> intervals_of(const InsProblem& problem, Index item) {
  return {item * item_intervals, std::min(problem.grid.intervals, (item + 1) * item_intervals)};
}

/// A block's residual against a constant offset of the readings, in sigmas, an axis each.
std::array<float, 3> offset_of(const InsBlock& block, const BlockResidual& r) {
  std::array<float, 3> offset{};
  const Eigen::Matrix<double, block_nodes, 1> by_offset = block.factor.cast<double>().rowwise().sum();
  const double size = by_offset.norm();
  for (std::size_t axis = 0; axis < 3; ++axis)
    offset[axis] = size > 0.0 ? static_cast<float>(by_offset.dot(r.col(static_cast<Index>(axis))) / size) : no_reading;
  return offset;
}

void take_up(InstrumentFit& fit, const InsBlock& block, const BlockResidual& r, const RobustBlock& value) {
  const double terms = 3.0 * block.rows;
  fit.squares += value.weight * r.squaredNorm();
  fit.terms += value.weight * terms;
  fit.block.push_back(terms > 0.0 ? static_cast<float>(r.squaredNorm() / terms) : no_reading);
  fit.offset.push_back(offset_of(block, r));
}

InsCost item_cost(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, Index item,
                  const std::array<SplineBasis, block_nodes>& bases) {
  InsCost cost{.total = 0.0, .sensors = std::vector<SensorFit>(problem.sensors.size())};
  const auto [first, end] = intervals_of(problem, item);
  for (Index interval = first; interval < end; ++interval) {
    std::array<std::vector<InsState>, block_nodes> states;
    for (std::size_t n = 0; n < block_nodes; ++n) states[n] = body_states(problem, layout, x, interval, bases[n]);
    for (std::size_t b = 0; b < x.bodies.size(); ++b) {
      if (x.bodies[b].sensor < 0) continue;
      const auto sensor = static_cast<std::size_t>(x.bodies[b].sensor);
      const InsErrors errors = errors_at(problem, x, sensor, interval);
      for (std::size_t n = 0; n < block_nodes; ++n)
        states[n][b] = felt_at(problem, layout, x, sensor, interval, n, states[n][b]);
      for (const InstrumentUse& use : instruments(problem, layout, sensor)) {
        const InsBlock& block = use.blocks[static_cast<std::size_t>(interval)];
        BlockResidual predicted;
        for (std::size_t n = 0; n < block_nodes; ++n)
          predicted.row(static_cast<Index>(n)) = use.read(states[n][b], errors).transpose();
        const double shift = clock_shift(problem, layout, errors, interval);
        const BlockResidual r = residual(block, shifted_factor(block, layout, shift), predicted, use.sd);
        const RobustBlock value = robust(r.squaredNorm(), 3.0 * block.rows);
        cost.total += value.cost;
        SensorFit& fit = cost.sensors[sensor];
        take_up(use.state_row == 0 ? fit.rate : use.state_row == 6 ? fit.force : fit.field, block, r, value);
      }
    }
    each_band_prior(problem, layout, x.band, interval,
                    [&](Index, const auto&, double value, double sd) { cost.total += value * value / (sd * sd); });
  }
  return cost;
}

/// `all`: intervals of the recording; an hour's must not be held twice.
void append(InstrumentFit& to, const InstrumentFit& more, std::size_t all) {
  if (more.block.empty()) return;
  to.block.reserve(all);
  to.offset.reserve(all);
  to.squares += more.squares;
  to.terms += more.terms;
  to.block.insert(to.block.end(), more.block.begin(), more.block.end());
  to.offset.insert(to.offset.end(), more.offset.begin(), more.offset.end());
}

}  // namespace

InsCost cost_of(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, int threads) {
  const auto bases = node_bases(problem.grid);
  std::vector<InsCost> items(static_cast<std::size_t>(items_of(problem)));
  parallel_for(items.size(), threads,
               [&](std::size_t i) { items[i] = item_cost(problem, layout, x, static_cast<Index>(i), bases); });
  InsCost sum{
      .total = border_prior(problem, layout, x).cost + fact_cost(problem, layout, x) + wander_cost(problem, layout, x),
      .sensors = std::vector<SensorFit>(problem.sensors.size())};
  const auto all = static_cast<std::size_t>(problem.grid.intervals);
  for (InsCost& item : items) {
    sum.total += item.total;
    for (std::size_t s = 0; s < sum.sensors.size(); ++s) {
      append(sum.sensors[s].rate, item.sensors[s].rate, all);
      append(sum.sensors[s].force, item.sensors[s].force, all);
      append(sum.sensors[s].field, item.sensors[s].field, all);
    }
    item = {};
  }
  return sum;
}

struct IntervalLinearisation::Parts {
  const InsProblem& problem;
  const InsLayout& layout;
  const InsUnknowns& x;
  InsPaths paths;
  std::array<SplineBasis, block_nodes> bases;
  std::vector<InsFactRows> facts;
  std::vector<Index> every_column;
  std::vector<SensorColumns> columns;

  /// Calls visit(columns, system) for each sensor.
  template <class Visit>
  void each_sensor(Index interval, const Visit& visit) const {
    std::array<NodeMotion, block_nodes> motion;
    for (std::size_t n = 0; n < block_nodes; ++n) motion[n] = node_motion(problem, layout, x, interval, bases[n]);
    for (std::size_t b = 0; b < x.bodies.size(); ++b)
      if (x.bodies[b].sensor >= 0)
        visit(columns[b].index,
              sensor_system(problem, layout, x, columns[b], paths.columns[b], b, interval, motion, bases));
  }

  /// Calls visit(index, jacobian, residual) for each sensor's readings and each fact of the interval.
  template <class Visit>
  void each_rows(Index interval, const Visit& visit) const {
    each_sensor(interval, [&](const std::vector<Index>& index, const SensorSystem& system) {
      visit(index, system.jacobian, system.residual);
    });
    for (const InsFactRows& rows : facts)
      if (rows.interval == interval) visit(every_column, rows.derivative, rows.left);
  }
};

IntervalLinearisation::IntervalLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x)
    : parts_(std::make_unique<Parts>(Parts{problem,
                                           layout,
                                           x,
                                           paths_of(problem, layout, x.bodies),
                                           node_bases(problem.grid),
                                           fact_rows(problem, layout, x),
                                           {},
                                           {}})) {
  parts_->every_column.resize(static_cast<std::size_t>(spline_order * layout.channels + layout.border));
  std::iota(parts_->every_column.begin(), parts_->every_column.end(), Index{0});
  for (std::size_t b = 0; b < x.bodies.size(); ++b)
    parts_->columns.push_back(x.bodies[b].sensor < 0 ? SensorColumns{}
                                                     : sensor_columns(layout, parts_->paths, b,
                                                                      static_cast<std::size_t>(x.bodies[b].sensor)));
}

IntervalLinearisation::~IntervalLinearisation() = default;

BandSpan IntervalLinearisation::span(Index interval, BorderSum& border) const {
  const Index local = spline_order * parts_->layout.channels, held = parts_->layout.border;
  BandSpan span{MatrixXd::Zero(local, local), MatrixXd::Zero(held, local), VectorXd::Zero(local)};
  parts_->each_rows(interval, [&](const std::vector<Index>& index, const MatrixXd& jacobian, const VectorXd& residual) {
    accumulate(index, jacobian, residual, span, border);
  });
  add_band_prior(span, parts_->problem, parts_->layout, parts_->x.band, interval);
  return span;
}

BandSpan IntervalLinearisation::span_behind(Index interval, ConstVectorRef border) const {
  const Index local = spline_order * parts_->layout.channels;
  BandSpan span{MatrixXd::Zero(local, local), MatrixXd(0, local), VectorXd::Zero(local)};
  parts_->each_rows(interval, [&](const std::vector<Index>& index, const MatrixXd& jacobian, const VectorXd& residual) {
    accumulate_behind(index, jacobian, residual, border, span);
  });
  add_band_prior(span, parts_->problem, parts_->layout, parts_->x.band, interval);
  return span;
}

IntervalGradient IntervalLinearisation::gradient(Index interval) const {
  const Index local = spline_order * parts_->layout.channels;
  IntervalGradient gradient{VectorXd::Zero(local), VectorXd::Zero(parts_->layout.border)};
  parts_->each_sensor(interval, [&](const std::vector<Index>& index, const SensorSystem& system) {
    const VectorXd right = system.jacobian.transpose() * system.residual;
    for (Index c = 0; c < right.size(); ++c) {
      const Index to = index[static_cast<std::size_t>(c)];
      (to < local ? gradient.band[to] : gradient.border[to - local]) += right[c];
    }
  });
  return gradient;
}

}  // namespace kinfer
