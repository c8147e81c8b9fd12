// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/angle_start.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/example_machine.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/identify/programming/linear_columns.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::general_hinge;

std::vector<double> sampled_angles() {
  return test::wave(0.9, 0.9, 1.0, std::size_t{200}).angle;
}

RotationMoments moments_of(const std::vector<DhLeaf>& truth) {
  RotationMoments moments{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
  for (const double q : sampled_angles()) {
    const Mat3 r = transform(truth, std::vector{q}).rotation;
    moments[0] += r, moments[1] += std::cos(q) * r, moments[2] += std::sin(q) * r;
  }
  return moments;
}

std::vector<double*> all_angles(std::vector<DhLeaf>& leaves) {
  std::vector<double*> angles;
  for (DhLeaf& leaf : leaves) angles.insert(angles.end(), {&leaf.theta, &leaf.alpha});
  return angles;
}

/// Σ tr(R~ᵀ R) the long way.
double slow_agreement(const std::vector<DhLeaf>& truth, const std::vector<DhLeaf>& guess) {
  double sum = 0.0;
  for (const double q : sampled_angles())
    sum += (transform(guess, std::vector{q}).rotation.transpose() * transform(truth, std::vector{q}).rotation).trace();
  return sum;
}

std::vector<DhLeaf> perturbed_hinge(double size, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<DhLeaf> leaves = general_hinge();
  for (double* angle : all_angles(leaves)) *angle += size * rng.normal();
  return leaves;
}

TEST(AngleStart, FindsTheRotationsOfAJointFromFarAway) {
  const RotationMoments moments = moments_of(general_hinge());
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<DhLeaf> leaves = perturbed_hinge(0.8, seed);
    const double best = maximise_agreement(leaves, all_angles(leaves), moments, 1e-9);
    EXPECT_LE(best, 600.0 + 1e-6) << "three for each of 200 rows";
    EXPECT_NEAR(best, slow_agreement(general_hinge(), leaves), 1e-6) << seed;
    found += best > 600.0 - 1e-4 ? 1 : 0;
  }
  EXPECT_GE(found, 15) << "a few end in another maximum";
}

TEST(AngleStart, NeverGetsWorse) {
  const RotationMoments moments = moments_of(general_hinge());
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<DhLeaf> leaves = perturbed_hinge(3.0, seed);
    const double before = slow_agreement(general_hinge(), leaves);
    EXPECT_GE(maximise_agreement(leaves, all_angles(leaves), moments, 1e-9), before - 1e-9);
  }
}

TEST(AngleStart, LeavesWhatIsNotFreeAlone) {
  std::vector<DhLeaf> leaves = perturbed_hinge(0.2, 1);
  const std::vector<DhLeaf> before = leaves;
  const RotationMoments moments = moments_of(general_hinge());
  EXPECT_NEAR(maximise_agreement(leaves, {}, moments, 1e-9), slow_agreement(general_hinge(), before), 1e-9);
  maximise_agreement(leaves, {&leaves[0].theta}, moments, 1e-9);
  EXPECT_NE(leaves[0].theta, before[0].theta);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    EXPECT_EQ(leaves[i].alpha, before[i].alpha);
    EXPECT_EQ(leaves[i].d, before[i].d);
    EXPECT_TRUE(i == 0 || leaves[i].theta == before[i].theta);
  }
}

TEST(AngleStart, AcceptsASignalAboutEitherAxis) {
  const std::vector<DhLeaf> truth{{.theta = 0.4, .alpha = 0.9}, {.theta = -0.3, .alpha = 0.5, .alpha_signal = 0}};
  std::vector<DhLeaf> leaves = truth;
  for (double* angle : all_angles(leaves)) *angle += 0.3;
  EXPECT_NEAR(maximise_agreement(leaves, all_angles(leaves), moments_of(truth), 1e-10), 600.0, 1e-4);
}

struct ExampleLink {
  JointSignal hinge = test::wave(0.6, 0.9, 1.0, std::size_t{64});
  JointSignal swing = test::wave(0.5, 0.7, 0.3, std::size_t{64});
  std::vector<FrameState> parent = test::swinging_parent(swing);
  std::vector<FrameState> child = propagate(parent, general_hinge(), {&hinge, 1});
  std::vector<LinkBlock> blocks = make_link_blocks(parent, child, {&hinge, 1}, test::all_rows(64));
};

