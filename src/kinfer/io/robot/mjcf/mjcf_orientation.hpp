// SPDX-License-Identifier: Apache-2.0
// Orientations as MJCF writes them: one of five attributes, whose meaning depends on the file's <compiler>.
// Source: MuJoCo's XML reference, "Frame orientations".
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/rotation.hpp"

namespace kinfer {

/// How a file writes angles.
struct MjcfUnits {
  bool degrees = true;                 ///< angles of attributes, but not those of <equality>
  std::string euler_sequence = "xyz";  ///< small letters: about the moving axes; capital ones: about the fixed axes

  double angle() const { return degrees ? degree : 1.0; }  ///< [rad] of one unit
};

enum class MjcfOrientation { none, quat, axisangle, xyaxes, zaxis, euler };

struct MjcfOrientationTraits {
  MjcfOrientation kind;
  const char* attribute;
  std::size_t numbers;
};
inline constexpr std::array<MjcfOrientationTraits, 5> mjcf_orientations{{
    {MjcfOrientation::quat, "quat", 4},  // scalar first
    {MjcfOrientation::axisangle, "axisangle", 4},
    {MjcfOrientation::xyaxes, "xyaxes", 6},  // y is made perpendicular to x
    {MjcfOrientation::zaxis, "zaxis", 3},    // the smallest rotation that turns z into it
    {MjcfOrientation::euler, "euler", 3},
}};

/// Three letters of x, y, z in either case.
bool is_euler_sequence(std::string_view text);

/// The rotation of these numbers, as many as the kind has; none where they have no direction (zeros, parallel axes).
std::optional<Mat3> rotation_of(MjcfOrientation kind, std::span<const double> numbers, const MjcfUnits& units);

/// The numbers of the kind that mean R, of several possibilities those nearest to `like`; none where the kind cannot
/// hold R: a zaxis, or a sequence such as "xxy".
std::optional<std::vector<double>> numbers_of(MjcfOrientation kind, const Mat3& r, std::span<const double> like,
                                              const MjcfUnits& units);

}  // namespace kinfer
