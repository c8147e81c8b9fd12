// SPDX-License-Identifier: Apache-2.0
// Which instruments' scale errors are larger than their prior says: its variances that make the recording most likely
// (automatic relevance determination; MacKay 1994, Tipping 2001).
//
// The fit gives mean m and covariance C of the scale parameters under the prior covariance P. Were A g to be added to
// them, g ~ N(0, s² I) one unknown per column of A, the recording would tell of g by information Λ = A'(P⁻¹ − P⁻¹CP⁻¹)A
// and right-hand side b = A'P⁻¹m, so that with the eigenvalues λ of Λ and b along their vectors
//   2 ln odds(s) = Σ s² b² / (1 + s² λ) − ln(1 + s² λ).
// s has an upper limit: what no instrument does is no explanation, however likely it would make the recording.
#pragma once

#include <vector>

#include "kinfer/linalg/types.hpp"

namespace kinfer::identify {

/// Scale parameters with their estimates.
struct ScaleEstimate {
  VectorXd mean;
  MatrixXd covariance;
  MatrixXd prior_information;  ///< P⁻¹
};

/// Parameters whose prior may be too narrow.
struct WideningCandidate {
  MatrixXd directions;      ///< A
  double largest_sd = 1.0;  ///< of s: larger errors are physically impossible
};

struct Widening {
  std::size_t candidate = 0;
  double sd = 0.0;        ///< s, most likely
  double log_odds = 0.0;  ///< against the prior as it was, those found before already widened
};

/// Those of the candidates A that are more likely than not to be needed, by the odds `log_prior_odds`; strongest first.
std::vector<Widening> find_widenings(ScaleEstimate estimate, const std::vector<WideningCandidate>& candidates,
                                     double log_prior_odds);

}  // namespace kinfer::identify
