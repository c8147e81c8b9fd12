// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/linearisation.hpp"

#include <algorithm>

#include "kinfer/estimate/continuous/solver/sensor_linearisation.hpp"
#include "kinfer/estimate/continuous/solver/spline_prior.hpp"
#include "kinfer/linalg/block_products.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// Iterates over the intervals of a time segment: the machine's motion and the sensors on it.
struct SegmentWalker {
  IntervalMotion motion;
  std::vector<SensorLinearisation> sensors;

  SegmentWalker(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, LinearisationScope scope)
      : motion(problem, layout, x, scope) {
    for (std::size_t b = 0; b < x.bodies.size(); ++b)
      if (x.bodies[b].sensor >= 0) sensors.emplace_back(problem, layout, x, motion, b, scope);
  }
  SegmentWalker(const SegmentWalker&) = delete;

  /// Calls visit(index, rows) for each part of each sensor, with a running index.
  template <class Visit>
  void move_to(Index interval, const Visit& visit) {
    motion.move_to(interval);
    std::size_t index = 0;
    for (SensorLinearisation& sensor : sensors) {
      sensor.move_to(interval);
      for (const SensorRows& rows : sensor.parts()) visit(index++, rows);
    }
  }
};

/// Normal equations of one part of a sensor. The block of the global parameters is accumulated here over a whole time
/// segment.
struct PartSum {
  MatrixXd squares;  // lower half
  VectorXd right;

  /// `jacobian`, transposed, may lack the columns of the global parameters.
  void add(const SensorRows& rows, ConstMatrixRef jacobian, ConstVectorRef residual, Index span, BandSegmentSum& sum) {
    const Index columns = jacobian.rows(), band = number_of(rows.band);
    if (squares.size() == 0) squares = MatrixXd::Zero(columns, columns), right = VectorXd::Zero(columns);
    if (residual.size() == 0) return;  // no measurements
    squares.leftCols(band).setZero();
    right.head(band).setZero();
    add_square(jacobian, 1.0, squares);
    add_product(jacobian, residual.transpose(), 1.0, right);
    move_spline_block(rows, span, sum);
  }

  void move_spline_block(const SensorRows& rows, Index span, BandSegmentSum& sum) const {
    const Index band = number_of(rows.band), at = span * sum.width;
    for (Index c = 0; c < band; ++c) {
      const Index to = rows.band[static_cast<std::size_t>(c)];
      const double* from = squares.col(c).data();
      double *column = sum.band.col(at + to).data() - to / sum.width * sum.width,
             *outer = sum.outer.col(at + to).data() + sum.end();
      for (Index r = c; r < band; ++r) column[rows.band[static_cast<std::size_t>(r)]] += from[r];
      for (Index r = band; r < squares.rows(); ++r) outer[rows.border[static_cast<std::size_t>(r - band)]] += from[r];
      sum.right[at + to] += right[c];
    }
  }

  void move_global_block(const SensorRows& rows, BandSegmentSum& sum) const {
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

/// Residual of a part after the step of the global parameters.
VectorXd residual_after_global_step(const SensorRows& rows, const std::optional<VectorXd>& step) {
  VectorXd residual = rows.residual.head(rows.used);
  if (step)
    residual -= rows.jacobian.bottomLeftCorner(number_of(rows.border), rows.used).transpose() * (*step)(rows.border);
  return residual;
}

}  // namespace

InsLinearisation::InsLinearisation(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x)
    : problem_(problem), layout_(layout), x_(x), facts_(fact_rows(problem, layout, x)) {}

BandSegmentSum InsLinearisation::sum(const TimeSegment& time_segment) const {
  BandSegmentSum sum(layout_.spline_dimensions, spline_order, layout_.global_parameters,
                     time_segment.end - time_segment.first);
  SegmentWalker walk(problem_, layout_, x_, LinearisationScope::everything);
  std::vector<PartSum> parts(2 * walk.sensors.size());
  for (Index k = time_segment.first; k < time_segment.end; ++k)
    walk.move_to(k, [&](std::size_t i, const SensorRows& rows) {
      parts[i].add(rows, rows.jacobian.leftCols(rows.used), rows.residual.head(rows.used), k - time_segment.first, sum);
    });
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].move_global_block(walk.sensors[i / 2].parts()[i % 2], sum);
  add_spline_prior(sum, time_segment);
  add_facts(sum, time_segment);
  return sum;
}

BandSegmentSum InsLinearisation::sum_back_substituted(const TimeSegment& time_segment,
                                                      const std::optional<VectorXd>& border) const {
  BandSegmentSum sum(layout_.spline_dimensions, spline_order, 0, time_segment.end - time_segment.first);
  SegmentWalker walk(problem_, layout_, x_, border ? LinearisationScope::everything : LinearisationScope::spline_only);
  std::vector<PartSum> parts(2 * walk.sensors.size());
  for (Index k = time_segment.first; k < time_segment.end; ++k)
    walk.move_to(k, [&](std::size_t i, const SensorRows& rows) {
      parts[i].add(rows, rows.jacobian.topLeftCorner(number_of(rows.band), rows.used),
                   residual_after_global_step(rows, border), k - time_segment.first, sum);
    });
  add_spline_prior(sum, time_segment);
  add_facts_back_substituted(sum, time_segment, border);
  return sum;
}

