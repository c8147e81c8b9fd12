// Which segment hangs on which: the minimum spanning tree over pairwise fits of a common point (identify/pair_fit.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/identify/pair_fit.hpp"

namespace kinfer {

/// A tree of segments; parents before children in `order`.
struct SegmentTree {
  std::size_t root = 0;
  std::vector<std::size_t> order;                  ///< segments, root first
  std::vector<std::optional<std::size_t>> parent;  ///< of each segment; nothing for the root
  std::vector<PairFit> pairs;                      ///< of all pairs, by first, then second
  /// How many times larger a pair off the tree makes what is left unexplained, per row, than the pair on its path that
  /// it could replace, at least: exp of the difference of their distances.
  double margin = 0.0;

  const PairFit& pair(std::size_t a, std::size_t b) const;
};

/// `root`: a segment's name; without it the one that stands still, else the leaf of the tree that turns least. An error
/// for an unknown name, and where several segments stand still.
Result<SegmentTree> segment_tree(const RecordedMotion& motion, const std::optional<std::string>& root = {},
                                 const PairFitOptions& options = {}, int threads = 0);

/// Edges on the way from one segment to another within the tree.
std::vector<std::pair<std::size_t, std::size_t>> path_between(const SegmentTree& tree, std::size_t a, std::size_t b);

/// exp of the least difference of distances between a pair off the tree and the worst on the path that it would close;
/// `closes_loop` pairs apart, which are joints in addition.
double margin_of(const SegmentTree& tree, const std::vector<PairFit>& closes_loop = {});

/// The tree with these edges, hung up at `root`: order and parents.
void hang_up(SegmentTree& tree, const std::vector<std::pair<std::size_t, std::size_t>>& edges);

}  // namespace kinfer
