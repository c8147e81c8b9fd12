// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/bordered_band.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

struct Problem {
  Index width, reach, border, spans;
  std::vector<BandSpan> parts;
  MatrixXd whole, border_matrix;  // the whole system, dense
  VectorXd right, border_right;
  Index band() const { return (spans + reach - 1) * width; }
};

MatrixXd random_border(Index rows, Index cols, Rng& rng) {
  MatrixXd m(rows, cols);
  for (double& value : m.reshaped()) value = rng.normal();
  return m;
}

Problem random_problem(Index width, Index reach, Index border, Index spans, Rng rng) {
  Problem p{width, reach, border, spans, {}, {}, MatrixXd::Zero(border, border), {}, VectorXd::Zero(border)};
  const Index local = width * reach, all = p.band() + border;
  p.whole = MatrixXd::Zero(all, all);
  p.right = VectorXd::Zero(all);
  for (Index k = 0; k < spans; ++k) {
    const MatrixXd j = random_border(3 * local, local + border, rng);
    const VectorXd r = random_border(3 * local, 1, rng);
    const MatrixXd h = j.transpose() * j;
    const VectorXd g = j.transpose() * r;
    p.parts.push_back({h.topLeftCorner(local, local), h.bottomLeftCorner(border, local), g.head(local)});
    p.border_matrix += h.bottomRightCorner(border, border);
    p.border_right += g.tail(border);
    const Index at = k * width;
    p.whole.block(at, at, local, local) += h.topLeftCorner(local, local);
    p.whole.block(p.band(), at, border, local) += h.bottomLeftCorner(border, local);
    p.whole.block(at, p.band(), local, border) += h.topRightCorner(local, border);
    p.right.segment(at, local) += g.head(local);
  }
  p.whole.bottomRightCorner(border, border) = p.border_matrix;
  p.right.tail(border) = p.border_right;
  return p;
}

BorderedBand eliminated(const Problem& p) {
  BorderedBand band(p.width, p.reach, p.border);
  for (const BandSpan& part : p.parts) band.add(part);
  band.finish(p.border_matrix, p.border_right);
  return band;
}

TEST(BorderedBand, SolvesWhatADenseCholeskySolves) {
  for (const auto& [width, reach, border] : {std::array<Index, 3>{3, 6, 7}, {1, 6, 0}, {2, 1, 4}, {1, 1, 1}}) {
    const Problem p = random_problem(width, reach, border, 9, Rng(static_cast<std::uint64_t>(reach)));
    const auto x = eliminated(p).solve();
    ASSERT_TRUE(x);
    const VectorXd dense = *solve_spd(p.whole, p.right);
    EXPECT_LT((x->band.reshaped() - dense.head(p.band())).norm(), 1e-9 * dense.norm());
    EXPECT_LT((x->border - dense.tail(border)).norm(), 1e-9 * dense.norm());
  }
}

TEST(BorderedBand, SchurComplementIsTheInverseOfTheBordersCovariance) {
  const Problem p = random_problem(2, 4, 5, 8, Rng(3));
  const BorderedBand band = eliminated(p);
  const MatrixXd covariance = invert_spd(p.whole)->bottomRightCorner(5, 5);
  EXPECT_LT((band.schur() * covariance - MatrixXd::Identity(5, 5)).norm(), 1e-9);
  const MatrixXd a = p.whole.topLeftCorner(p.band(), p.band()), b = p.whole.bottomLeftCorner(5, p.band());
  EXPECT_LT((a * band.sensitivity() - b.transpose()).norm(), 1e-9 * b.norm());
}

TEST(BorderedBand, ConditionalCovarianceIsABlockOfTheInverse) {
  const Problem p = random_problem(3, 2, 4, 6, Rng(5));
  const BorderedBand band = eliminated(p);
  const MatrixXd inverse = *invert_spd(p.whole.topLeftCorner(p.band(), p.band()));
  for (Index k = 0; k < p.band() / 3; ++k)
    EXPECT_LT((band.conditional_covariance(k) - inverse.block(3 * k, 3 * k, 3, 3)).norm(), 1e-9 * inverse.norm());
}

TEST(BorderedBand, ReportsWhereAPivotIsNotPositive) {
  Problem p = random_problem(2, 3, 2, 5, Rng(4));
  p.parts[2].matrix -= 1e3 * MatrixXd::Identity(6, 6);
  EXPECT_FALSE(eliminated(p).is_positive_definite());
  EXPECT_FALSE(eliminated(p).solve());
}

}  // namespace
}  // namespace kinfer
