#include "kinfer/identify/yielding_mounts.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer {

double shown_tilt(const InsProblem& problem, const InsFit& fit, const InsCovariance& covariance) {
  constexpr double firm = 1e-5;  // [rad per m/s²] a tenth of a milliradian under the own weight: nobody sees that
  const double prior = problem.prior.tilt * problem.prior.tilt;
  double squares = 0.0, seen = 0.0;
  for (const Eigen::Index first : fit.layout.error)
    for (Eigen::Index i = 0; i < 9; ++i) {
      const Eigen::Index k = first + fit.layout.tilt_error + i;
      const double variance = std::max(1.0, covariance.inflation[k]) * covariance.model(k, k);
      seen += std::clamp(1.0 - variance / prior, 0.0, 1.0);
    }
  for (const InsErrors& errors : fit.unknowns.errors) squares += errors.tilt.squaredNorm();
  return seen > 0.0 ? std::max(firm, std::sqrt(squares / seen)) : problem.prior.tilt;
}

}  // namespace kinfer
