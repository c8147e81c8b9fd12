// SPDX-License-Identifier: Apache-2.0
// Segment trees with known pairs, without a recording.
#pragma once

#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::test {
using namespace identify;

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

/// A pair that rotates about one axis at 0.5 rad/s.
inline PairFit revolute_pair(std::size_t first, std::size_t second, double residual) {
  PairFit pair{.first = first, .second = second};
  pair.acceleration = residual * residual / 3.0 * Mat3::Identity();
  pair.angular_velocity = Vec3(1e-6, 1e-6, 0.25).asDiagonal();
  return pair;
}

/// A pair whose relative rotation has no preferred axis.
inline PairFit unrelated_pair(std::size_t first, std::size_t second, double residual) {
  PairFit pair = revolute_pair(first, second, residual);
  pair.angular_velocity = 0.25 * Mat3::Identity();
  return pair;
}

/// Revolute joints with a residual of 0.01 m/s² and a distance of 1 nat; all other pairs are unrelated, at 3 nats.
inline SegmentTree hand_made_tree(std::size_t segments, const Edges& edges, std::size_t root = 0) {
  SegmentTree tree;
  tree.root = root;
  for (std::size_t first = 0; first < segments; ++first)
    for (std::size_t second = first + 1; second < segments; ++second) {
      tree.pairs.push_back(unrelated_pair(first, second, 2.0));
      tree.pairs.back().distance = 3.0;
    }
  orient_tree(tree, edges);
  for (PairFit& pair : tree.pairs) {
    if (!is_edge(tree, pair.first, pair.second)) continue;
    pair = revolute_pair(pair.first, pair.second, 0.01);
    pair.distance = 1.0;
  }
  return tree;
}

/// Edges of a chain 0-1-2-…
inline Edges serial_edges(std::size_t segments) {
  Edges edges;
  for (std::size_t i = 0; i + 1 < segments; ++i) edges.emplace_back(i, i + 1);
  return edges;
}

inline PairFit& pair_of(SegmentTree& tree, std::size_t first, std::size_t second) {
  return *std::ranges::find_if(tree.pairs, [&](const PairFit& p) { return p.first == first && p.second == second; });
}

inline void replace_pair(SegmentTree& tree, const PairFit& pair) {
  const double distance = pair_of(tree, pair.first, pair.second).distance;
  pair_of(tree, pair.first, pair.second) = pair;
  pair_of(tree, pair.first, pair.second).distance = distance;
}

/// The tree with segments s0, s1, … that have no motion.
inline OrderedMotion ordered_by(SegmentTree tree) {
  OrderedMotion ordered;
  for (std::size_t i = 0; i < tree.parent.size(); ++i)
    ordered.motion.segments.push_back({.name = "s" + std::to_string(i),
                                       .rotation = {},
                                       .gyro = {},
                                       .angular_velocity = {},
                                       .angular_acceleration = {},
                                       .acceleration = {}});
  ordered.tree = std::move(tree);
  return ordered;
}

}  // namespace kinfer::test
