// SPDX-License-Identifier: Apache-2.0
// A time segment of a bordered band matrix in which all unknowns that only its own spans touch are eliminated (static
// condensation, Przemieniecki 1963; one level of nested dissection, George 1973).
//
// n spans touch the groups 0 .. n + reach - 2. The first and the last reach - 1 of them, the ends of the segment, are
// shared with its neighbours and remain. Segments can therefore be eliminated in parallel. Each is condensed to one
// span of a shorter band, which BorderedBand(width of an end, 2, border) solves.
#pragma once

#include "kinfer/linalg/block_products.hpp"
#include "kinfer/linalg/bordered_band.hpp"

namespace kinfer {

/// Accumulates the normal equations of a time segment. Unknown c of span k is unknown k·width + c of the segment.
struct BandSegmentSum {
  BandSegmentSum(Eigen::Index width, Eigen::Index reach, Eigen::Index border, Eigen::Index spans);

  void add(Eigen::Index span, const BandSpan& more);

  Eigen::Index end() const { return (reach - 1) * width; }           ///< unknowns of one end
  Eigen::Index inner_groups() const { return spans - (reach - 1); }  ///< between the ends

  Eigen::Index width, reach, border, spans;
  MatrixXd band;           ///< reach·width x unknowns: each column holds its rows from its own group on; lower half
  MatrixXd outer;          ///< (end + border) x unknowns: coupling to the border; the elimination fills the first rows
  VectorXd right;          ///< unknowns
  MatrixXd border_matrix;  ///< lower half
  VectorXd border_right;
};

class BandSegment {
 public:
  /// Eliminates in place. The diagonal of the band is first multiplied by 1 + damping.
  explicit BandSegment(BandSegmentSum sum, double damping = 0.0);

  bool is_positive_definite() const { return positive_; }  ///< false: a pivot was not, and no member below may be used

  /// The condensed system: matrix and right-hand side over [first end, last end], and their coupling to the border.
  BandSpan condensed() const;
  /// Matrix (lower half) and right-hand side of the border after the elimination.
  const MatrixXd& border_matrix() const { return sum_.border_matrix; }
  const VectorXd& border_right() const { return sum_.border_right; }

  /// Values of the groups between the ends, width x inner groups, given those of the ends and of the border.
  MatrixXd solve(ConstVectorRef first_end, ConstVectorRef last_end, ConstVectorRef border) const;

  /// Sensitivity of the groups between the ends to some unknowns z, inner groups·width x z, given that of the ends: all
  /// change by minus these matrices times z. `border`: change of the border with z, + I where z is the border.
  MatrixXd sensitivity(ConstMatrixRef first_end, ConstMatrixRef last_end, ConstMatrixRef border) const;

 private:
  void split_first_end();
  bool eliminate(Eigen::Index first);
  void reduce_outer();
  Eigen::Index end() const { return sum_.end(); }
  Eigen::Index inner() const { return sum_.inner_groups() * sum_.width; }  ///< unknowns between the ends
  void substitute_back(MatrixRef values) const;

  BandSegmentSum sum_;  // between the ends: the Cholesky factor, and the forward-substituted coupling and right side
  MatrixXd first_end_;
  bool positive_ = true;
};

}  // namespace kinfer
