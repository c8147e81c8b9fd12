// SPDX-License-Identifier: Apache-2.0
// Search for one link by bacterial programming: a tree of DH leaves appended to the frozen chain (paper 1, section IV).
#pragma once

#include "kinfer/identify/programming/link_cost.hpp"
#include "kinfer/search/evolution/bacterial_programming.hpp"

namespace kinfer::identify {

/// Bacterial programming as in paper 1.
struct BacterialProgramming {
  /// Relative rotations have an arbitrary zero, so an offset is allowed; Euler angles are taken as they are.
  JointVariableKind terminals = JointVariableKind::hinge;
  BacterialOptions bacteria{};
  DepthLimits depth{};
  int rows = default_link_rows;  ///< samples in eq. (20), evenly spaced; more samples average out more noise
};

/// How the orientations are compared in eq. (20).
OrientationMetric orientation_metric(JointVariableKind terminals);

using LinkEvolution = EvolutionOutcome<DhTree>;

/// The informative rows of a link: all sensors valid and the child in motion. With Euler angles, rows within 6° of
/// gimbal lock are excluded, too.
std::vector<std::size_t> informative_rows(const RecordedMotion& motion, std::size_t parent, std::size_t child,
                                          JointVariableKind terminals);

/// Searches the chain from the parent's sensor to the child's. `rows` are evenly thinned to options.rows.
LinkEvolution search_bacterial(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                               std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                               const BacterialProgramming& options, const Rng& rng, const Observer& observer = {});

}  // namespace kinfer::identify