Vec3 lane(const Lanes3& lanes, std::size_t i) {
  return {lanes[0][i], lanes[1][i], lanes[2][i]};
}

TEST(LinkBlock, HoldsTheStatesOfThePlainRecursionInEveryLane) {
  const ExampleLink link;
  ASSERT_EQ(link.blocks.size(), 1U);
  const LinkBlock& block = link.blocks[0];
  DhBreed breed(DhLeafOperators({}), {});
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto guess = leaves(breed.random(Rng(seed)));
    const FrameLanes fast = block.propagate(guess);
    const auto slow = propagate(link.parent, guess, {&link.hinge, 1});
    for (const std::size_t row : {0U, 31U, 63U}) {
      EXPECT_LT((lane(fast.acceleration, row) - slow[row].acceleration).norm(), 1e-9);
      EXPECT_LT((lane(fast.angular_velocity, row) - slow[row].angular_velocity).norm(), 1e-12);
      EXPECT_LT((lane(fast.angular_acceleration, row) - slow[row].angular_acceleration).norm(), 1e-10);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LT((lane(fast.axes[k], row) - slow[row].rotation.col(static_cast<Eigen::Index>(k))).norm(), 1e-12);
    }
  }
}

TEST(LinkBlock, RowsAreSpreadOverTheBlocksAndCountOnce) {
  const JointSignal hinge = test::wave(0.6, 0.9, 1.0, std::size_t{150});
  const auto parent = test::swinging_parent(test::wave(0.5, 0.7, 0.3, std::size_t{150}));
  const auto blocks = make_link_blocks(parent, parent, {&hinge, 1}, test::all_rows(150));
  ASSERT_EQ(blocks.size(), 3U);
  double weight = 0.0;
  for (const LinkBlock& block : blocks)
    for (const double w : block.weight) weight += w;
  EXPECT_DOUBLE_EQ(weight, 150.0);
  EXPECT_EQ(make_link_blocks(parent, parent, {&hinge, 1}, {7}).size(), 1U) << "one row";
}

TEST(LinearColumns, AccelerationsAreLinearInTheLengths) {
  const ExampleLink link;
  std::vector<DhLeaf> with = general_hinge(), without = with;
  for (DhLeaf& leaf : without) leaf.d = leaf.a = 0.0;
  FrameLanes end;
  const std::vector<Lanes3> columns = linear_columns(link.blocks[0], with, end);
  ASSERT_EQ(columns.size(), 2 * with.size() + bias_count);
  const auto arms = propagate(link.parent, with, {&link.hinge, 1}),
             none = propagate(link.parent, without, {&link.hinge, 1});
  for (const std::size_t row : {0U, 20U, 63U}) {
    Vec3 sum = none[row].acceleration;
    for (std::size_t l = 0; l < with.size(); ++l)
      sum += with[l].d * lane(columns[2 * l], row) + with[l].a * lane(columns[2 * l + 1], row);
    EXPECT_LT((sum - arms[row].acceleration).norm(), 1e-10) << row;
    EXPECT_LT((lane(end.acceleration, row) - none[row].acceleration).norm(), 1e-10) << "the state without lengths";
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      EXPECT_LT((lane(columns[2 * with.size() + k], row) + link.parent[row].rotation.col(axis)).norm(), 1e-12);
      EXPECT_LT((lane(columns[2 * with.size() + 3 + k], row) - link.child[row].rotation.col(axis)).norm(), 1e-12);
    }
  }
}

TEST(LinearColumns, TheScalarProductCountsWeightedRowsOnly) {
  Lanes3 a, b;
  Lane weight{};
  for (std::size_t c = 0; c < 3; ++c) a[c].fill(2.0), b[c].fill(static_cast<double>(c) + 1.0);
  weight[3] = weight[40] = 1.0;
  EXPECT_DOUBLE_EQ(dot(a, b, weight), 2.0 * (2.0 * 1.0 + 2.0 * 2.0 + 2.0 * 3.0));
  EXPECT_DOUBLE_EQ(difference(a, b)[2][40], -1.0);
}

}  // namespace
}  // namespace kinfer
