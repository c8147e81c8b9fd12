// Which segment hangs on which: a spanning tree over pairwise fits of a common point.
//
// Two segments that share a joint share a point (its centre), whose acceleration both INS must agree on:
//   a_i + K_i r_i = a_j + K_j r_j,  K = skew(ω̇) + skew(ω)², in the ground.
// The lever arms r are linear in it. The residual is the pair's distance; neighbours have the small ones. Where several
// axes meet in one point (a wrist) residuals tie; then the pair that turns about one axis only is the nearer one.
// A pair that does not turn against each other may slide: what differs along one direction of its own then counts not.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/inertial/segment_motion.hpp"

namespace kinfer {

/// How well two segments share a point.
struct PairFit {
  std::size_t first = 0, second = 0;  ///< indices of segments, first < second
  double residual = 0.0;              ///< [m/s²] rms of the accelerations' difference after the fit, `slide` taken out
  double slide = 0.0;  ///< [m/s²] rms of the difference along one direction, if they do not turn against each other
  double off_axis_rate = 0.0;  ///< [rad/s] rms of the relative rate across its principal direction
  double relative_rate = 0.0;  ///< [rad/s] rms of all of it
  double weight = 0.0;         ///< residual · (1 + off_axis_weight · off-axis share of the relative rate)
  Vec3 point_in_first = Vec3::Zero(), point_in_second = Vec3::Zero();  ///< [m] the common point, as far as it shows
};

/// A tree of segments; parents before children in `order`.
struct SegmentTree {
  std::size_t root = 0;
  std::vector<std::size_t> order;                  ///< segments, root first
  std::vector<std::optional<std::size_t>> parent;  ///< of each segment; nothing for the root
  std::vector<PairFit> pairs;                      ///< of all pairs, by first, then second
  double margin = 0.0;  ///< least, over pairs off the tree, of its weight over the largest on the path that it closes

  const PairFit& pair(std::size_t a, std::size_t b) const;
};

constexpr double off_axis_weight = 4.0;  // a pair that turns about all axes alike looks about three times farther away

/// `root`: a segment's name; without it the one that stands still, else the leaf of the tree that turns least. An error
/// for an unknown name, and where several segments stand still.
Result<SegmentTree> segment_tree(const RecordedMotion& motion, const std::optional<std::string>& root = {});

/// The tree with these edges, hung up at `root`: order and parents.
void hang_up(SegmentTree& tree, const std::vector<std::pair<std::size_t, std::size_t>>& edges);

}  // namespace kinfer
