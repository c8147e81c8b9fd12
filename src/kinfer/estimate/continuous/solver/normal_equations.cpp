// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr std::size_t at_once = 16;  // segments condensed before they are added: bounds the memory

/// Size of the factors of all time segments.
double bytes_of(const InsProblem& problem, const InsLayout& layout) {
  const Index rows = 2 * (spline_order - 1) * layout.spline_dimensions + layout.global_parameters;
  return 8.0 * static_cast<double>(problem.grid.intervals * layout.spline_dimensions * rows);
}

}  // namespace

InsSystem::InsSystem(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const Damping& damping,
                     int threads, double most_kept)
    : problem_(problem),
      layout_(layout),
      x_(x),
      damping_(damping),
      threads_(threads),
      border_(damping.holds_global_parameters ? 0 : layout.global_parameters),
      bias_process_(damping.holds_global_parameters ? 0 : layout.bias_process),
      linearisation_(problem, layout, x),
      segments_(time_segments_of(problem.grid)),
      bias_parameters_(bias_parameters(layout)),
      ends_(end_width() + bias_process_, 2, border_) {
  const bool keep = bytes_of(problem, layout) < most_kept;
  GlobalParameterPrior border{0.0, MatrixXd(border_, border_), VectorXd(border_)};
  if (border_ > 0) border = global_parameter_prior(problem, layout, x);
  border.matrix.diagonal() *= 1.0 + damping.border;
  for (std::size_t first = 0; first < segments_.size(); first += at_once) {
    const std::size_t count = std::min(at_once, segments_.size() - first);
    std::vector<Condensed> done(count);
    parallel_for(count, threads_, [&](std::size_t i) { done[i] = condensed(first + i, keep); });
    for (Condensed& time_segment : done) {
      ends_.add(time_segment.span, time_segment.is_positive_definite);
      border.matrix += time_segment.border_matrix;
      border.right += time_segment.border_right;
      if (keep) kept_.push_back(std::move(*time_segment.kept));
    }
  }
  ends_.finish(border.matrix, border.right);
}

InsSystem::Condensed InsSystem::condensed(std::size_t time_segment, bool keep) const {
  const TimeSegment& intervals = segments_[time_segment];
  BandSegment band = damping_.holds_global_parameters
                         ? BandSegment(linearisation_.sum_back_substituted(intervals), damping_.band)
                         : eliminated(intervals);
  Condensed result{band.condensed(), band.border_matrix(), band.border_right(), band.is_positive_definite(), {}};
  if (bias_process_ > 0) result.span = with_bias_process(result.span, band, time_segment);
  if (keep) result.kept = std::move(band);
  return result;
}

/// Bias deviations act on a time segment like the constant biases, so they have the same columns.
BandSpan InsSystem::with_bias_process(const BandSpan& ends, const BandSegment& band, std::size_t time_segment) const {
  const Index e = end_width(), w = layout_.bias_process, group = e + w, held = layout_.global_parameters;
  const MatrixXd whole = band.border_matrix().selfadjointView<Eigen::Lower>();
  const MatrixXd of_wander = ends.coupling(bias_parameters_, Eigen::all);
  BandSpan span{MatrixXd::Zero(2 * group, 2 * group), MatrixXd::Zero(held, 2 * group), VectorXd::Zero(2 * group)};
  span.matrix.topLeftCorner(e, e) = ends.matrix.topLeftCorner(e, e);
  span.matrix.block(e, 0, w, e) = of_wander.leftCols(e);
  span.matrix.block(e, e, w, w) = whole(bias_parameters_, bias_parameters_);
  span.matrix.block(group, 0, e, e) = ends.matrix.bottomLeftCorner(e, e);
  span.matrix.block(group, e, e, w) = of_wander.rightCols(e).transpose();
  span.matrix.block(group, group, e, e) = ends.matrix.bottomRightCorner(e, e);
  span.coupling.leftCols(e) = ends.coupling.leftCols(e);
  span.coupling.middleCols(e, w) = whole(Eigen::all, bias_parameters_);
  span.coupling.middleCols(group, e) = ends.coupling.rightCols(e);
  span.right.head(e) = ends.right.head(e);
  span.right.segment(e, w) = band.border_right()(bias_parameters_);
  span.right.segment(group, e) = ends.right.tail(e);
  add_bias_process_prior(span, time_segment);
  return span;
}

