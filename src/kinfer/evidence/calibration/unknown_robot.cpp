// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/unknown_robot.hpp"

namespace kinfer {

std::string_view name(AxisRelation relation) {
  switch (relation) {
    case AxisRelation::parallel:
      return "parallel";
    case AxisRelation::at_angle:
      return "at_angle";
    case AxisRelation::intersecting:
      return "intersecting";
    case AxisRelation::skew:
      return "skew";
  }
  return "";
}

}  // namespace kinfer
