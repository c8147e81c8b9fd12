// SPDX-License-Identifier: Apache-2.0
// Conversion of a chain to other conventions: joint axes in space, and the MDH and DH rows that follow from them.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// Axis of a joint in the world at q = 0; its twist is (direction, point × direction), or (0, direction) if prismatic.
struct AxisLine {
  Vec3 point = Vec3::Zero();  ///< [m] nearest to the world's origin
  Vec3 direction = Vec3::UnitZ();
  bool is_prismatic = false;
};

/// Axes of the moving joints from the base to the tip, in order.
std::vector<AxisLine> axis_lines(const Chain& chain);

/// Parallel or antiparallel within 2°: the common perpendicular is then ill defined, and Hayati's angle replaces it.
bool nearly_parallel(const AxisLine& a, const AxisLine& b);

/// Foot on line a of the common perpendicular with b, which must not be parallel.
Vec3 common_normal_foot(const AxisLine& a, const AxisLine& b);

/// True if each moving joint on the path to the tip is active and has no coupling.
bool is_serial_chain(const Chain& chain);

/// The same machine with MDH rows (Craig): same tool poses for all q. Base and tool absorb what lies before the first
/// axis and after the last. Fixed joints are merged, masses dropped. nullopt unless all are active and uncoupled.
std::optional<Chain> as_mdh(const Chain& chain);

/// Likewise with standard DH rows.
std::optional<Chain> as_dh(const Chain& chain);

}  // namespace kinfer
