// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/band_segment.hpp"

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/linalg/small_cholesky.hpp"

namespace kinfer {

namespace {
using Index = Eigen::Index;
}  // namespace

BandSegmentSum::BandSegmentSum(Index width_, Index reach_, Index border_, Index spans_)
    : width(width_),
      reach(reach_),
      border(border_),
      spans(spans_),
      band(MatrixXd::Zero(reach * width, (spans + reach - 1) * width)),
      outer(MatrixXd::Zero(end() + border, band.cols())),
      right(VectorXd::Zero(band.cols())),
      border_matrix(MatrixXd::Zero(border, border)),
      border_right(VectorXd::Zero(border)) {
  KINFER_EXPECT(spans >= reach - 1, "{} spans, ends of {} groups", spans, reach - 1);
}

void BandSegmentSum::add(Index span, const BandSpan& more) {
  KINFER_EXPECT(more.matrix.rows() == reach * width && more.coupling.rows() == border);
  const Index at = span * width;
  for (Index c = 0; c < more.matrix.cols(); ++c) {
    const Index group = c / width * width;
    band.col(at + c).segment(c - group, reach * width - c) += more.matrix.col(c).tail(reach * width - c);
  }
  outer.block(end(), at, border, reach * width) += more.coupling;
  right.segment(at, reach * width) += more.right;
}

BandSegment::BandSegment(BandSegmentSum sum, double damping) : sum_(std::move(sum)) {
  for (Index c = 0; c < sum_.band.cols(); ++c) sum_.band(c % sum_.width, c) *= 1.0 + damping;
  split_first_end();
  for (Index at = end(); positive_ && at < end() + inner(); at += sum_.width) positive_ = eliminate(at);
  if (positive_) reduce_outer();
}

/// Moves the coupling of the first end to the groups after it beside the band, to that of the border.
void BandSegment::split_first_end() {
  const Index w = sum_.width, e = end();
  first_end_ = MatrixXd::Zero(e, e);
  for (Index c = 0; c < e; ++c) {
    const Index group = c / w * w;
    first_end_.col(c).tail(e - c) = sum_.band.col(c).segment(c - group, e - c);
    sum_.outer.row(c).segment(e, group + w) = sum_.band.col(c).tail(group + w).transpose();
  }
}

/// Eliminates the group whose unknowns begin at `at`; false if its pivot is not positive definite.
bool BandSegment::eliminate(Index at) {
  const Index w = sum_.width, e = end();
  auto pivot = sum_.band.block(0, at, w, w), next = sum_.band.block(w, at, e, w);
  auto outer = sum_.outer.middleCols(at, w);
  auto right = sum_.right.segment(at, w);
  if (!factorise_small(pivot)) return false;
  solve_right(pivot, next);
  solve_right(pivot, outer);
  pivot.triangularView<Eigen::Lower>().solveInPlace(right);
  for (Index before = 0; before < e; before += w)
    add_product(next.bottomRows(e - before), next.middleRows(before, w), -1.0,
                sum_.band.block(0, at + w + before, e - before, w));
  add_product(outer, next, -1.0, sum_.outer.middleCols(at + w, e));
  sum_.right.segment(at + w, e).noalias() -= next * right;
  return true;
}

/// Subtracts the contribution of all inner groups from the ends and the border at once.
void BandSegment::reduce_outer() {
  const Index e = end(), b = sum_.border;
  const auto outer = sum_.outer.middleCols(e, inner());
  const VectorXd right = outer * sum_.right.segment(e, inner());
  MatrixXd contribution = MatrixXd::Zero(e + b, e + b);
  add_square(outer, 1.0, contribution);
  first_end_ -= contribution.topLeftCorner(e, e);
  sum_.outer.block(e, 0, b, e) -= contribution.bottomLeftCorner(b, e);
  sum_.right.head(e) -= right.head(e);
  sum_.border_matrix -= contribution.bottomRightCorner(b, b);
  sum_.border_right -= right.tail(b);
}

BandSpan BandSegment::condensed() const {
  const Index w = sum_.width, e = end(), b = sum_.border, last = end() + inner();
  BandSpan span{MatrixXd::Zero(2 * e, 2 * e), MatrixXd(b, 2 * e), VectorXd(2 * e)};
  span.matrix.topLeftCorner(e, e) = first_end_;
  span.matrix.bottomLeftCorner(e, e) = sum_.outer.topRightCorner(e, e).transpose();
  for (Index c = 0; c < e; ++c) span.matrix.col(e + c).tail(e - c) = sum_.band.col(last + c).segment(c % w, e - c);
  span.coupling << sum_.outer.bottomLeftCorner(b, e), sum_.outer.bottomRightCorner(b, e);
  span.right << sum_.right.head(e), sum_.right.tail(e);
  return span;
}

/// Back substitution in place: the rows of the inner groups hold lᵀ x, those after them the last end.
void BandSegment::substitute_back(MatrixRef values) const {
  const Index w = sum_.width, e = end();
  for (Index group = sum_.inner_groups() - 1; group >= 0; --group) {
    const Index at = group * w;
    auto value = values.middleRows(at, w);
    value.noalias() -= sum_.band.block(w, e + at, e, w).transpose() * values.middleRows(at + w, e);
    sum_.band.block(0, e + at, w, w).triangularView<Eigen::Lower>().transpose().solveInPlace(value);
  }
}

MatrixXd BandSegment::solve(ConstVectorRef first_end, ConstVectorRef last_end, ConstVectorRef border) const {
  VectorXd outer(end() + sum_.border), values(inner() + end());
  outer << first_end, border;
  values << sum_.right.segment(end(), inner()) - sum_.outer.middleCols(end(), inner()).transpose() * outer, last_end;
  substitute_back(values);
  return values.head(inner()).reshaped(sum_.width, sum_.inner_groups());
}

MatrixXd BandSegment::sensitivity(ConstMatrixRef first_end, ConstMatrixRef last_end, ConstMatrixRef border) const {
  const Index e = end();
  MatrixXd values(inner() + e, border.cols());
  values.topRows(inner()) = transposed_times(sum_.outer.block(e, e, sum_.border, inner()), border) -
                            transposed_times(sum_.outer.block(0, e, e, inner()), first_end);
  values.bottomRows(e) = last_end;
  substitute_back(values);
  return values.topRows(inner());
}

}  // namespace kinfer
