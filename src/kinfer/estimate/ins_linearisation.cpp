#include "kinfer/estimate/ins_linearisation.hpp"

#include <algorithm>

#include "kinfer/estimate/ins_band_prior.hpp"
#include "kinfer/estimate/ins_sensor_system.hpp"
#include "kinfer/linalg/block_products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// The readings of a stretch, interval after interval: a machine's motion and the sensors on it.
struct Walk {
  IntervalMotion motion;
  std::vector<SensorSystem> sensors;

  Walk(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, InsScope scope)
      : motion(problem, layout, x, scope) {
    for (std::size_t b = 0; b < x.bodies.size(); ++b)
      if (x.bodies[b].sensor >= 0) sensors.emplace_back(problem, layout, x, motion, b, scope);
  }
  Walk(const Walk&) = delete;

  /// Calls visit(index, rows) for each part of each sensor, counted through.
  template <class Visit>
  void go_to(Index interval, const Visit& visit) {
    motion.go_to(interval);
    std::size_t index = 0;
    for (SensorSystem& sensor : sensors) {
      sensor.go_to(interval);
      for (const SensorRows& rows : sensor.parts()) visit(index++, rows);
    }
  }
};

/// Squares of one part of a sensor. What belongs to the border alone is summed up here over a whole stretch.
struct PartSum {
  MatrixXd squares;  // lower half
  VectorXd right;

  /// `jacobian`, transposed, may be without the border's columns.
  void add(const SensorRows& rows, ConstMatrixRef jacobian, ConstVectorRef residual, Index span, StretchSum& sum) {
    const Index columns = jacobian.rows(), band = number_of(rows.band);
    if (squares.size() == 0) squares = MatrixXd::Zero(columns, columns), right = VectorXd::Zero(columns);
    if (residual.size() == 0) return;  // nothing was said
    squares.leftCols(band).setZero();
    right.head(band).setZero();
    add_square(jacobian, 1.0, squares);
    add_product(jacobian, residual.transpose(), 1.0, right);
    move_band(rows, span, sum);
  }

  void move_band(const SensorRows& rows, Index span, StretchSum& sum) const {
    const Index band = number_of(rows.band), at = span * sum.width;
    for (Index c = 0; c < band; ++c) {
      const Index to = rows.band[static_cast<std::size_t>(c)];
      const double* from = squares.col(c).data();
      double *column = sum.band.col(at + to).data() - to / sum.width * sum.width,
             *beside = sum.beside.col(at + to).data() + sum.end();
      for (Index r = c; r < band; ++r) column[rows.band[static_cast<std::size_t>(r)]] += from[r];
      for (Index r = band; r < squares.rows(); ++r) beside[rows.border[static_cast<std::size_t>(r - band)]] += from[r];
      sum.right[at + to] += right[c];
    }
  }

  void move_border(const SensorRows& rows, StretchSum& sum) const {
    const Index band = number_of(rows.band);
    for (Index c = band; c < squares.cols(); ++c) {
      const Index to = rows.border[static_cast<std::size_t>(c - band)];
      sum.border_right[to] += right[c];
      for (Index r = c; r < squares.rows(); ++r) {
        const Index other = rows.border[static_cast<std::size_t>(r - band)];
        sum.border_matrix(std::max(to, other), std::min(to, other)) += squares(r, c);
      }
    }
  }
};

/// A part's residual once the border took its step.
VectorXd residual_behind(const SensorRows& rows, const std::optional<VectorXd>& step) {
  VectorXd residual = rows.residual.head(rows.used);
  if (step)
    residual -= rows.jacobian.bottomLeftCorner(number_of(rows.border), rows.used).transpose() * (*step)(rows.border);
  return residual;
}

}  // namespace

InsLinearisation::InsLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x)
    : problem_(problem), layout_(layout), x_(x), facts_(fact_rows(problem, layout, x)) {}

