// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/facts/unobservable.hpp"

#include <algorithm>
#include <array>

namespace kinfer {
namespace {

struct UnobservableRow {
  UnobservableKind kind;
  std::string_view name;
  UnobservableRemedy remedy;
};

constexpr std::array unobservable_rows{
    UnobservableRow{UnobservableKind::point, "point", UnobservableRemedy::rock_base_or_measure},
    UnobservableRow{UnobservableKind::point_across, "point_across", UnobservableRemedy::rotate_segment_or_measure},
    UnobservableRow{UnobservableKind::point_along, "point_along", UnobservableRemedy::rock_base_or_measure},
    UnobservableRow{UnobservableKind::azimuth, "azimuth", UnobservableRemedy::tilt_base_or_magnetometer},
    UnobservableRow{UnobservableKind::place_about_axis, "place_about_axis",
                    UnobservableRemedy::tilt_base_or_magnetometer},
    UnobservableRow{UnobservableKind::point_on_axis, "point_on_axis", UnobservableRemedy::none},
    UnobservableRow{UnobservableKind::axis_position, "axis_position", UnobservableRemedy::none},
    UnobservableRow{UnobservableKind::joint_axis, "joint_axis", UnobservableRemedy::move_joint},
    UnobservableRow{UnobservableKind::offset_split, "offset_split", UnobservableRemedy::none},
};

}  // namespace

std::string_view name(UnobservableKind kind) {
  return std::ranges::find(unobservable_rows, kind, &UnobservableRow::kind)->name;
}

UnobservableRemedy remedy(UnobservableKind kind) {
  return std::ranges::find(unobservable_rows, kind, &UnobservableRow::kind)->remedy;
}

std::string_view name(UnobservableRemedy remedy) {
  switch (remedy) {
    case UnobservableRemedy::rock_base_or_measure:
      return "rock_base_or_measure";
    case UnobservableRemedy::rotate_segment_or_measure:
      return "rotate_segment_or_measure";
    case UnobservableRemedy::tilt_base_or_magnetometer:
      return "tilt_base_or_magnetometer";
    case UnobservableRemedy::move_joint:
      return "move_joint";
    case UnobservableRemedy::none:
      break;
  }
  return "none";
}

}  // namespace kinfer
