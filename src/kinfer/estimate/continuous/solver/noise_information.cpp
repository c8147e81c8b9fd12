// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/noise_information.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/continuous/model/retraction.hpp"
#include "kinfer/estimate/continuous/solver/linearisation.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double step = 1e-4;  // [m], [rad]: predictions are nearly linear in a lever arm

// The information and its share from noise are sums of squares, one for each interval of the splines: both vary by a
// relative 2 / intervals. Information counts beyond so many standard deviations of their difference. Eight lever arms
// that nothing excites (four recordings of a linkage that keeps a body upright) have shares of 0.78 to 0.95 where 1 is
// expected, the minimum of the cost being where it is most curved; of all else in these the largest share is 5e-5.
constexpr double noise_deviations = 4.0, variance_terms = 2.0;
constexpr double least_known = 1e-12;  // part of the information: a covariance stays finite

InsUnknowns moved(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, Index parameter) {
  return retract(problem, layout, x,
                 {MatrixXd::Zero(x.spline_coefficients.rows(), x.spline_coefficients.cols()),
                  step * VectorXd::Unit(layout.global_parameters, parameter),
                  MatrixXd::Zero(x.bias_process.rows(), x.bias_process.cols())});
}

std::vector<Index> joint_parameters(const InsLayout& layout, const InsBodies& bodies) {
  std::vector<Index> all;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (Index i = 0; i < bodies[b].unknowns(); ++i) all.push_back(layout.body[b] + i);
  return all;
}

/// A time segment condensed to its ends, with W of the parameters as its coupling to the border.
struct CoupledSegment {
  BandSpan span;
  MatrixXd border;
  bool is_positive_definite = false;
};

CoupledSegment coupled_segment(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                               const InsLinearisation& here, const std::vector<InsUnknowns>& places,
                               const TimeSegment& intervals) {
  BandSegmentSum splines = here.sum_back_substituted(intervals);
  BandSegmentSum sum(splines.width, splines.reach, static_cast<Index>(places.size()), splines.spans);
  sum.band = std::move(splines.band);
  const std::vector<VectorXd> residuals = here.residuals(intervals);
  const VectorXd reference = spline_product(problem, layout, x, intervals, residuals);
  for (Index row = sum.end(); const InsUnknowns& place : places)
    sum.outer.row(row++) =
        (spline_product(problem, layout, place, intervals, residuals) - reference).transpose() / step;
  const BandSegment band(std::move(sum));
  return {band.condensed(), band.border_matrix(), band.is_positive_definite()};
}

}  // namespace

NoiseInformation noise_information(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                   int threads) {
  NoiseInformation result{joint_parameters(layout, x.bodies), {}, static_cast<double>(problem.grid.intervals)};
  const std::vector<Index>& parameters = result.parameters;
  const auto count = static_cast<Index>(parameters.size());
  std::vector<InsUnknowns> places;
  for (const Index parameter : parameters) places.push_back(moved(problem, layout, x, parameter));
  const InsLinearisation here(problem, layout, x);
  const std::vector<TimeSegment> segments = time_segments_of(problem.grid);
  std::vector<CoupledSegment> coupled(segments.size());
  parallel_for(segments.size(), threads,
               [&](std::size_t i) { coupled[i] = coupled_segment(problem, layout, x, here, places, segments[i]); });
  BorderedBand ends((spline_order - 1) * layout.spline_dimensions, 2, count);
  MatrixXd border = MatrixXd::Zero(count, count);
  for (const CoupledSegment& segment : coupled) {
    ends.add(segment.span, segment.is_positive_definite);
    border += segment.border;
  }
  ends.finish(border, VectorXd::Zero(count));
  result.information = MatrixXd::Zero(count, count);
  if (ends.is_positive_definite()) result.information = -ends.schur();
  return result;
}

void discount(MatrixXd& covariance, ConstMatrixRef white, ConstMatrixRef prior, const NoiseInformation& noise) {
  const SymmetricEigen simulated = symmetric_eigen(noise.information);
  const MatrixXd root = simulated.vectors * simulated.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  const SymmetricEigen share =
      symmetric_eigen(propagated_covariance(root.transpose(), white(noise.parameters, noise.parameters)));
  const double doubt = 1.0 + noise_deviations * std::sqrt(2.0 * variance_terms / noise.intervals);
  const MatrixXd before = covariance;
  for (Index i = 0; i < share.values.size(); ++i) {
    const VectorXd weights = root * share.vectors.col(i);
    VectorXd direction = before(Eigen::all, noise.parameters) * weights;
    const double variance = weights.dot(direction(noise.parameters));
    if (!(variance > 0.0)) continue;
    direction /= std::sqrt(variance);
    const double signal = std::max(0.0, 1.0 - doubt * share.values[i]);
    const double known = std::max({signal * signal, direction.dot(prior * direction), least_known});
    if (known < 1.0) covariance += (1.0 / known - 1.0) * direction * direction.transpose();
  }
}

}  // namespace kinfer