/// Gauss-Markov prior between the biases of neighbouring segments. The group behind the last segment has no data: its
/// bias deviations only get a prior.
void InsSystem::add_bias_process_prior(BandSpan& span, std::size_t time_segment) const {
  const Index w = layout_.bias_process, now = end_width(), next = 2 * end_width() + w,
              k = static_cast<Index>(time_segment);
  const BiasProcessPrior prior = bias_process_prior(problem_, layout_);
  const auto add = [&](Index at, const VectorXd& information, const VectorXd& value) {
    span.matrix.diagonal().segment(at, w) += (1.0 + damping_.border) * information;
    span.right.segment(at, w) -= information.cwiseProduct(value);
  };
  if (k == 0) add(now, prior.information, x_.bias_process.col(0));
  if (k + 1 == x_.bias_process.cols()) return add(next, prior.information, VectorXd::Zero(w));
  const double a = prior.decay;
  const VectorXd process_noise = x_.bias_process.col(k + 1) - a * x_.bias_process.col(k);
  add(now, a * a * prior.innovation, process_noise / -a);
  add(next, prior.innovation, process_noise);
  span.matrix.block(next, now, w, w).diagonal() -= a * prior.innovation;
}

BandSegment InsSystem::eliminated(const TimeSegment& time_segment) const {
  BandSegmentSum sum = linearisation_.sum(time_segment);
  sum.border_matrix.diagonal() *= 1.0 + damping_.border;
  return BandSegment(std::move(sum), damping_.band);
}

/// Step of the global parameters as a time segment sees it: bias deviations added to the constants. Empty if held.
std::optional<VectorXd> InsSystem::global_step_of(std::size_t time_segment, const BorderedBand::Solution& ends) const {
  if (damping_.holds_global_parameters) return std::nullopt;
  VectorXd border = ends.border;
  if (bias_process_ > 0)
    border(bias_parameters_) += ends.band.col(static_cast<Index>(time_segment)).tail(bias_process_);
  return border;
}

/// Steps of a time segment's inner coefficients.
MatrixXd InsSystem::between(std::size_t time_segment, const BorderedBand::Solution& ends) const {
  const auto k = static_cast<Index>(time_segment);
  const auto first = ends.band.col(k).head(end_width()), last = ends.band.col(k + 1).head(end_width());
  const auto border = global_step_of(time_segment, ends);
  if (!kept_.empty()) return kept_[time_segment].solve(first, last, border ? *border : VectorXd());
  const BandSegment band(linearisation_.sum_back_substituted(segments_[time_segment], border), damping_.band);
  return band.solve(first, last, VectorXd());
}

std::optional<InsStep> InsSystem::solve() const {
  const auto ends = ends_.solve();
  if (!ends) return std::nullopt;
  const auto count = static_cast<Index>(segments_.size());
  InsStep step{MatrixXd(layout_.spline_dimensions, problem_.grid.coefficients()),
               VectorXd::Zero(layout_.global_parameters), MatrixXd::Zero(layout_.bias_process, count)};
  step.border.head(border_) = ends->border;
  step.bias_process.topRows(bias_process_) = ends->band.block(end_width(), 0, bias_process_, count);
  constexpr Index shared = spline_order - 1;
  const auto put_end = [&](Index at, Index end) {
    step.spline_coefficients.middleCols(at, shared) =
        ends->band.col(end).head(end_width()).reshaped(layout_.spline_dimensions, shared);
  };
  parallel_for(segments_.size(), threads_, [&](std::size_t i) {
    const TimeSegment& s = segments_[i];
    put_end(s.first, static_cast<Index>(i));
    step.spline_coefficients.middleCols(s.first + shared, s.end - s.first - shared) = between(i, *ends);
  });
  put_end(problem_.grid.intervals, count);
  return step;
}

/// How a time segment's coefficients follow the global parameters.
InsSystem::Following InsSystem::following(std::size_t time_segment, ConstMatrixRef ends_following) const {
  const auto [first, end] = segments_[time_segment];
  const BandSegment band = kept_.empty() ? eliminated(segments_[time_segment]) : kept_[time_segment];
  const Index e = end_width(), group = e + layout_.bias_process, inner = (end - first) * layout_.spline_dimensions - e,
              at = static_cast<Index>(time_segment) * group;
  Following result{MatrixXd::Identity(layout_.global_parameters, layout_.global_parameters),
                   MatrixXd(inner + 2 * e, layout_.global_parameters)};
  if (layout_.bias_process > 0)
    result.border(bias_parameters_, Eigen::all) -= ends_following.middleRows(at + e, layout_.bias_process);
  MatrixXd& coefficients = result.coefficients;
  coefficients.topRows(e) = ends_following.middleRows(at, e);
  coefficients.bottomRows(e) = ends_following.middleRows(at + group, e);
  coefficients.middleRows(e, inner) =
      band.sensitivity(coefficients.topRows(e), coefficients.bottomRows(e), result.border);
  return result;
}

