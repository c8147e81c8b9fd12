// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/bordered_band.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/linalg/block_products.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/linalg/small_cholesky.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

/// Solves l x = b in place, l lower triangular. Guarded: Eigen refers to the first element even of an empty matrix.
void solve_lower(const MatrixXd& l, const Eigen::Ref<MatrixXd>& b) {
  if (b.size() > 0) l.triangularView<Eigen::Lower>().solveInPlace(b);
}

void solve_upper(const MatrixXd& l, const Eigen::Ref<MatrixXd>& b) {
  if (b.size() > 0) l.triangularView<Eigen::Lower>().transpose().solveInPlace(b);
}

}  // namespace

BorderedBand::BorderedBand(Index width, Index reach, Index border)
    : width_(width),
      reach_(reach),
      border_(border),
      front_{MatrixXd::Zero(reach * width, reach * width), MatrixXd::Zero(border, reach * width),
             VectorXd::Zero(reach * width)},
      schur_(MatrixXd::Zero(border, border)),
      schur_right_(VectorXd::Zero(border)) {}

void BorderedBand::add(const BandSpan& span, bool is_valid) {
  positive_ = positive_ && is_valid;
  KINFER_EXPECT(span.matrix.rows() == reach_ * width_ && span.coupling.rows() == border_);
  front_.matrix.triangularView<Eigen::Lower>() += span.matrix;
  front_.coupling += span.coupling;
  front_.right += span.right;
  eliminate_first();
}

void BorderedBand::eliminate_first() {
  if (!positive_) return;
  const Index w = width_, rest = (reach_ - 1) * width_;
  Group group{front_.matrix.topLeftCorner(w, w), MatrixXd(front_.matrix.bottomLeftCorner(rest, w)),
              MatrixXd(front_.coupling.leftCols(w)), VectorXd(front_.right.head(w))};
  if (!factorise_small(group.pivot)) {
    positive_ = false;
    return;
  }
  solve_right(group.pivot, group.next);
  solve_right(group.pivot, group.coupling);
  solve_lower(group.pivot, group.right);

  MatrixXd matrix = MatrixXd::Zero(reach_ * w, reach_ * w);
  matrix.topLeftCorner(rest, rest) = front_.matrix.bottomRightCorner(rest, rest);
  add_square(group.next, -1.0, matrix.topLeftCorner(rest, rest));
  front_.matrix.swap(matrix);
  front_.coupling.leftCols(rest) = front_.coupling.rightCols(rest).eval();
  front_.coupling.rightCols(w).setZero();
  add_product(group.coupling, group.next, -1.0, front_.coupling.leftCols(rest));
  front_.right.head(rest) = front_.right.tail(rest).eval() - group.next * group.right;
  front_.right.tail(w).setZero();
  add_square(group.coupling, -1.0, schur_);
  schur_right_.noalias() -= group.coupling * group.right;
  groups_.push_back(std::move(group));
}

void BorderedBand::finish(ConstMatrixRef border_matrix, ConstVectorRef border_right) {
  for (Index i = 1; i < reach_; ++i) eliminate_first();
  schur_.triangularView<Eigen::Lower>() += border_matrix;
  schur_.triangularView<Eigen::StrictlyUpper>() = schur_.transpose();
  schur_right_ += border_right;
}

std::optional<BorderedBand::Solution> BorderedBand::solve() const {
  if (!positive_) return std::nullopt;
  Solution x{MatrixXd(width_, static_cast<Index>(groups_.size())), VectorXd(border_)};
  if (border_ > 0) {
    const auto border = solve_spd(schur_, schur_right_);
    if (!border) return std::nullopt;
    x.border = *border;
  }
  VectorXd after = VectorXd::Zero((reach_ - 1) * width_);
  for (Index k = x.band.cols() - 1; k >= 0; --k) {
    const Group& group = groups_[static_cast<std::size_t>(k)];
    VectorXd value = group.right - group.next.transpose() * after - group.coupling.transpose() * x.border;
    solve_upper(group.pivot, value);
    x.band.col(k) = value;
    if (reach_ == 1) continue;
    after.tail(after.size() - width_) = after.head(after.size() - width_).eval();
    after.head(width_) = value;
  }
  return x;
}

MatrixXd BorderedBand::sensitivity() const {
  KINFER_EXPECT(positive_);
  const auto steps = static_cast<Index>(groups_.size()), all = steps * width_;
  MatrixXd result(all, border_);
  for (Index k = steps - 1; k >= 0; --k) {
    const Group& group = groups_[static_cast<std::size_t>(k)];
    const Index behind = (k + 1) * width_, there = std::min((reach_ - 1) * width_, all - behind);
    MatrixXd value = group.coupling.transpose();
    value -= transposed_times(group.next.topRows(there), result.middleRows(behind, there));
    solve_upper(group.pivot, value);
    result.middleRows(k * width_, width_) = value;
  }
  return result;
}

/// From the last group to the first (Takahashi et al. 1973): with pivot L and next N of a group, its block of A⁻¹ is
/// L⁻ᵀ (I + Nᵀ Σ N) L⁻¹, Σ the block of the group behind it.
MatrixXd BorderedBand::conditional_covariance(Index group) const {
  KINFER_EXPECT(positive_ && reach_ == 2 && group < static_cast<Index>(groups_.size()));
  MatrixXd block = MatrixXd::Zero(width_, width_);
  for (auto k = static_cast<Index>(groups_.size()) - 1; k >= group; --k) {
    const Group& here = groups_[static_cast<std::size_t>(k)];
    MatrixXd half = MatrixXd::Identity(width_, width_) + transposed_times(here.next, product(block, here.next));
    solve_upper(here.pivot, half);
    block = half.transpose();
    solve_upper(here.pivot, block);
  }
  return block;
}

}  // namespace kinfer
