#include "kinfer/estimate/ins_system.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/parallel.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr std::size_t at_once = 16;  // stretches condensed before they are added: bounds the memory

/// Of the factors of all stretches.
double bytes_of(const InsProblem& problem, const InsLayout& layout) {
  const Index rows = 2 * (spline_order - 1) * layout.channels + layout.border;
  return 8.0 * static_cast<double>(problem.grid.intervals * layout.channels * rows);
}

}  // namespace

InsSystem::InsSystem(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const Damping& damping,
                     int threads, double most_kept)
    : problem_(problem),
      layout_(layout),
      x_(x),
      damping_(damping),
      threads_(threads),
      border_(damping.holds_border ? 0 : layout.border),
      wander_(damping.holds_border ? 0 : layout.wander),
      linearisation_(problem, layout, x),
      stretches_(stretches_of(problem.grid)),
      wandering_(wandering_border(layout)),
      ends_(end_width() + wander_, 2, border_) {
  const bool keep = bytes_of(problem, layout) < most_kept;
  BorderPrior border{0.0, MatrixXd(border_, border_), VectorXd(border_)};
  if (border_ > 0) border = border_prior(problem, layout, x);
  border.matrix.diagonal() *= 1.0 + damping.border;
  for (std::size_t first = 0; first < stretches_.size(); first += at_once) {
    const std::size_t count = std::min(at_once, stretches_.size() - first);
    std::vector<Condensed> done(count);
    parallel_for(count, threads_, [&](std::size_t i) { done[i] = condensed(first + i, keep); });
    for (Condensed& stretch : done) {
      ends_.add(stretch.span, stretch.positive);
      border.matrix += stretch.border_matrix;
      border.right += stretch.border_right;
      if (keep) kept_.push_back(std::move(*stretch.kept));
    }
  }
  ends_.finish(border.matrix, border.right);
}

InsSystem::Condensed InsSystem::condensed(std::size_t stretch, bool keep) const {
  const InsStretch& intervals = stretches_[stretch];
  BandStretch band =
      damping_.holds_border ? BandStretch(linearisation_.sum_behind(intervals), damping_.band) : eliminated(intervals);
  Condensed result{band.condensed(), band.border_matrix(), band.border_right(), band.positive(), {}};
  if (wander_ > 0) result.span = with_wander(result.span, band, stretch);
  if (keep) result.kept = std::move(band);
  return result;
}

/// What biases wander off reaches a stretch as the constants of the border do; so its columns are the border's.
BandSpan InsSystem::with_wander(const BandSpan& ends, const BandStretch& band, std::size_t stretch) const {
  const Index e = end_width(), w = layout_.wander, group = e + w, held = layout_.border;
  const MatrixXd whole = band.border_matrix().selfadjointView<Eigen::Lower>();
  const MatrixXd of_wander = ends.coupling(wandering_, Eigen::all);
  BandSpan span{MatrixXd::Zero(2 * group, 2 * group), MatrixXd::Zero(held, 2 * group), VectorXd::Zero(2 * group)};
  span.matrix.topLeftCorner(e, e) = ends.matrix.topLeftCorner(e, e);
  span.matrix.block(e, 0, w, e) = of_wander.leftCols(e);
  span.matrix.block(e, e, w, w) = whole(wandering_, wandering_);
  span.matrix.block(group, 0, e, e) = ends.matrix.bottomLeftCorner(e, e);
  span.matrix.block(group, e, e, w) = of_wander.rightCols(e).transpose();
  span.matrix.block(group, group, e, e) = ends.matrix.bottomRightCorner(e, e);
  span.coupling.leftCols(e) = ends.coupling.leftCols(e);
  span.coupling.middleCols(e, w) = whole(Eigen::all, wandering_);
  span.coupling.middleCols(group, e) = ends.coupling.rightCols(e);
  span.right.head(e) = ends.right.head(e);
  span.right.segment(e, w) = band.border_right()(wandering_);
  span.right.segment(group, e) = ends.right.tail(e);
  add_wander_prior(span, stretch);
  return span;
}

/// How the biases of a stretch came from those before. Behind the last stretch there is nothing to be known.
void InsSystem::add_wander_prior(BandSpan& span, std::size_t stretch) const {
  const Index w = layout_.wander, now = end_width(), next = 2 * end_width() + w, k = static_cast<Index>(stretch);
  const WanderPrior prior = wander_prior(problem_, layout_);
  const auto add = [&](Index at, const VectorXd& information, const VectorXd& value) {
    span.matrix.diagonal().segment(at, w) += (1.0 + damping_.border) * information;
    span.right.segment(at, w) -= information.cwiseProduct(value);
  };
  if (k == 0) add(now, prior.information, x_.wander.col(0));
  if (k + 1 == x_.wander.cols()) return add(next, prior.information, VectorXd::Zero(w));
  const double a = prior.keep;
  const VectorXd surprise = x_.wander.col(k + 1) - a * x_.wander.col(k);
  add(now, a * a * prior.innovation, surprise / -a);
  add(next, prior.innovation, surprise);
  span.matrix.block(next, now, w, w).diagonal() -= a * prior.innovation;
}

BandStretch InsSystem::eliminated(const InsStretch& stretch) const {
  StretchSum sum = linearisation_.sum(stretch);
  sum.border_matrix.diagonal() *= 1.0 + damping_.border;
  return BandStretch(std::move(sum), damping_.band);
}

