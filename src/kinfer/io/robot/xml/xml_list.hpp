// SPDX-License-Identifier: Apache-2.0
// Numbers of an XML attribute, separated by spaces, as URDF and MJCF want them.
#pragma once
#include <string>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/io/text/format_number.hpp"

namespace kinfer {

inline std::string xml_list(const Vec3& values) {
  return format_number(values.x()) + ' ' + format_number(values.y()) + ' ' + format_number(values.z());
}

/// Scalar first, as MJCF has it.
inline std::string xml_list(const Quat& q) {
  return format_number(q.w()) + ' ' + xml_list(Vec3(q.vec()));
}

}  // namespace kinfer
