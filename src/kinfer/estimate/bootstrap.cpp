#include "kinfer/estimate/bootstrap.hpp"

#include <cmath>
#include <optional>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/point_fit.hpp"

namespace kinfer {
namespace {

/// How often each pose was drawn.
std::vector<double> drawn(Eigen::Index poses, Rng rng) {
  std::vector<double> count(poses, 0.0);
  for (Eigen::Index i = 0; i < poses; ++i) ++count[rng.index(poses)];
  return count;
}

/// A pose that counts n times has a standard deviation that is √n smaller; one that was not drawn has no weight.
Weights counted(const PoseSet& data, Weights weights, const std::vector<double>& count) {
  for (const Block& block : blocks_of(data)) weights.of(block.kind)[block.index] /= std::sqrt(count[block.row]);
  return weights;
}

bool is_poor(Stop stop) {
  return stop == Stop::budget_spent || stop == Stop::not_finite;
}

}  // namespace

Bootstrap bootstrap(const Chain& estimate, const ParameterSet& set, const PoseSet& data, const Weights& weights,
                    const BootstrapOptions& options, Rng rng) {
  KINFER_EXPECT(options.resamples > 1, "{} resamples", options.resamples);
  const VectorXd start = pack(set, estimate);
  LeastSquaresOptions how = near_the_optimum();
  how.max_iterations = options.max_iterations;
  std::optional<BatchPoints> batch;
  if (has_points_alone(estimate, set, data) && !has_full_covariances(data))
    batch.emplace(estimate, set, point_table(data));

  Bootstrap result;
  result.x.resize(start.size(), options.resamples);
  std::vector<char> poor(options.resamples, 0);
  parallel_for(options.resamples, options.threads, [&](std::size_t k) {
    const Weights resampled = counted(data, weights, drawn(data.rows(), rng.stream(k)));
    const LeastSquaresOutcome refit = batch ? fit_points(*batch, set, batch->weights(inverse_sd(resampled)), start, how)
                                            : least_squares(pose_residuals(estimate, set, data, resampled), start, how);
    result.x.col(static_cast<Eigen::Index>(k)) = refit.x;
    poor[k] = is_poor(refit.stop);
  });
  for (const char p : poor) result.poor += p;
  const MatrixXd centred = result.x.colwise() - result.x.rowwise().mean();
  result.sd = (centred.rowwise().squaredNorm() / (options.resamples - 1)).cwiseSqrt();
  return result;
}

}  // namespace kinfer