StretchSum InsLinearisation::sum(const InsStretch& stretch) const {
  StretchSum sum(layout_.channels, spline_order, layout_.border, stretch.end - stretch.first);
  Walk walk(problem_, layout_, x_, InsScope::everything);
  std::vector<PartSum> parts(2 * walk.sensors.size());
  for (Index k = stretch.first; k < stretch.end; ++k)
    walk.go_to(k, [&](std::size_t i, const SensorRows& rows) {
      parts[i].add(rows, rows.jacobian.leftCols(rows.used), rows.residual.head(rows.used), k - stretch.first, sum);
    });
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].move_border(walk.sensors[i / 2].parts()[i % 2], sum);
  add_band_prior(sum, stretch);
  add_facts(sum, stretch);
  return sum;
}

StretchSum InsLinearisation::sum_behind(const InsStretch& stretch, const std::optional<VectorXd>& border) const {
  StretchSum sum(layout_.channels, spline_order, 0, stretch.end - stretch.first);
  Walk walk(problem_, layout_, x_, border ? InsScope::everything : InsScope::band);
  std::vector<PartSum> parts(2 * walk.sensors.size());
  for (Index k = stretch.first; k < stretch.end; ++k)
    walk.go_to(k, [&](std::size_t i, const SensorRows& rows) {
      parts[i].add(rows, rows.jacobian.topLeftCorner(number_of(rows.band), rows.used), residual_behind(rows, border),
                   k - stretch.first, sum);
    });
  add_band_prior(sum, stretch);
  add_facts_behind(sum, stretch, border);
  return sum;
}

void InsLinearisation::add_band_prior(StretchSum& sum, const InsStretch& stretch) const {
  for (Index k = stretch.first; k < stretch.end; ++k)
    each_band_prior(problem_, layout_, x_.band, k, [&](const BandPriorTerm& term) {
      const double information = 1.0 / (term.sd * term.sd);
      for (Index j = 0; j < spline_order; ++j) {
        const Index column = (k - stretch.first + j) * sum.width + term.channel;
        sum.right[column] -= information * term.weights[j] * term.value;
        for (Index i = j; i < spline_order; ++i)
          sum.band((i - j) * sum.width + term.channel, column) += information * term.weights[i] * term.weights[j];
      }
    });
}

void InsLinearisation::add_facts(StretchSum& sum, const InsStretch& stretch) const {
  const Index local = spline_order * layout_.channels;
  for (const InsFactRows& fact : facts_) {
    if (fact.interval < stretch.first || fact.interval >= stretch.end) continue;
    const MatrixXd squares = fact.derivative.transpose() * fact.derivative;
    const VectorXd right = fact.derivative.transpose() * fact.left;
    sum.add(fact.interval - stretch.first,
            {squares.topLeftCorner(local, local), squares.bottomLeftCorner(layout_.border, local), right.head(local)});
    sum.border_matrix += squares.bottomRightCorner(layout_.border, layout_.border);
    sum.border_right += right.tail(layout_.border);
  }
}

void InsLinearisation::add_facts_behind(StretchSum& sum, const InsStretch& stretch,
                                        const std::optional<VectorXd>& border) const {
  const Index local = spline_order * layout_.channels;
  for (const InsFactRows& fact : facts_) {
    if (fact.interval < stretch.first || fact.interval >= stretch.end) continue;
    const auto derivative = fact.derivative.leftCols(local);
    VectorXd left = fact.left;
    if (border) left -= fact.derivative.rightCols(layout_.border) * *border;
    sum.add(fact.interval - stretch.first,
            {derivative.transpose() * derivative, MatrixXd(0, local), derivative.transpose() * left});
  }
}

std::vector<IntervalGradient> InsLinearisation::gradients(const InsStretch& stretch) const {
  Walk walk(problem_, layout_, x_, InsScope::everything);
  std::vector<IntervalGradient> gradients;
  for (Index k = stretch.first; k < stretch.end; ++k) {
    IntervalGradient gradient{VectorXd::Zero(spline_order * layout_.channels), VectorXd::Zero(layout_.border)};
    walk.go_to(k, [&](std::size_t, const SensorRows& rows) {
      const VectorXd right = rows.jacobian.leftCols(rows.used) * rows.residual.head(rows.used);
      gradient.band(rows.band) += right.head(number_of(rows.band));
      gradient.border(rows.border) += right.tail(number_of(rows.border));
    });
    gradients.push_back(std::move(gradient));
  }
  return gradients;
}

}  // namespace kinfer
