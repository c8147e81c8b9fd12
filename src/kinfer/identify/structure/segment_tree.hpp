// SPDX-License-Identifier: Apache-2.0
// Segment tree: the minimum spanning tree over pairwise fits of a common point (PairFit).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/identify/structure/pair_fit.hpp"

namespace kinfer::identify {

/// A tree of segments; parents before children in `order`.
struct SegmentTree {
  std::size_t root = 0;
  std::vector<std::size_t> order;                  ///< segments, root first
  std::vector<std::optional<std::size_t>> parent;  ///< of each segment; none for the root
  std::vector<PairFit> pairs;                      ///< all pairs, sorted by first, then second
  /// Smallest factor by which the unexplained motion per row grows if a pair outside the tree replaces a pair on its
  /// path: exp of the difference of their distances.
  double margin = 0.0;

  const PairFit& pair(std::size_t a, std::size_t b) const;
};

/// `root`: a segment's name; by default the stationary one, else the leaf of the tree that rotates least. An error for
/// an unknown name, or if several segments are stationary.
Result<SegmentTree> segment_tree(const RecordedMotion& motion, const std::optional<std::string>& root = {},
                                 HeadingReference headings = HeadingReference::arbitrary, int threads = 0);

/// The rows that pairs are fitted on: usable, evenly spaced, after the machine begins to move.
std::vector<std::size_t> moving_rows(const RecordedMotion& motion);

/// [nats per row] Sum of the distances of the minimum spanning tree.
double spanning_length(const std::vector<PairFit>& pairs, std::size_t segments);

/// Whether the two segments are joined in the tree.
bool is_edge(const SegmentTree& tree, std::size_t a, std::size_t b);

/// Edges of the path from one segment to another within the tree.
std::vector<std::pair<std::size_t, std::size_t>> path_between(const SegmentTree& tree, std::size_t a, std::size_t b);

/// exp of the smallest difference of distances between a pair outside the tree and the worst pair on the path that it
/// closes. `closes_loop`: pairs that are additional joints, and are excluded.
double margin_of(const SegmentTree& tree, const std::vector<PairFit>& closes_loop = {});

/// Sets order and parents of the tree from these edges and its `root`.
void orient_tree(SegmentTree& tree, const std::vector<std::pair<std::size_t, std::size_t>>& edges);

}  // namespace kinfer::identify