/// The border as a stretch sees it: what its biases wandered off is added to the constants. Nothing where it is held.
std::optional<VectorXd> InsSystem::border_of(std::size_t stretch, const BorderedBand::Solution& ends) const {
  if (damping_.holds_border) return std::nullopt;
  VectorXd border = ends.border;
  if (wander_ > 0) border(wandering_) += ends.band.col(static_cast<Index>(stretch)).tail(wander_);
  return border;
}

/// Steps of a stretch's coefficients between its ends.
MatrixXd InsSystem::between(std::size_t stretch, const BorderedBand::Solution& ends) const {
  const auto k = static_cast<Index>(stretch);
  const auto first = ends.band.col(k).head(end_width()), last = ends.band.col(k + 1).head(end_width());
  const auto border = border_of(stretch, ends);
  if (!kept_.empty()) return kept_[stretch].solve(first, last, border ? *border : VectorXd());
  const BandStretch band(linearisation_.sum_behind(stretches_[stretch], border), damping_.band);
  return band.solve(first, last, VectorXd());
}

std::optional<InsStep> InsSystem::solve() const {
  const auto ends = ends_.solve();
  if (!ends) return std::nullopt;
  const auto count = static_cast<Index>(stretches_.size());
  InsStep step{MatrixXd(layout_.channels, problem_.grid.coefficients()), VectorXd::Zero(layout_.border),
               MatrixXd::Zero(layout_.wander, count)};
  step.border.head(border_) = ends->border;
  step.wander.topRows(wander_) = ends->band.block(end_width(), 0, wander_, count);
  constexpr Index shared = spline_order - 1;
  const auto put_end = [&](Index at, Index end) {
    step.band.middleCols(at, shared) = ends->band.col(end).head(end_width()).reshaped(layout_.channels, shared);
  };
  parallel_for(stretches_.size(), threads_, [&](std::size_t i) {
    const InsStretch& s = stretches_[i];
    put_end(s.first, static_cast<Index>(i));
    step.band.middleCols(s.first + shared, s.end - s.first - shared) = between(i, *ends);
  });
  put_end(problem_.grid.intervals, count);
  return step;
}

/// Gradient in the border's unknowns of each interval of a stretch.
MatrixXd InsSystem::stretch_scores(std::size_t stretch, ConstMatrixRef ends_following) const {
  const auto [first, end] = stretches_[stretch];
  const BandStretch band = kept_.empty() ? eliminated(stretches_[stretch]) : kept_[stretch];
  const Index e = end_width(), group = e + layout_.wander, inner = (end - first) * layout_.channels - e,
              at = static_cast<Index>(stretch) * group;
  MatrixXd border = MatrixXd::Identity(layout_.border, layout_.border);
  if (layout_.wander > 0) border(wandering_, Eigen::all) -= ends_following.middleRows(at + e, layout_.wander);
  MatrixXd following(inner + 2 * e, layout_.border);
  following.topRows(e) = ends_following.middleRows(at, e);
  following.bottomRows(e) = ends_following.middleRows(at + group, e);
  following.middleRows(e, inner) = band.following(following.topRows(e), following.bottomRows(e), border);
  MatrixXd scores(end - first, layout_.border);
  const auto gradients = linearisation_.gradients(stretches_[stretch]);
  for (Index i = 0; i < scores.rows(); ++i) {
    const IntervalGradient& gradient = gradients[static_cast<std::size_t>(i)];
    const auto window = following.middleRows(i * layout_.channels, spline_order * layout_.channels);
    scores.row(i) = (border.transpose() * gradient.border - window.transpose() * gradient.band).transpose();
  }
  return scores;
}

InsSystem::Scores InsSystem::scores(double seconds) const {
  const auto intervals = std::max<Index>(1, static_cast<Index>(std::round(seconds / problem_.grid.period)));
  const MatrixXd ends_following = ends_.following();
  Scores result{MatrixXd::Zero((problem_.grid.intervals + intervals - 1) / intervals, layout_.border),
                prior_information(ends_following)};
  for (std::size_t first = 0; first < stretches_.size(); first += at_once) {
    std::vector<MatrixXd> scores(std::min(at_once, stretches_.size() - first));
    parallel_for(scores.size(), threads_,
                 [&](std::size_t i) { scores[i] = stretch_scores(first + i, ends_following); });
    for (std::size_t i = 0; i < scores.size(); ++i)
      for (Index k = 0; k < scores[i].rows(); ++k)
        result.blocks.row((stretches_[first + i].first + k) / intervals) += scores[i].row(k);
  }
  return result;
}

MatrixXd InsSystem::prior_information(ConstMatrixRef ends_following) const {
  MatrixXd information = border_prior(problem_, layout_, x_).matrix;
  if (layout_.wander == 0) return information;
  const WanderPrior prior = wander_prior(problem_, layout_);
  MatrixXd before = MatrixXd::Zero(layout_.wander, layout_.border);
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    const Index at = static_cast<Index>(k) * (end_width() + layout_.wander) + end_width();
    const MatrixXd now = ends_following.middleRows(at, layout_.wander), surprise = now - prior.keep * before;
    information.noalias() +=
        surprise.transpose() * (k == 0 ? prior.information : prior.innovation).asDiagonal() * surprise;
    before = now;
  }
  return information;
}

}  // namespace kinfer