/// Gradient of each interval of a time segment with respect to the global parameters.
MatrixXd InsSystem::segment_scores(std::size_t time_segment, ConstMatrixRef ends_following) const {
  const auto [first, end] = segments_[time_segment];
  const Following sensitivity = following(time_segment, ends_following);
  MatrixXd scores(end - first, layout_.global_parameters);
  const auto gradients = linearisation_.gradients(segments_[time_segment]);
  for (Index i = 0; i < scores.rows(); ++i) {
    const IntervalGradient& gradient = gradients[static_cast<std::size_t>(i)];
    const auto window =
        sensitivity.coefficients.middleRows(i * layout_.spline_dimensions, spline_order * layout_.spline_dimensions);
    scores.row(i) = (sensitivity.border.transpose() * gradient.border - window.transpose() * gradient.band).transpose();
  }
  return scores;
}

SplineMarginal InsSystem::spline_marginal(double time) const {
  const auto [interval, u] = problem_.grid.locate(time);
  const auto k = static_cast<std::size_t>(time_segment_at(problem_.grid, interval));
  const MatrixXd coefficients = following(k, ends_.sensitivity()).coefficients;
  const MatrixXd end = ends_.conditional_covariance(static_cast<Index>(k));
  const auto basis = spline_basis(u, problem_.grid.period).at.front(),
             basis_at_begin = spline_basis(0.0, problem_.grid.period).at.front();
  const Index dimensions = layout_.spline_dimensions, window = (interval - segments_[k].first) * dimensions;
  SplineMarginal result{MatrixXd::Zero(dimensions, layout_.global_parameters), MatrixXd::Zero(dimensions, dimensions)};
  for (Index i = 0; i < spline_order; ++i)
    result.by_global_parameters -=
        basis[static_cast<std::size_t>(i)] * coefficients.middleRows(window + i * dimensions, dimensions);
  for (Index i = 0; i < spline_order - 1; ++i)
    for (Index j = 0; j < spline_order - 1; ++j)
      result.conditional += basis_at_begin[static_cast<std::size_t>(i)] * basis_at_begin[static_cast<std::size_t>(j)] *
                            end.block(i * dimensions, j * dimensions, dimensions, dimensions);
  return result;
}

InsSystem::Scores InsSystem::scores(double seconds) const {
  const auto intervals = std::max<Index>(1, static_cast<Index>(std::round(seconds / problem_.grid.period)));
  const MatrixXd ends_following = ends_.sensitivity();
  Scores result{MatrixXd::Zero((problem_.grid.intervals + intervals - 1) / intervals, layout_.global_parameters),
                prior_information(ends_following)};
  for (std::size_t first = 0; first < segments_.size(); first += at_once) {
    std::vector<MatrixXd> scores(std::min(at_once, segments_.size() - first));
    parallel_for(scores.size(), threads_,
                 [&](std::size_t i) { scores[i] = segment_scores(first + i, ends_following); });
    for (std::size_t i = 0; i < scores.size(); ++i)
      for (Index k = 0; k < scores[i].rows(); ++k)
        result.blocks.row((segments_[first + i].first + k) / intervals) += scores[i].row(k);
  }
  return result;
}

MatrixXd InsSystem::prior_information(ConstMatrixRef ends_following) const {
  MatrixXd information = global_parameter_prior(problem_, layout_, x_).matrix;
  for (const VectorXd& fact : linearisation_.constant_facts()) information += fact * fact.transpose();
  if (layout_.bias_process == 0) return information;
  const BiasProcessPrior prior = bias_process_prior(problem_, layout_);
  MatrixXd before = MatrixXd::Zero(layout_.bias_process, layout_.global_parameters);
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    const Index at = static_cast<Index>(k) * (end_width() + layout_.bias_process) + end_width();
    const MatrixXd now = ends_following.middleRows(at, layout_.bias_process),
                   process_noise = now - prior.decay * before;
    const VectorXd& weight = k == 0 ? prior.information : prior.innovation;
    information += transposed_times(process_noise, weight.asDiagonal() * process_noise);
    before = now;
  }
  return information;
}

}  // namespace kinfer
