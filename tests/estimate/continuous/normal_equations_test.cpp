// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/solver/normal_equations.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "support/random_bodies.hpp"

namespace kinfer {
namespace {

using Eigen::Index;
using test::random_vector;

std::vector<InsBlock> random_blocks(Index intervals, Rng& rng) {
  std::vector<InsBlock> blocks(static_cast<std::size_t>(intervals));
  for (InsBlock& block : blocks) {
    block.rows = block.samples = 3;
    for (Index i = 0; i < 3; ++i) {
      for (Index j = i; j < block_nodes; ++j) block.factor(i, j) = static_cast<float>(rng.normal());
      block.target.row(i) = random_vector(rng).transpose().cast<float>();
    }
  }
  return blocks;
}

/// A revolute joint on a moving root, with random measurements.
struct SystemExample {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;
};

enum class Biases { constant, time_varying };

SystemExample system_example(Index intervals, Biases biases = Biases::constant) {
  Rng rng(7);
  SystemExample e;
  e.problem.grid = {.begin = 0.0, .period = 0.1, .intervals = intervals};
  e.problem.root_at_rest = false;
  e.problem.prior = {0.1, 0.1, 0.01, 0.01};
  for (int s = 0; s < 2; ++s)
    e.problem.sensors.push_back({random_blocks(intervals, rng), random_blocks(intervals, rng), {}, {}, {}});
  e.x.bodies = {{.sensor = 0}, test::random_revolute_body(0, 1, rng)};
  e.x.bodies.back().point_in_child = random_vector(rng);
  e.x.errors.resize(2);
  e.x.spline_coefficients = MatrixXd(7, e.problem.grid.coefficients());
  for (double& value : e.x.spline_coefficients.reshaped()) value = 0.1 * rng.normal();
  if (biases == Biases::time_varying) e.problem.bias_process = {.rate_sd = 0.3, .force_sd = 0.2, .time = 10.0};
  e.layout = layout_of(e.problem, e.x.bodies);
  e.x.bias_process = MatrixXd(e.layout.bias_process, static_cast<Index>(time_segments_of(e.problem.grid).size()));
  for (double& value : e.x.bias_process.reshaped()) value = 0.1 * rng.normal();
  return e;
}

/// All equations in one dense matrix: spline coefficients interval by interval, biases by time segment, global
/// parameters.
struct Dense {
  MatrixXd matrix;
  VectorXd right;
  Index bias_process = 0, global_parameters = 0;  // first rows
  MatrixXd bias_process_prior;
};

/// Information of the Gauss-Markov process on the biases of all time segments: the inverse of σ² a^|i − j|.
MatrixXd process_information(const SystemExample& e) {
  const Index w = e.layout.bias_process, n = e.x.bias_process.cols();
  MatrixXd covariance = MatrixXd::Zero(w * n, w * n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      for (Index k = 0; k < w; ++k) {
        const double sd = k % 6 < 3 ? e.problem.bias_process.rate_sd : e.problem.bias_process.force_sd;
        covariance(i * w + k, j * w + k) =
            sd * sd * std::exp(-6.4 * static_cast<double>(std::abs(i - j)) / e.problem.bias_process.time);
      }
  return w * n > 0 ? *invert_spd(covariance) : covariance;
}

/// Lower half.
MatrixXd dense_band(const BandSegmentSum& sum) {
  const Index n = sum.right.size();
  MatrixXd dense = MatrixXd::Zero(n, n);
  for (Index c = 0; c < n; ++c)
    for (Index r = c; r < std::min(n, (c / sum.width + sum.reach) * sum.width); ++r)
      dense(r, c) = sum.band(r - c / sum.width * sum.width, c);
  return dense;
}

Dense dense(const SystemExample& e) {
  const Index splines = e.layout.spline_dimensions * e.problem.grid.coefficients(), w = e.layout.bias_process,
              first_global = splines + e.x.bias_process.size(), all = first_global + e.layout.global_parameters;
  Dense d{MatrixXd::Zero(all, all), VectorXd::Zero(all), splines, first_global, process_information(e)};
  const auto bias_columns = bias_parameters(e.layout);
  const GlobalParameterPrior prior = global_parameter_prior(e.problem, e.layout, e.x);
  d.matrix.bottomRightCorner(e.layout.global_parameters, e.layout.global_parameters) = prior.matrix;
  d.right.tail(e.layout.global_parameters) = prior.right;
  d.matrix.block(splines, splines, e.x.bias_process.size(), e.x.bias_process.size()) = d.bias_process_prior;
  d.right.segment(splines, e.x.bias_process.size()) = -d.bias_process_prior * e.x.bias_process.reshaped();
  const InsLinearisation linearisation(e.problem, e.layout, e.x);
  for (const TimeSegment& time_segment : time_segments_of(e.problem.grid)) {
    const BandSegmentSum sum = linearisation.sum(time_segment);
    const MatrixXd own = sum.border_matrix.selfadjointView<Eigen::Lower>();
    const MatrixXd coupling = sum.outer.bottomRows(e.layout.global_parameters);
    const Index at = time_segment.first * e.layout.spline_dimensions,
                first_bias = splines + w * time_segment_at(e.problem.grid, time_segment.first), n = sum.right.size();
    d.matrix.block(at, at, n, n) += dense_band(sum);
    d.matrix.block(first_global, at, e.layout.global_parameters, n) += coupling;
    d.matrix.block(first_bias, at, w, n) += coupling(bias_columns, Eigen::all);
    d.matrix.block(first_bias, first_bias, w, w) += own(bias_columns, bias_columns);
    d.matrix.block(first_global, first_bias, e.layout.global_parameters, w) += own(Eigen::all, bias_columns);
    d.matrix.bottomRightCorner(e.layout.global_parameters, e.layout.global_parameters) += own;
    d.right.segment(at, n) += sum.right;
    d.right.segment(first_bias, w) += sum.border_right(bias_columns);
    d.right.tail(e.layout.global_parameters) += sum.border_right;
  }
  d.matrix.triangularView<Eigen::StrictlyUpper>() = d.matrix.transpose();
  return d;
}

/// A⁻¹ Bᵀ of everything but the global parameters.
MatrixXd sensitivity(const Dense& d) {
  const Index rest = d.global_parameters;
  return *invert_spd(d.matrix.topLeftCorner(rest, rest)) * d.matrix.topRightCorner(rest, d.matrix.rows() - rest);
}

TEST(InsSystem, SolvesTheEquationsOfAllIntervalsTogether) {
  for (const Biases biases : {Biases::constant, Biases::time_varying})
    for (const Index intervals : {5, 64, 150, 300}) {
      const SystemExample e = system_example(intervals, biases);
      const Dense d = dense(e);
      const auto expected = solve_spd(d.matrix, d.right);
      const auto x = InsSystem(e.problem, e.layout, e.x, {}, 1).solve();
      ASSERT_TRUE(x && expected);
      EXPECT_LT((x->spline_coefficients.reshaped() - expected->head(d.bias_process)).norm(), 1e-7 * expected->norm());
      EXPECT_LT((x->bias_process.reshaped() - expected->segment(d.bias_process, x->bias_process.size())).norm(),
                1e-7 * expected->norm());
      EXPECT_LT((x->border - expected->tail(e.layout.global_parameters)).norm(), 1e-7 * expected->norm());
    }
}

TEST(InsSystem, BlockScoresAreGradientsWithSplinesAndBiasesEliminated) {
  for (const Biases biases : {Biases::constant, Biases::time_varying}) {
    const SystemExample e = system_example(140, biases);
    const Dense d = dense(e);
    const MatrixXd follows = sensitivity(d);
    const auto bias_columns = bias_parameters(e.layout);
    const MatrixXd scores = InsSystem(e.problem, e.layout, e.x, {}, 1).scores(2.0).blocks;
    ASSERT_EQ(scores.rows(), 7);
    const auto gradients = InsLinearisation(e.problem, e.layout, e.x).gradients({0, e.problem.grid.intervals});
    for (Index block = 0; block < scores.rows(); ++block) {
      VectorXd expected = VectorXd::Zero(e.layout.global_parameters);
      for (Index k = 20 * block; k < 20 * (block + 1); ++k) {
        const IntervalGradient& g = gradients[static_cast<std::size_t>(k)];
        const Index first_bias = d.bias_process + e.layout.bias_process * time_segment_at(e.problem.grid, k);
        expected += g.border - follows.middleRows(k * e.layout.spline_dimensions, g.band.size()).transpose() * g.band -
                    follows.middleRows(first_bias, e.layout.bias_process).transpose() * g.border(bias_columns);
      }
      EXPECT_LT((scores.row(block).transpose() - expected).norm(), 1e-6 * expected.norm());
    }
  }
}

TEST(InsSystem, PriorsAppearInTheGlobalParameters) {
  const SystemExample e = system_example(300, Biases::time_varying);
  const Dense d = dense(e);
  const MatrixXd follows = sensitivity(d).middleRows(d.bias_process, e.x.bias_process.size());
  const MatrixXd expected = transposed_times(follows, product(d.bias_process_prior, follows)) +
                            global_parameter_prior(e.problem, e.layout, e.x).matrix;
  const MatrixXd priors = InsSystem(e.problem, e.layout, e.x, {}, 1).scores(2.0).priors;
  EXPECT_LT((priors - expected).norm(), 1e-7 * expected.norm());
}

TEST(InsSystem, GlobalParametersMayBeHeldWhileTheSplinesAreSolvedFor) {
  const SystemExample e = system_example(150, Biases::time_varying);
  const Dense d = dense(e);
  const auto expected = solve_spd(d.matrix.topLeftCorner(d.bias_process, d.bias_process), d.right.head(d.bias_process));
  for (const double most_kept : {1e9, 0.0}) {
    const auto step = InsSystem(e.problem, e.layout, e.x, {.holds_global_parameters = true}, 2, most_kept).solve();
    ASSERT_TRUE(step && expected);
    EXPECT_LT((step->spline_coefficients.reshaped() - *expected).norm(), 1e-8 * expected->norm());
    EXPECT_EQ(step->border, VectorXd::Zero(e.layout.global_parameters));
    EXPECT_EQ(step->bias_process, MatrixXd::Zero(e.layout.bias_process, 2));
  }
}

TEST(InsSystem, SolvesTheSameWithoutStoredFactors) {
  const SystemExample e = system_example(150, Biases::time_varying);
  const Damping damping{.band = 0.01, .border = 0.1};
  const InsSystem stored(e.problem, e.layout, e.x, damping, 2), recomputed(e.problem, e.layout, e.x, damping, 2, 0.0);
  const auto a = stored.solve(), b = recomputed.solve();
  ASSERT_TRUE(a && b);
  EXPECT_LT((a->spline_coefficients - b->spline_coefficients).norm(), 1e-9 * a->spline_coefficients.norm());
  EXPECT_LT((a->bias_process - b->bias_process).norm(), 1e-9 * a->bias_process.norm());
  EXPECT_LT((stored.scores(2.0).blocks - recomputed.scores(2.0).blocks).norm(),
            1e-9 * stored.scores(2.0).blocks.norm());
}

TEST(InsSystem, IsTheSameForAnyNumberOfThreads) {
  const SystemExample e = system_example(200, Biases::time_varying);
  const auto solved = [&](int threads) {
    const InsSystem system(e.problem, e.layout, e.x, {}, threads, 0.0);
    return std::pair{system.solve()->spline_coefficients, system.scores(2.0).blocks};
  };
  const auto one = solved(1);
  for (const int threads : {2, 7}) {
    const auto more = solved(threads);
    EXPECT_TRUE(one.first == more.first);
    EXPECT_TRUE(one.second == more.second);
  }
}

}  // namespace
}  // namespace kinfer
