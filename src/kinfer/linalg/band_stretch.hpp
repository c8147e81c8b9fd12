// A stretch of a bordered band in which everything that only its own spans touch is eliminated (static condensation,
// Przemieniecki 1963; one level of nested dissection, George 1973).
//
// n spans touch the groups 0 .. n + reach - 2. The first and the last reach - 1 of them, the stretch's ends, are shared
// with its neighbours and stay; so stretches can be eliminated one beside the other, each on a thread of its own, and
// what is left of each is one span of a shorter band: BorderedBand(ends' width, 2, border) finishes it.
#pragma once

#include "kinfer/linalg/bordered_band.hpp"

namespace kinfer {

class BandStretch {
 public:
  BandStretch(Eigen::Index width, Eigen::Index reach, Eigen::Index border);

  /// Spans come in order, at least reach - 1 of them.
  void add(const BandSpan& span);
  void finish();

  bool positive() const { return positive_; }  ///< false: some pivot was not, and nothing below may be asked for

  /// What is left once finished: matrix and right side over [first end, last end], and how they meet the border.
  BandSpan condensed() const;
  /// What the elimination takes from the border's matrix and right side (to be added; lower half).
  MatrixXd border_matrix() const;
  VectorXd border_right() const { return end_right_.tail(border_); }

  /// Values of the groups between the ends, width x inner groups, where ends and border have these.
  MatrixXd solve(ConstVectorRef first_end, ConstVectorRef last_end, ConstVectorRef border) const;

  /// How the groups between the ends follow some unknowns z, inner groups·width x z, where the ends follow like this:
  /// they change by minus these matrices times z. `border`: how the border changes, + I where z is the border.
  MatrixXd following(ConstMatrixRef first_end, ConstMatrixRef last_end, ConstMatrixRef border) const;

 private:
  struct Group {
    MatrixXd pivot;  ///< L, width x width, lower
    MatrixXd next;   ///< (reach-1)·width x width
  };
  Eigen::Index end() const { return (reach_ - 1) * width_; }
  void add_beside_first_end(const BandSpan& span);
  void eliminate_first();

  Eigen::Index width_, reach_, border_, spans_ = 0;
  BandSpan front_;       // its coupling has rows [first end, border]
  MatrixXd end_matrix_;  // of [first end, border], lower half
  VectorXd end_right_;
  std::vector<Group> groups_;
  std::vector<MatrixXd> coupling_;  // of each group: [first end, border] x width
  std::vector<VectorXd> right_;     // of each group: L⁻¹ a
  bool positive_ = true;
};

}  // namespace kinfer
