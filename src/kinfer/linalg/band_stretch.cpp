#include "kinfer/linalg/band_stretch.hpp"

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/block_products.hpp"
#include "kinfer/linalg/small_cholesky.hpp"

namespace kinfer {

namespace {
using Index = Eigen::Index;
}  // namespace

StretchSum::StretchSum(Index width_, Index reach_, Index border_, Index spans_)
    : width(width_),
      reach(reach_),
      border(border_),
      spans(spans_),
      band(MatrixXd::Zero(reach * width, (spans + reach - 1) * width)),
      beside(MatrixXd::Zero(end() + border, band.cols())),
      right(VectorXd::Zero(band.cols())),
      border_matrix(MatrixXd::Zero(border, border)),
      border_right(VectorXd::Zero(border)) {
  KINFER_EXPECT(spans >= reach - 1, "{} spans, ends of {} groups", spans, reach - 1);
}

void StretchSum::add(Index span, const BandSpan& more) {
  KINFER_EXPECT(more.matrix.rows() == reach * width && more.coupling.rows() == border);
  const Index at = span * width;
  for (Index c = 0; c < more.matrix.cols(); ++c) {
    const Index group = c / width * width;
    band.col(at + c).segment(c - group, reach * width - c) += more.matrix.col(c).tail(reach * width - c);
  }
  beside.block(end(), at, border, reach * width) += more.coupling;
  right.segment(at, reach * width) += more.right;
}

BandStretch::BandStretch(StretchSum sum, double damping) : sum_(std::move(sum)) {
  for (Index c = 0; c < sum_.band.cols(); ++c) sum_.band(c % sum_.width, c) *= 1.0 + damping;
  take_off_first_end();
  for (Index at = end(); positive_ && at < end() + inner(); at += sum_.width) positive_ = eliminate(at);
  if (positive_) take_from_beside();
}

/// How the first end meets what comes behind it stands beside that: both ends and the border stay together.
void BandStretch::take_off_first_end() {
  const Index w = sum_.width, e = end();
  first_end_ = MatrixXd::Zero(e, e);
  for (Index c = 0; c < e; ++c) {
    const Index group = c / w * w;
    first_end_.col(c).tail(e - c) = sum_.band.col(c).segment(c - group, e - c);
    sum_.beside.row(c).segment(e, group + w) = sum_.band.col(c).tail(group + w).transpose();
  }
}

/// The group whose unknowns begin at `at`; false where its pivot is not positive.
bool BandStretch::eliminate(Index at) {
  const Index w = sum_.width, e = end();
  auto pivot = sum_.band.block(0, at, w, w), next = sum_.band.block(w, at, e, w);
  auto beside = sum_.beside.middleCols(at, w);
  auto right = sum_.right.segment(at, w);
  if (!factorise_small(pivot)) return false;
  solve_right(pivot, next);
  solve_right(pivot, beside);
  pivot.triangularView<Eigen::Lower>().solveInPlace(right);
  for (Index before = 0; before < e; before += w)
    add_product(next.bottomRows(e - before), next.middleRows(before, w), -1.0,
                sum_.band.block(0, at + w + before, e - before, w));
  add_product(beside, next, -1.0, sum_.beside.middleCols(at + w, e));
  sum_.right.segment(at + w, e).noalias() -= next * right;
  return true;
}

/// All groups at once.
void BandStretch::take_from_beside() {
  const Index e = end(), b = sum_.border;
  const auto beside = sum_.beside.middleCols(e, inner());
  const VectorXd right = beside * sum_.right.segment(e, inner());
  MatrixXd taken = MatrixXd::Zero(e + b, e + b);
  add_square(beside, 1.0, taken);
  first_end_ -= taken.topLeftCorner(e, e);
  sum_.beside.block(e, 0, b, e) -= taken.bottomLeftCorner(b, e);
  sum_.right.head(e) -= right.head(e);
  sum_.border_matrix -= taken.bottomRightCorner(b, b);
  sum_.border_right -= right.tail(b);
}

BandSpan BandStretch::condensed() const {
  const Index w = sum_.width, e = end(), b = sum_.border, last = end() + inner();
  BandSpan span{MatrixXd::Zero(2 * e, 2 * e), MatrixXd(b, 2 * e), VectorXd(2 * e)};
  span.matrix.topLeftCorner(e, e) = first_end_;
  span.matrix.bottomLeftCorner(e, e) = sum_.beside.topRightCorner(e, e).transpose();
  for (Index c = 0; c < e; ++c) span.matrix.col(e + c).tail(e - c) = sum_.band.col(last + c).segment(c % w, e - c);
  span.coupling << sum_.beside.bottomLeftCorner(b, e), sum_.beside.bottomRightCorner(b, e);
  span.right << sum_.right.head(e), sum_.right.tail(e);
  return span;
}

/// What stands in the rows of the inner groups, behind them the last end: lᵀ x, in its place comes x.
template <class Values>
void BandStretch::substitute_back(Values& values) const {
  const Index w = sum_.width, e = end();
  for (Index group = sum_.inner_groups() - 1; group >= 0; --group) {
    const Index at = group * w;
    auto value = values.middleRows(at, w);
    value.noalias() -= sum_.band.block(w, e + at, e, w).transpose() * values.middleRows(at + w, e);
    sum_.band.block(0, e + at, w, w).template triangularView<Eigen::Lower>().transpose().solveInPlace(value);
  }
}

MatrixXd BandStretch::solve(ConstVectorRef first_end, ConstVectorRef last_end, ConstVectorRef border) const {
  VectorXd beside(end() + sum_.border), values(inner() + end());
  beside << first_end, border;
  values << sum_.right.segment(end(), inner()) - sum_.beside.middleCols(end(), inner()).transpose() * beside, last_end;
  substitute_back(values);
  return values.head(inner()).reshaped(sum_.width, sum_.inner_groups());
}

MatrixXd BandStretch::following(ConstMatrixRef first_end, ConstMatrixRef last_end, ConstMatrixRef border) const {
  const Index e = end();
  MatrixXd values(inner() + e, border.cols());
  values << sum_.beside.block(e, e, sum_.border, inner()).transpose() * border -
                sum_.beside.block(0, e, e, inner()).transpose() * first_end,
      last_end;
  substitute_back(values);
  return values.topRows(inner());
}

}  // namespace kinfer
