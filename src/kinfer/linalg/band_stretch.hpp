// A stretch of a bordered band in which everything that only its own spans touch is eliminated (static condensation,
// Przemieniecki 1963; one level of nested dissection, George 1973).
//
// n spans touch the groups 0 .. n + reach - 2. The first and the last reach - 1 of them, the stretch's ends, are shared
// with its neighbours and stay; so stretches can be eliminated one beside the other, each on a thread of its own, and
// what is left of each is one span of a shorter band: BorderedBand(ends' width, 2, border) finishes it.
#pragma once

#include "kinfer/linalg/bordered_band.hpp"

namespace kinfer {

/// The normal equations of a stretch while they are summed up. Unknown c of span k is the stretch's unknown
/// k·width + c.
struct StretchSum {
  StretchSum(Eigen::Index width, Eigen::Index reach, Eigen::Index border, Eigen::Index spans);

  void add(Eigen::Index span, const BandSpan& more);

  Eigen::Index end() const { return (reach - 1) * width; }           ///< unknowns of one end
  Eigen::Index inner_groups() const { return spans - (reach - 1); }  ///< between the ends

  Eigen::Index width, reach, border, spans;
  MatrixXd band;    ///< reach·width x unknowns: of each column the rows from its own group on; the lower half
  MatrixXd beside;  ///< (end + border) x unknowns: how they meet the border; the first rows are the elimination's
  VectorXd right;   ///< unknowns
  MatrixXd border_matrix;  ///< lower half
  VectorXd border_right;
};

class BandStretch {
 public:
  /// Eliminates, in the place of the sum. `damping`: times the band's diagonal, to be added.
  explicit BandStretch(StretchSum sum, double damping = 0.0);

  bool positive() const { return positive_; }  ///< false: some pivot was not, and nothing below may be asked for

  /// What is left: matrix and right side over [first end, last end], and how they meet the border.
  BandSpan condensed() const;
  /// The border's matrix (lower half) and right side, less what the elimination takes from them.
  const MatrixXd& border_matrix() const { return sum_.border_matrix; }
  const VectorXd& border_right() const { return sum_.border_right; }

  /// Values of the groups between the ends, width x inner groups, where ends and border have these.
  MatrixXd solve(ConstVectorRef first_end, ConstVectorRef last_end, ConstVectorRef border) const;

  /// How the groups between the ends follow some unknowns z, inner groups·width x z, where the ends follow like this:
  /// they change by minus these matrices times z. `border`: how the border changes, + I where z is the border.
  MatrixXd following(ConstMatrixRef first_end, ConstMatrixRef last_end, ConstMatrixRef border) const;

 private:
  void take_off_first_end();
  bool eliminate(Eigen::Index first);
  void take_from_beside();
  Eigen::Index end() const { return sum_.end(); }
  Eigen::Index inner() const { return sum_.inner_groups() * sum_.width; }  ///< unknowns between the ends
  template <class Values>
  void substitute_back(Values& values) const;

  StretchSum sum_;  // between the ends: in `band` the factor, in `beside` and `right` what the factor makes of them
  MatrixXd first_end_;
  bool positive_ = true;
};

}  // namespace kinfer
