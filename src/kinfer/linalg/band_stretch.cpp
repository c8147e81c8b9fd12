#include "kinfer/linalg/band_stretch.hpp"

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/small_cholesky.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

MatrixXd side_by_side(const std::vector<MatrixXd>& parts, Index rows, Index width) {
  MatrixXd all(rows, width * static_cast<Index>(parts.size()));
  for (std::size_t k = 0; k < parts.size(); ++k) all.middleCols(width * static_cast<Index>(k), width) = parts[k];
  return all;
}

}  // namespace

BandStretch::BandStretch(Index width, Index reach, Index border)
    : width_(width),
      reach_(reach),
      border_(border),
      front_{MatrixXd::Zero(reach * width, reach * width), MatrixXd::Zero((reach - 1) * width + border, reach * width),
             VectorXd::Zero(reach * width)},
      end_matrix_(MatrixXd::Zero((reach - 1) * width + border, (reach - 1) * width + border)),
      end_right_(VectorXd::Zero((reach - 1) * width + border)) {}

void BandStretch::add(const BandSpan& span) {
  KINFER_EXPECT(span.matrix.rows() == reach_ * width_ && span.coupling.rows() == border_);
  if (spans_++ < reach_ - 1) return add_beside_first_end(span);
  front_.matrix.triangularView<Eigen::Lower>() += span.matrix;
  front_.coupling.bottomRows(border_) += span.coupling;
  front_.right += span.right;
  eliminate_first();
}

/// The span's first groups belong to the first end, its others to the front, which waits there.
void BandStretch::add_beside_first_end(const BandSpan& span) {
  const Index from = (spans_ - 1) * width_, in_end = end() - from, in_front = reach_ * width_ - in_end;
  end_matrix_.block(from, from, in_end, in_end).triangularView<Eigen::Lower>() +=
      span.matrix.topLeftCorner(in_end, in_end);
  end_matrix_.block(end(), from, border_, in_end) += span.coupling.leftCols(in_end);
  end_right_.segment(from, in_end) += span.right.head(in_end);
  front_.matrix.topLeftCorner(in_front, in_front).triangularView<Eigen::Lower>() +=
      span.matrix.bottomRightCorner(in_front, in_front);
  front_.coupling.block(from, 0, in_end, in_front) += span.matrix.bottomLeftCorner(in_front, in_end).transpose();
  front_.coupling.bottomLeftCorner(border_, in_front) += span.coupling.rightCols(in_front);
  front_.right.head(in_front) += span.right.tail(in_front);
}

void BandStretch::eliminate_first() {
  if (!positive_) return;
  const Index w = width_, rest = end();
  Group group{front_.matrix.topLeftCorner(w, w), MatrixXd(front_.matrix.bottomLeftCorner(rest, w))};
  if (!factorise_small(group.pivot)) {
    positive_ = false;
    return;
  }
  MatrixXd coupling = front_.coupling.leftCols(w);
  VectorXd right = front_.right.head(w);
  const auto inverse_upper = group.pivot.triangularView<Eigen::Lower>().transpose();
  inverse_upper.solveInPlace<Eigen::OnTheRight>(group.next);
  inverse_upper.solveInPlace<Eigen::OnTheRight>(coupling);
  group.pivot.triangularView<Eigen::Lower>().solveInPlace(right);
  // Everything moves up by one group while the eliminated one is taken off.
  for (Index c = 0; c < rest; ++c)
    front_.matrix.col(c).segment(c, rest - c) = front_.matrix.col(c + w).segment(c + w, rest - c) -
                                                group.next.bottomRows(rest - c) * group.next.row(c).transpose();
  front_.matrix.bottomRows(w).setZero();
  front_.matrix.rightCols(w).setZero();
  front_.coupling.leftCols(rest) = front_.coupling.rightCols(rest).eval();
  front_.coupling.rightCols(w).setZero();
  front_.coupling.leftCols(rest).noalias() -= coupling * group.next.transpose();
  front_.right.head(rest) = front_.right.tail(rest).eval() - group.next * right;
  front_.right.tail(w).setZero();
  end_right_.noalias() -= coupling * right;
  groups_.push_back(std::move(group));
  coupling_.push_back(std::move(coupling));
  right_.push_back(std::move(right));
}

void BandStretch::finish() {
  KINFER_EXPECT(spans_ >= reach_ - 1, "{} spans, ends of {} groups", spans_, reach_ - 1);
  if (positive_ && !groups_.empty())  // all groups in one product: it is as fast as the processor allows
    end_matrix_.selfadjointView<Eigen::Lower>().rankUpdate(side_by_side(coupling_, end_matrix_.rows(), width_), -1.0);
}

BandSpan BandStretch::condensed() const {
  const Index e = end();
  BandSpan span{MatrixXd::Zero(2 * e, 2 * e), MatrixXd(border_, 2 * e), VectorXd(2 * e)};
  span.matrix.topLeftCorner(e, e) = end_matrix_.topLeftCorner(e, e);
  span.matrix.bottomLeftCorner(e, e) = front_.coupling.topLeftCorner(e, e).transpose();
  span.matrix.bottomRightCorner(e, e) = front_.matrix.topLeftCorner(e, e);
  span.coupling << end_matrix_.bottomLeftCorner(border_, e), front_.coupling.bottomLeftCorner(border_, e);
  span.right << end_right_.head(e), front_.right.head(e);
  return span;
}

MatrixXd BandStretch::border_matrix() const {
  return end_matrix_.bottomRightCorner(border_, border_);
}

MatrixXd BandStretch::solve(ConstVectorRef first_end, ConstVectorRef last_end, ConstVectorRef border) const {
  VectorXd beside(end() + border_);
  beside << first_end, border;
  MatrixXd values(width_, static_cast<Index>(groups_.size()));
  VectorXd after = last_end;
  for (Index k = values.cols() - 1; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(k);
    VectorXd value = right_[i] - groups_[i].next.transpose() * after - coupling_[i].transpose() * beside;
    groups_[i].pivot.triangularView<Eigen::Lower>().transpose().solveInPlace(value);
    values.col(k) = value;
    if (reach_ == 1) continue;
    after.tail(after.size() - width_) = after.head(after.size() - width_).eval();
    after.head(width_) = value;
  }
  return values;
}

MatrixXd BandStretch::following(ConstMatrixRef first_end, ConstMatrixRef last_end, ConstMatrixRef border) const {
  const auto steps = static_cast<Index>(groups_.size());
  MatrixXd result(steps * width_ + end(), border.cols());
  result.bottomRows(end()) = last_end;
  for (Index k = steps - 1; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(k);
    MatrixXd value = coupling_[i].bottomRows(border_).transpose() * border -
                     coupling_[i].topRows(end()).transpose() * first_end -
                     groups_[i].next.transpose() * result.middleRows((k + 1) * width_, end());
    groups_[i].pivot.triangularView<Eigen::Lower>().transpose().solveInPlace(value);
    result.middleRows(k * width_, width_) = value;
  }
  return result.topRows(steps * width_);
}

}  // namespace kinfer
