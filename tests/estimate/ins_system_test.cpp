#include "kinfer/estimate/ins_system.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "support/random.hpp"

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

/// A turn on a root that moves, and readings that say anything.
struct Example {
  InsProblem problem;
  InsUnknowns x;
  InsLayout layout;
};

Example example(Index intervals) {
  Rng rng(7);
  Example e;
  e.problem.grid = {.begin = 0.0, .period = 0.1, .intervals = intervals};
  e.problem.root_stands_still = false;
  e.problem.prior = {0.1, 0.1, 0.1, 0.01, 0.01};
  for (int s = 0; s < 2; ++s)
    e.problem.sensors.push_back({random_blocks(intervals, rng), random_blocks(intervals, rng), {}, {}, {}});
  e.x.bodies = {{.sensor = 0}, turning_body(0, 1, exp_so3(random_vector(rng)), exp_so3(random_vector(rng)))};
  e.x.bodies.back().point_in_child = random_vector(rng);
  e.x.errors.resize(2);
  e.x.band = MatrixXd(7, e.problem.grid.coefficients());
  for (double& value : e.x.band.reshaped()) value = 0.1 * rng.normal();
  e.layout = layout_of(e.problem, e.x.bodies);
  return e;
}

/// All equations in one matrix, interval by interval.
struct Dense {
  MatrixXd matrix;
  VectorXd right;
};

Dense dense(const Example& e) {
  const Index band = e.layout.channels * e.problem.grid.coefficients(), all = band + e.layout.border,
              local = spline_order * e.layout.channels;
  Dense d{MatrixXd::Zero(all, all), VectorXd::Zero(all)};
  const BorderPrior prior = border_prior(e.problem, e.layout, e.x);
  BorderSum border{prior.matrix, prior.right};
  const IntervalLinearisation linearisation(e.problem, e.layout, e.x);
  for (Index k = 0; k < e.problem.grid.intervals; ++k) {
    const BandSpan span = linearisation.span(k, border);
    const Index at = k * e.layout.channels;
    d.matrix.block(at, at, local, local).triangularView<Eigen::Lower>() += span.matrix;
    d.matrix.block(band, at, e.layout.border, local) += span.coupling;
    d.right.segment(at, local) += span.right;
  }
  d.matrix.bottomRightCorner(e.layout.border, e.layout.border).triangularView<Eigen::Lower>() = border.matrix;
  d.right.tail(e.layout.border) = border.right;
  d.matrix.triangularView<Eigen::StrictlyUpper>() = d.matrix.transpose();
  return d;
}

TEST(InsSystem, SolvesTheEquationsOfAllIntervalsTogether) {
  for (const Index intervals : {5, 64, 150}) {
    const Example e = example(intervals);
    const Dense d = dense(e);
    const auto expected = solve_positive(d.matrix, d.right);
    const auto x = InsSystem(e.problem, e.layout, e.x, {}, 1).solve();
    ASSERT_TRUE(x && expected);
    const Index band = x->band.size();
    EXPECT_LT((x->band.reshaped() - expected->head(band)).norm(), 1e-7 * expected->norm());
    EXPECT_LT((x->border - expected->tail(e.layout.border)).norm(), 1e-7 * expected->norm());
  }
}

TEST(InsSystem, BlockScoresAreGradientsWithTheBandFollowing) {
  const Example e = example(140);
  const Dense d = dense(e);
  const Index band = e.layout.channels * e.problem.grid.coefficients();
  const MatrixXd following =
      *inverse_positive(d.matrix.topLeftCorner(band, band)) * d.matrix.topRightCorner(band, e.layout.border);
  const MatrixXd scores = InsSystem(e.problem, e.layout, e.x, {}, 1).block_scores(20);
  ASSERT_EQ(scores.rows(), 7);
  const IntervalLinearisation linearisation(e.problem, e.layout, e.x);
  for (Index block = 0; block < scores.rows(); ++block) {
    VectorXd expected = VectorXd::Zero(e.layout.border);
    for (Index k = 20 * block; k < 20 * (block + 1); ++k) {
      const IntervalGradient g = linearisation.gradient(k);
      expected += g.border - following.middleRows(k * e.layout.channels, g.band.size()).transpose() * g.band;
    }
    EXPECT_LT((scores.row(block).transpose() - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(InsSystem, TellsTheSameWhereItKeepsNothing) {
  const Example e = example(150);
  const Damping damping{.band = 0.01, .border = 0.1};
  const InsSystem kept(e.problem, e.layout, e.x, damping, 2), lean(e.problem, e.layout, e.x, damping, 2, 0.0);
  const auto a = kept.solve(), b = lean.solve();
  ASSERT_TRUE(a && b);
  EXPECT_LT((a->band - b->band).norm(), 1e-9 * a->band.norm());
  EXPECT_LT((kept.block_scores(20) - lean.block_scores(20)).norm(), 1e-9 * kept.block_scores(20).norm());
}

TEST(InsSystem, IsTheSameForAnyNumberOfThreads) {
  const Example e = example(200);
  const auto told = [&](int threads) {
    const InsSystem system(e.problem, e.layout, e.x, {}, threads, 0.0);
    return std::pair{system.solve()->band, system.block_scores(20)};
  };
  const auto one = told(1);
  for (const int threads : {2, 7}) {
    const auto more = told(threads);
    EXPECT_TRUE(one.first == more.first);
    EXPECT_TRUE(one.second == more.second);
  }
}

}  // namespace
}  // namespace kinfer
