// SPDX-License-Identifier: Apache-2.0
// Normal equations with a bordered band: unknowns in time order that couple to their near neighbours only, and a border
// of global unknowns that couple to all. Cholesky elimination along the band, and the Schur complement of the border.
//
//   | A  Bᵀ | | x |   | a |      A: `steps` groups of `width` unknowns, each coupled to the `reach` - 1 next groups,
//   | B  C  | | z | = | c |      C: border x border.
//
// Work and memory grow linearly with the number of steps: a frontal matrix of reach·width + border rows moves along the
// band (Irons 1970), and each group is eliminated as soon as it is fully assembled.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// Contribution of one span: groups k .. k + reach - 1 and their coupling to the border.
struct BandSpan {
  MatrixXd matrix;    ///< reach·width squared; the lower half is read
  MatrixXd coupling;  ///< border x reach·width
  VectorXd right;     ///< reach·width
};

class BorderedBand {
 public:
  BorderedBand(Eigen::Index width, Eigen::Index reach, Eigen::Index border);

  /// Spans come in order, the k-th couples groups k .. k + reach - 1; group k is eliminated at once.
  /// `sound` false: the span is that of a time segment whose own elimination failed; this one then fails too.
  void add(const BandSpan& span, bool is_valid = true);

  /// Eliminates the remaining groups. `border_matrix` C (lower half) and `border_right` c are the sums over all spans.
  void finish(ConstMatrixRef border_matrix, ConstVectorRef border_right);

  bool is_positive_definite() const { return positive_; }  ///< false: a pivot was not, and no member below may be used

  struct Solution {
    MatrixXd band;    ///< width x groups
    VectorXd border;  ///< z
  };
  /// nullopt if the Schur complement is not positive definite.
  std::optional<Solution> solve() const;

  /// C − B A⁻¹ Bᵀ: the information matrix of the border with the band marginalised. Symmetric.
  const MatrixXd& schur() const { return schur_; }

  /// A⁻¹ Bᵀ, groups·width x border: minus the sensitivity of the band to the border.
  MatrixXd sensitivity() const;

  /// Diagonal block `group` of A⁻¹: covariance of a group, the border given. Precondition: reach 2.
  MatrixXd conditional_covariance(Eigen::Index group) const;

 private:
  struct Group {
    MatrixXd pivot;     ///< L, width x width, lower
    MatrixXd next;      ///< (reach-1)·width x width
    MatrixXd coupling;  ///< border x width
    VectorXd right;     ///< L⁻¹ a
  };
  void eliminate_first();

  Eigen::Index width_, reach_, border_;
  BandSpan front_;
  std::vector<Group> groups_;
  MatrixXd schur_;
  VectorXd schur_right_;
  bool positive_ = true;
};

}  // namespace kinfer
