// SPDX-License-Identifier: Apache-2.0
#include "kinfer/linalg/band_segment.hpp"

#include <gtest/gtest.h>

#include "kinfer/base/rng.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

struct Parts {
  Index width, reach, border;
  std::vector<BandSpan> spans;
  MatrixXd border_matrix;
  VectorXd border_right;
};

MatrixXd random_matrix(Index rows, Index cols, Rng& rng) {
  MatrixXd m(rows, cols);
  for (double& value : m.reshaped()) value = rng.normal();
  return m;
}

Parts random_parts(Index width, Index reach, Index border, int spans, Rng rng) {
  Parts p{width, reach, border, {}, MatrixXd::Zero(border, border), VectorXd::Zero(border)};
  const Index local = width * reach;
  for (int k = 0; k < spans; ++k) {
    const MatrixXd j = random_matrix(3 * local, local + border, rng);
    const MatrixXd h = j.transpose() * j;
    const VectorXd g = random_matrix(local + border, 1, rng);
    p.spans.push_back({h.topLeftCorner(local, local), h.bottomLeftCorner(border, local), g.head(local)});
    p.border_matrix += h.bottomRightCorner(border, border);
    p.border_right += g.tail(border);
  }
  return p;
}

BorderedBand in_one_pass(const Parts& p) {
  BorderedBand band(p.width, p.reach, p.border);
  for (const BandSpan& span : p.spans) band.add(span);
  band.finish(p.border_matrix, p.border_right);
  return band;
}

std::vector<BandSegment> cut(const Parts& p, std::vector<std::size_t> lengths) {
  std::vector<BandSegment> segments;
  std::size_t at = 0;
  for (const std::size_t length : lengths) {
    BandSegmentSum sum(p.width, p.reach, p.border, static_cast<Index>(length));
    for (Index k = 0; k < static_cast<Index>(length); ++k) sum.add(k, p.spans[at++]);
    segments.emplace_back(std::move(sum));
  }
  return segments;
}

BorderedBand joined(const Parts& p, const std::vector<BandSegment>& segments) {
  BorderedBand ends((p.reach - 1) * p.width, 2, p.border);
  MatrixXd matrix = p.border_matrix;
  VectorXd right = p.border_right;
  for (const BandSegment& segment : segments) {
    ends.add(segment.condensed(), segment.is_positive_definite());
    matrix += segment.border_matrix();
    right += segment.border_right();
  }
  ends.finish(matrix, right);
  return ends;
}

struct Case {
  Index width, reach, border;
  std::vector<std::size_t> lengths;
};

class BandSegments : public testing::TestWithParam<Case> {};

TEST_P(BandSegments, TogetherSolveWhatOnePassAlongTheBandSolves) {
  const auto& [width, reach, border, lengths] = GetParam();
  std::size_t spans = 0;
  for (const std::size_t length : lengths) spans += length;
  const Parts p = random_parts(width, reach, border, static_cast<int>(spans), Rng(spans));
  const BorderedBand band = in_one_pass(p);
  const auto whole = band.solve();
  const auto segments = cut(p, lengths);
  const BorderedBand ends = joined(p, segments);
  const auto at_ends = ends.solve();
  ASSERT_TRUE(whole && at_ends);
  EXPECT_LT((at_ends->border - whole->border).norm(), 1e-9 * (1.0 + whole->border.norm()));
  const MatrixXd sensitivity = band.sensitivity(), ends_following = ends.sensitivity();
  const Index end = (reach - 1) * width;
  Index group = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const MatrixXd inner = segments[i].solve(at_ends->band.col(k), at_ends->band.col(k + 1), at_ends->border);
    EXPECT_LT((whole->band.middleCols(group, reach - 1).reshaped() - at_ends->band.col(k)).norm(), 1e-9);
    EXPECT_LT((whole->band.middleCols(group + reach - 1, inner.cols()) - inner).norm(), 1e-9);
    const MatrixXd follows =
        segments[i].sensitivity(ends_following.middleRows(k * end, end), ends_following.middleRows((k + 1) * end, end),
                                MatrixXd::Identity(border, border));
    EXPECT_LT((sensitivity.middleRows((group + reach - 1) * width, follows.rows()) - follows).norm(), 1e-9);
    group += static_cast<Index>(lengths[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Any, BandSegments,
                         testing::Values(Case{3, 6, 7, {9, 5, 12}}, Case{1, 6, 0, {5}}, Case{2, 3, 4, {2, 2, 7, 3}},
                                         Case{4, 2, 1, {1, 1, 6}}));

TEST(BandSegment, ThatIsNotPositiveMakesTheWholeBandNotPositive) {
  Parts p = random_parts(2, 3, 2, 9, Rng(4));
  p.spans[5].matrix -= 1e3 * MatrixXd::Identity(6, 6);
  const auto segments = cut(p, {3, 6});
  EXPECT_FALSE(segments.back().is_positive_definite());
  EXPECT_FALSE(joined(p, segments).is_positive_definite());
}

}  // namespace
}  // namespace kinfer