void InsLinearisation::add_spline_prior(BandSegmentSum& sum, const TimeSegment& time_segment) const {
  for (Index k = time_segment.first; k < time_segment.end; ++k)
    each_spline_prior(problem_, layout_, x_.spline_coefficients, k, [&](const SplinePriorTerm& term) {
      const double information = 1.0 / (term.sd * term.sd);
      for (Index j = 0; j < spline_order; ++j) {
        const Index column = (k - time_segment.first + j) * sum.width + term.spline_dimension;
        sum.right[column] -= information * term.weights[j] * term.value;
        for (Index i = j; i < spline_order; ++i)
          sum.band((i - j) * sum.width + term.spline_dimension, column) +=
              information * term.weights[i] * term.weights[j];
      }
    });
}

void InsLinearisation::add_facts(BandSegmentSum& sum, const TimeSegment& time_segment) const {
  const Index local = spline_order * layout_.spline_dimensions;
  for (const InsFactRows& fact : facts_) {
    if (fact.interval < time_segment.first || fact.interval >= time_segment.end) continue;
    const MatrixXd squares = gram(fact.derivative);
    const VectorXd right = fact.derivative.transpose() * fact.left;
    sum.add(fact.interval - time_segment.first,
            {squares.topLeftCorner(local, local), squares.bottomLeftCorner(layout_.global_parameters, local),
             right.head(local)});
    sum.border_matrix += squares.bottomRightCorner(layout_.global_parameters, layout_.global_parameters);
    sum.border_right += right.tail(layout_.global_parameters);
  }
}

void InsLinearisation::add_facts_back_substituted(BandSegmentSum& sum, const TimeSegment& time_segment,
                                                  const std::optional<VectorXd>& border) const {
  const Index local = spline_order * layout_.spline_dimensions;
  for (const InsFactRows& fact : facts_) {
    if (fact.interval < time_segment.first || fact.interval >= time_segment.end) continue;
    const auto derivative = fact.derivative.leftCols(local);
    VectorXd left = fact.left;
    if (border) left -= fact.derivative.rightCols(layout_.global_parameters) * *border;
    sum.add(fact.interval - time_segment.first, {gram(derivative), MatrixXd(0, local), derivative.transpose() * left});
  }
}

std::vector<VectorXd> InsLinearisation::constant_facts() const {
  const Index local = spline_order * layout_.spline_dimensions;
  std::vector<VectorXd> rows;
  for (const InsFactRows& fact : facts_)
    for (Index i = 0; i < fact.derivative.rows(); ++i)
      if (!(fact.derivative.row(i).head(local).squaredNorm() > 0.0))
        rows.push_back(fact.derivative.row(i).tail(layout_.global_parameters).transpose());
  return rows;
}

std::vector<IntervalGradient> InsLinearisation::gradients(const TimeSegment& time_segment) const {
  SegmentWalker walk(problem_, layout_, x_, LinearisationScope::everything);
  std::vector<IntervalGradient> gradients;
  for (Index k = time_segment.first; k < time_segment.end; ++k) {
    IntervalGradient gradient{VectorXd::Zero(spline_order * layout_.spline_dimensions),
                              VectorXd::Zero(layout_.global_parameters)};
    walk.move_to(k, [&](std::size_t, const SensorRows& rows) {
      const VectorXd right = rows.jacobian.leftCols(rows.used) * rows.residual.head(rows.used);
      gradient.band(rows.band) += right.head(number_of(rows.band));
      gradient.border(rows.border) += right.tail(number_of(rows.border));
    });
    gradients.push_back(std::move(gradient));
  }
  return gradients;
}

std::vector<VectorXd> InsLinearisation::residuals(const TimeSegment& time_segment) const {
  SegmentWalker walk(problem_, layout_, x_, LinearisationScope::spline_only);
  std::vector<VectorXd> all;
  for (Index k = time_segment.first; k < time_segment.end; ++k)
    walk.move_to(k, [&](std::size_t, const SensorRows& rows) {
      all.emplace_back(rows.weight.head(rows.used).cwiseProduct(rows.residual.head(rows.used)));
    });
  return all;
}

VectorXd spline_product(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                        const TimeSegment& time_segment, const std::vector<VectorXd>& residuals) {
  SegmentWalker walk(problem, layout, x, LinearisationScope::spline_only);
  const Index width = layout.spline_dimensions;
  VectorXd product = VectorXd::Zero((time_segment.end - time_segment.first + spline_order - 1) * width);
  std::size_t next = 0;
  for (Index k = time_segment.first; k < time_segment.end; ++k) {
    auto window = product.segment((k - time_segment.first) * width, spline_order * width);
    walk.move_to(k, [&](std::size_t, const SensorRows& rows) {
      const auto weight = rows.weight.head(rows.used).array();
      const VectorXd unweighted = (weight > 0.0).select(residuals[next++].array() / weight, 0.0);
      window(rows.band) += rows.jacobian.topLeftCorner(number_of(rows.band), rows.used) * unweighted;
    });
  }
  return product;
}

}  // namespace kinfer
