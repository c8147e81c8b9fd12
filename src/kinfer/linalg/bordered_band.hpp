// Normal equations of unknowns in time order that touch their near neighbours only, bordered by a few that all share:
// Cholesky elimination that walks along the band, and the Schur complement of the border.
//
//   | A  Bᵀ | | x |   | a |      A: `steps` groups of `width` unknowns, each coupled to the `reach` - 1 next groups,
//   | B  C  | | z | = | c |      C: border x border.
//
// Work and memory grow linearly with the number of steps: a frontal matrix of reach·width + border rows moves along
// (Irons 1970), each group is eliminated as soon as nothing more can come for it.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer {

/// What one span adds: groups k .. k + reach - 1 and how they meet the border.
struct BandSpan {
  MatrixXd matrix;    ///< reach·width squared; the lower half is read
  MatrixXd coupling;  ///< border x reach·width
  VectorXd right;     ///< reach·width
};

class BorderedBand {
 public:
  BorderedBand(Eigen::Index width, Eigen::Index reach, Eigen::Index border);

  /// Spans come in order, the k-th couples groups k .. k + reach - 1; group k is eliminated at once.
  /// `sound` false: the span is that of a stretch whose own elimination failed, and so does this one.
  void add(const BandSpan& span, bool sound = true);

  /// Eliminates what is left. `border_matrix` C (lower half) and `border_right` c are the sums over all spans.
  void finish(ConstMatrixRef border_matrix, ConstVectorRef border_right);

  bool positive() const { return positive_; }  ///< false: some pivot was not, and nothing below may be asked for

  struct Solution {
    MatrixXd band;    ///< width x groups
    VectorXd border;  ///< z
  };
  /// Nothing where the Schur complement is not positive definite.
  std::optional<Solution> solve() const;

  /// C − B A⁻¹ Bᵀ: the information on the border when the band is free. Symmetric.
  const MatrixXd& schur() const { return schur_; }

  /// A⁻¹ Bᵀ, groups·width x border: how the band follows the border.
  MatrixXd following() const;

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
