// SPDX-License-Identifier: Apache-2.0
// Whether two segments share a joint at all: a permutation test (Fisher 1935) of the pair fit.
//
// Points, biases and a heading can be fitted to any two recordings; what they leave is judged by what they leave of
// recordings that have certainly nothing to do with each other. These are the same two, the second shifted in time by
// several seconds (circularly): a shift destroys every connection and keeps both spectra, the excitation and the
// freedom of the fit. The gain is the code length (pair_fit.hpp) of the shifted pair, median over several shifts, minus
// that of the pair as recorded. Beside a segment that does not move a shift changes nothing; there the null hypothesis
// is that nothing is known of the other one's motion but its size.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/evidence/identification/joint_verdict.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::identify {

/// Connection of a pair in one part of the recording.
struct PartConnection {
  double begin = 0.0, end = 0.0;  ///< [s]
  JointConnection connection{};
  double length = 0.0;  ///< [nats per row] code length of what a joint leaves
};

struct PairConnection {
  std::size_t parent = 0, child = 0;
  JointConnection whole{};
  double length = 0.0;                   ///< [nats per row] likewise, of the whole recording
  std::vector<PartConnection> halves{};  ///< of the moving part; empty if it is too short
  std::vector<PartConnection> parts{};   ///< up to six equal ones, where the whole is not a strong connection
};

PairConnection pair_connection(const RecordedMotion& motion, std::size_t parent, std::size_t child);

/// Of each link of the tree, in its order.
std::vector<PairConnection> tree_connections(const RecordedMotion& motion, const SegmentTree& tree, int threads);

/// How certain the evidence of a connection is.
enum class ConnectionStrength {
  none,      ///< not better than recordings that are not connected
  weak,      ///< better, but by less than a joint usually is
  strong,    ///< as good as a joint
  unexcited  ///< the shifted recordings fit as well, since hardly anything moves: no evidence for or against it
};
ConnectionStrength strength_of(const JointConnection& connection);

/// The part of the recording in which alone the pair is connected: elsewhere there was something to explain and no
/// connection. Two recordings were mixed, or a sensor came off its segment. None if there is no such part.
std::optional<PartConnection> only_connected_part(const PairConnection& pair);

/// Whether each half of the recording by itself is explained much better than both together: by two different joints.
/// By what a joint leaves, and not only by what is explained of shifted recordings: those of a machine that slews
/// steadily are explained better the longer they are.
bool has_changed(const PairConnection& pair);

}  // namespace kinfer::identify
