// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/link_cost.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "identify/example_machine.hpp"
#include "kinfer/identify/programming/link_block.hpp"
#include "support/naive_genome.hpp"

namespace kinfer {
using namespace identify;
namespace {

using test::all_rows;
using test::general_hinge;
using test::swinging_parent;
using test::wave;

constexpr double infinite = std::numeric_limits<double>::infinity();

DhTree tree_of(const std::vector<DhLeaf>& leaves) {
  DhTree tree{{TreeNode<DhLeaf>{leaves.front()}}};
  for (std::size_t i = 1; i < leaves.size(); ++i) tree = product(tree, DhTree{{TreeNode<DhLeaf>{leaves[i]}}});
  return tree;
}

/// Position by composing poses: its second differences are the reference of the recursion.
TEST(LinkMotion, AccelerationsAreSecondDifferencesOfPositions) {
  const JointSignal swing = wave(0.5, 0.7, 0.3), hinge = wave(0.6, 0.9, 1.0);
  const auto parent = swinging_parent(swing);
  const auto child = propagate(parent, general_hinge(), {&hinge, 1});
  const auto position = [&](double t) {
    const double w1 = 2.0 * 3.14159265358979323846 * 0.7, w2 = 2.0 * 3.14159265358979323846 * 0.9;
    const std::vector<DhLeaf> base{{.alpha = 0.4}, {.a = -1.3, .theta_signal = 0}};
    const double q1 = 0.5 * std::sin(w1 * t + 0.3), q2 = 0.6 * std::sin(w2 * t + 1.0);
    return (transform(base, std::vector{q1}) * transform(general_hinge(), std::vector{q2})).position;
  };
  constexpr double h = 1e-4;
  for (const std::size_t row : {10u, 123u, 400u}) {
    const double t = 0.01 * static_cast<double>(row);
    const Vec3 expected = (position(t + h) - 2.0 * position(t) + position(t - h)) / (h * h);
    EXPECT_LT((child[row].acceleration - expected).norm(), 1e-5 * (1.0 + expected.norm()));
  }
}

TEST(LinkCost, IsZeroAtTheTruthAndAgreesWithTheReferenceElsewhere) {
  const JointSignal swing = wave(0.5, 0.7, 0.3), hinge = wave(0.6, 0.9, 1.0);
  const auto parent = swinging_parent(swing);
  const auto child = propagate(parent, general_hinge(), {&hinge, 1});
  for (const OrientationMetric orientation : {OrientationMetric::chord, OrientationMetric::euler}) {
    const auto rows = thin_rows(all_rows(600), 150);  // not a multiple of the blocks
    const LinkCost cost(parent, child, {&hinge, 1}, rows, {.orientation = orientation});
    EXPECT_LT(cost.j_rmse(general_hinge()).total, 1e-7);
    DhBreed breed(DhLeafOperators({}), {});
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      const auto guess = leaves(breed.random(Rng(seed)));
      const JRmse slow = j_rmse(propagate(parent, guess, {&hinge, 1}), child, rows, orientation),
                  fast = cost.j_rmse(guess);
      EXPECT_NEAR(fast.acceleration, slow.acceleration, 1e-9 * slow.acceleration);
      EXPECT_NEAR(fast.orientation, slow.orientation, 1e-9 * slow.orientation);
    }
  }
}

TEST(LinkCost, StopsEarlyOnlyAboveTheBound) {
  const JointSignal swing = wave(0.5, 0.7, 0.3), hinge = wave(0.6, 0.9, 1.0);
  const auto parent = swinging_parent(swing);
  const auto child = propagate(parent, general_hinge(), {&hinge, 1});
  const LinkCost cost(parent, child, {&hinge, 1}, all_rows(600), {});
  auto guess = general_hinge();
  guess[1].a += 0.1;
  const double value = cost(tree_of(guess), infinite);
  EXPECT_EQ(cost(tree_of(guess), value * 1.001), value);
  EXPECT_EQ(cost(tree_of(guess), value * 0.999), infinite);
}

TEST(LinkCost, PrefersTheShorterOfTwoEqualChainsAndRefusesAChainWithoutSignal) {
  const JointSignal swing = wave(0.5, 0.7, 0.3), hinge = wave(0.6, 0.9, 1.0);
  const auto parent = swinging_parent(swing);
  const auto child = propagate(parent, general_hinge(), {&hinge, 1});
  const LinkCost cost(parent, child, {&hinge, 1}, all_rows(600), {});
  auto guess = general_hinge(), longer = guess;
  guess[0].a += 0.1;
  longer[0].a += 0.1;
  longer.push_back({});
  EXPECT_LT(cost(tree_of(guess), infinite), cost(tree_of(longer), infinite));
  EXPECT_EQ(cost(tree_of({{.a = 1.0}}), infinite), infinite);
}

TEST(LinkBlock, AgreesWithProductsOf4x4MatricesAndDifferences) {
  constexpr double h = 1e-3, w = 2.0 * 3.14159265358979323846;
  const JointSignal swing = wave(0.5, 0.7, 0.3), hinge = wave(0.6, 0.9, 1.0);
  const auto parent = swinging_parent(swing);
  const auto child = propagate(parent, general_hinge(), {&hinge, 1});
  std::vector<test::NaiveSample> samples;
  for (std::size_t row = 0; row < 600; ++row) {
    test::NaiveSample s{{}, {}, child[row].acceleration, child[row].rotation};
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = 0.01 * static_cast<double>(row) + (static_cast<double>(k) - 1.0) * h;
      s.q[k] = 0.6 * std::sin(w * 0.9 * t + 1.0);
      s.parent[k] = test::naive_leaf({.alpha = 0.4}, 0.0) *
                    test::naive_leaf({.a = -1.3, .theta_signal = 0}, 0.5 * std::sin(w * 0.7 * t + 0.3));
    }
    samples.push_back(s);
  }
  auto guess = general_hinge();
  guess[0].a += 0.3;
  guess[1].theta -= 0.2;
  double fast = 0.0;
  for (const LinkBlock& block : make_link_blocks(parent, child, {&hinge, 1}, all_rows(600))) {
    const FrameLanes state = block.propagate(guess);
    fast += block.squared_acceleration_error(state) + block.squared_chord(state);
  }
  const double slow = test::naive_square(samples, guess, h);
  EXPECT_NEAR(fast, slow, 1e-4 * slow);  // error of second differences over a millisecond
}

TEST(EulerAngles, AreThoseOfYawPitchRollAndHaveASecondSolution) {
  const Vec3 angles(0.3, -1.2, 2.5);
  const Mat3 rotation = rot_z(angles.z()) * rot_y(angles.y()) * rot_x(angles.x());
  EXPECT_LT((euler_angles(rotation) - angles).norm(), 1e-12);
  const Vec3 other = alternative_euler_angles(angles);
  EXPECT_LT((rot_z(other.z()) * rot_y(other.y()) * rot_x(other.x()) - rotation).norm(), 1e-12);
}

}  // namespace
}  // namespace kinfer
