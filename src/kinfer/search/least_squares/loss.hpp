// SPDX-License-Identifier: Apache-2.0
// Robust losses: they limit the cost of a block of residuals, and so the influence of outliers on the fit.
//
// With s = |r|² of a block and a = its limit (both in sigmas), every loss is s for s << a² and
//   huber   s | 2 a √s − a²          beyond a: grows like |r|; convex, one optimum
//   cauchy  a² log(1 + s / a²)       grows like log |r|
//   tukey   a²/3 (1 − (1 − s/a²)³)   constant beyond a: outliers have no influence; needs a good start
// (Huber 1964; Holland and Welsch 1977; Beaton and Tukey 1974.)
#pragma once

namespace kinfer {

enum class Loss { none, huber, cauchy, tukey };

struct LossValue {
  double rho = 0.0;     ///< cost of the block
  double weight = 1.0;  ///< d rho / d s: the factor of the block's squares in re-weighted least squares, 0 .. 1
};

/// Cost and weight of a block with squared norm `s`; `limit` > 0 is a above.
LossValue loss_value(Loss loss, double s, double limit);

}  // namespace kinfer
