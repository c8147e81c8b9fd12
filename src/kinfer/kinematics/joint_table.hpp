// One machine in several conventions: axes in space, and the MDH and DH rows that follow from them.
#pragma once

#include <optional>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

/// The line of a joint in the world at zero readings; its twist is (direction, point × direction), or (0, direction)
/// where it slides.
struct AxisLine {
  Vec3 point = Vec3::Zero();  ///< [m] nearest to the world's origin
  Vec3 direction = Vec3::UnitZ();
  bool slides = false;
};

/// Of the moving joints from the base to the tip, in order.
std::vector<AxisLine> axis_lines(const Chain& chain);

/// Within 2°, either sense: there the common perpendicular is ill defined, and Hayati's angle takes its place.
bool nearly_parallel(const AxisLine& a, const AxisLine& b);

/// Foot on line a of the common perpendicular with b, which must not be parallel.
Vec3 foot_on(const AxisLine& a, const AxisLine& b);

/// True where each moving joint on the way to the tip has a reading of its own and no coupling.
bool is_straight(const Chain& chain);

/// The same machine with MDH rows (Craig): same tool poses for all readings. Base and tool take what lies before the
/// first axis and behind the last. Fixed joints are folded away, and so are masses. Nothing for a chain that is not
/// straight.
std::optional<Chain> as_mdh(const Chain& chain);

/// Likewise with standard DH rows.
std::optional<Chain> as_dh(const Chain& chain);

}  // namespace kinfer
