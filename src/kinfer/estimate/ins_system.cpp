#include "kinfer/estimate/ins_system.hpp"

#include <algorithm>

#include "kinfer/base/parallel.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr Index stretch_intervals = 64;  // the last one takes the remainder as well
constexpr std::size_t batch = 16;        // stretches condensed before they are added: bounds the memory

template <class Stretch>
std::vector<Stretch> stretches_of(Index intervals) {
  std::vector<Stretch> stretches;
  const Index count = std::max<Index>(1, intervals / stretch_intervals);
  for (Index k = 0; k < count; ++k)
    stretches.push_back({k * stretch_intervals, k + 1 == count ? intervals : (k + 1) * stretch_intervals});
  return stretches;
}

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
      damping_(damping),
      threads_(threads),
      linearisation_(problem, layout, x),
      stretches_(stretches_of<Stretch>(problem.grid.intervals)),
      ends_(end_width(), 2, layout.border) {
  const bool keep = bytes_of(problem, layout) < most_kept;
  BorderPrior border = border_prior(problem, layout, x);
  border.matrix.diagonal() *= 1.0 + damping.border;
  for (std::size_t first = 0; first < stretches_.size(); first += batch) {
    const std::size_t count = std::min(batch, stretches_.size() - first);
    std::vector<Condensed> done(count);
    parallel_for(count, threads_, [&](std::size_t i) { done[i] = condensed(stretches_[first + i], keep); });
    for (Condensed& stretch : done) {
      ends_.add(stretch.span, stretch.positive);
      border.matrix += stretch.border.matrix;
      border.right += stretch.border.right;
      if (keep) kept_.push_back(std::move(*stretch.kept));
    }
  }
  ends_.finish(border.matrix, border.right);
}

InsSystem::Condensed InsSystem::condensed(const Stretch& stretch, bool keep) const {
  BorderSum border;
  BandStretch band = eliminated(stretch, border);
  Condensed result{band.condensed(), std::move(border), band.positive(), {}};
  if (keep) result.kept = std::move(band);
  return result;
}

/// `border`: what the stretch adds to the border's equations, its own elimination taken off.
BandStretch InsSystem::eliminated(const Stretch& stretch, BorderSum& border) const {
  BandStretch result(layout_.channels, spline_order, layout_.border);
  border = {MatrixXd::Zero(layout_.border, layout_.border), VectorXd::Zero(layout_.border)};
  for (Index interval = stretch.first; interval < stretch.end; ++interval) {
    BandSpan span = linearisation_.span(interval, border);
    span.matrix.diagonal() *= 1.0 + damping_.band;
    result.add(span);
  }
  border.matrix.diagonal() *= 1.0 + damping_.border;
  result.finish();
  border.matrix += result.border_matrix();
  border.right += result.border_right();
  return result;
}

/// The same where the step of the border is known.
BandStretch InsSystem::eliminated(const Stretch& stretch, ConstVectorRef border) const {
  BandStretch result(layout_.channels, spline_order, 0);
  BorderSum unused{MatrixXd::Zero(layout_.border, layout_.border), VectorXd::Zero(layout_.border)};
  for (Index interval = stretch.first; interval < stretch.end; ++interval) {
    BandSpan span = linearisation_.span(interval, unused);
    span.matrix.diagonal() *= 1.0 + damping_.band;
    span.right -= span.coupling.transpose() * border;
    span.coupling.resize(0, span.matrix.cols());
    result.add(span);
  }
  return result;
}

/// Steps of a stretch's coefficients between its ends.
MatrixXd InsSystem::between(std::size_t stretch, const BorderedBand::Solution& ends) const {
  const auto k = static_cast<Index>(stretch);
  if (!kept_.empty()) return kept_[stretch].solve(ends.band.col(k), ends.band.col(k + 1), ends.border);
  return eliminated(stretches_[stretch], ends.border).solve(ends.band.col(k), ends.band.col(k + 1), VectorXd());
}

std::optional<BorderedBand::Solution> InsSystem::solve() const {
  const auto ends = ends_.solve();
  if (!ends) return std::nullopt;
  BorderedBand::Solution all{MatrixXd(layout_.channels, problem_.grid.coefficients()), ends->border};
  constexpr Index shared = spline_order - 1;
  const auto put_end = [&](Index at, Index end) {
    all.band.middleCols(at, shared) = ends->band.col(end).reshaped(layout_.channels, shared);
  };
  parallel_for(stretches_.size(), threads_, [&](std::size_t i) {
    const Stretch& s = stretches_[i];
    put_end(s.first, static_cast<Index>(i));
    all.band.middleCols(s.first + shared, s.end - s.first - shared) = between(i, *ends);
  });
  put_end(problem_.grid.intervals, ends->band.cols() - 1);
  return all;
}

/// Gradient in the border's unknowns of each interval of a stretch.
MatrixXd InsSystem::stretch_scores(std::size_t stretch, ConstMatrixRef ends_following) const {
  const auto [first, end] = stretches_[stretch];
  BorderSum unused;
  const BandStretch band = kept_.empty() ? eliminated(stretches_[stretch], unused) : kept_[stretch];
  const Index e = end_width(), inner = (end - first) * layout_.channels - e, at = static_cast<Index>(stretch) * e;
  MatrixXd following(inner + 2 * e, layout_.border);
  following.topRows(e) = ends_following.middleRows(at, e);
  following.bottomRows(e) = ends_following.middleRows(at + e, e);
  following.middleRows(e, inner) = band.following(following.topRows(e), following.bottomRows(e));
  MatrixXd scores(end - first, layout_.border);
  for (Index i = 0; i < scores.rows(); ++i) {
    const IntervalGradient gradient = linearisation_.gradient(first + i);
    const auto window = following.middleRows(i * layout_.channels, spline_order * layout_.channels);
    scores.row(i) = (gradient.border - window.transpose() * gradient.band).transpose();
  }
  return scores;
}

MatrixXd InsSystem::block_scores(Index intervals) const {
  const MatrixXd ends_following = ends_.following();
  MatrixXd blocks = MatrixXd::Zero((problem_.grid.intervals + intervals - 1) / intervals, layout_.border);
  for (std::size_t first = 0; first < stretches_.size(); first += batch) {
    std::vector<MatrixXd> scores(std::min(batch, stretches_.size() - first));
    parallel_for(scores.size(), threads_,
                 [&](std::size_t i) { scores[i] = stretch_scores(first + i, ends_following); });
    for (std::size_t i = 0; i < scores.size(); ++i)
      for (Index k = 0; k < scores[i].rows(); ++k)
        blocks.row((stretches_[first + i].first + k) / intervals) += scores[i].row(k);
  }
  return blocks;
}

}  // namespace kinfer
