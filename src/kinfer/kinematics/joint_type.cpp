// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/joint_type.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kinfer {
namespace {

/// Rows are found by the enumerator's value.
constexpr bool rows_are_in_order() {
  for (std::size_t i = 0; i < joint_types.size(); ++i)
    if (joint_types[i].type != static_cast<JointType>(i)) return false;
  return true;
}
static_assert(rows_are_in_order());

}  // namespace

std::optional<JointType> joint_type_named(std::string_view name) {
  const auto row = std::ranges::find(joint_types, name, &JointTypeTraits::name);
  return row == joint_types.end() ? std::nullopt : std::optional(row->type);
}

std::string joint_type_names() {
  std::string text;
  for (std::size_t i = 0; i < joint_types.size(); ++i)
    text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 < joint_types.size() ? ", " : " or ", joint_types[i].name);
  return text;
}

}  // namespace kinfer
