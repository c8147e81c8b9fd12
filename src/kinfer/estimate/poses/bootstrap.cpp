// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/bootstrap.hpp"

#include <cmath>
#include <optional>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/poses/point_fit.hpp"

namespace kinfer {
namespace {

/// How often each pose was drawn.
std::vector<double> draw_counts(Eigen::Index poses, Rng rng) {
  std::vector<double> count(poses, 0.0);
  for (Eigen::Index i = 0; i < poses; ++i) ++count[rng.index(poses)];
  return count;
}

/// A pose drawn n times has its standard deviation divided by √n; one that was not drawn gets infinite standard
/// deviation, that is no weight.
Weights reweighted(const PoseSet& data, Weights weights, const std::vector<double>& count) {
  for (const Block& block : blocks_of(data)) weights.of(block.kind)[block.index] /= std::sqrt(count[block.row]);
  return weights;
}

bool has_failed(Stop stop) {
  return stop == Stop::budget_spent || stop == Stop::not_finite;
}

}  // namespace

Bootstrap bootstrap(const Chain& estimate, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                    const BootstrapOptions& options, Rng rng) {
  KINFER_EXPECT(options.resamples > 1, "{} resamples", options.resamples);
  const VectorXd start = pack(set, estimate);
  LeastSquaresOptions fit_options = options_near_optimum();
  fit_options.max_iterations = options.max_iterations;
  std::optional<BatchPoints> batch;
  if (has_only_points(estimate, set, data) && !has_full_covariances(data))
    batch.emplace(estimate, set, point_table(data));

  Bootstrap result;
  result.x.resize(start.size(), options.resamples);
  std::vector<char> failed(options.resamples, 0);
  parallel_for(options.resamples, options.threads, [&](std::size_t k) {
    const Weights resampled = reweighted(data, weights, draw_counts(data.rows(), rng.stream(k)));
    const LeastSquaresOutcome refit =
        batch ? fit_points(*batch, set, batch->weights(inverse_sd(resampled)), start, fit_options)
              : least_squares(pose_residuals(estimate, set, data, resampled), start, fit_options);
    result.x.col(static_cast<Eigen::Index>(k)) = refit.x;
    failed[k] = has_failed(refit.stop);
  });
  for (const char p : failed) result.failed += p;
  const MatrixXd centred = result.x.colwise() - result.x.rowwise().mean();
  result.sd = (centred.rowwise().squaredNorm() / (options.resamples - 1)).cwiseSqrt();
  return result;
}

}  // namespace kinfer
