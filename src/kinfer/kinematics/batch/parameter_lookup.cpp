// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/batch/parameter_lookup.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinfer::batch {
namespace {

using elementary::Motion;

bool is_angle(Field field) {
  constexpr std::array angles{Field::rx, Field::ry, Field::rz, Field::alpha, Field::theta, Field::beta};
  return std::find(angles.begin(), angles.end(), field) != angles.end();
}

}  // namespace

std::optional<int> place_in_chain(const ParameterAddress& at) {
  if (const JointNumber* number = joint_number(at)) return 2 + number->joint;
  if (is_own_frame_parameter(at, SetupFrame::base)) return 0;
  return is_own_frame_parameter(at, SetupFrame::tool) ? std::optional(1) : std::nullopt;
}

ParameterLookup::ParameterLookup(const ParameterSet& set) {
  for (const Parameter* p : set.free()) {
    const Field field = field_of(p->at).value_or(Field::coupling);
    const int place = place_in_chain(p->at).value_or(-1);
    angle_.push_back(is_angle(field) ? static_cast<int>(angles_.size()) : -1);
    if (is_angle(field)) angles_.push_back(static_cast<int>(keys_.size()));
    keys_.push_back({place, field});
    frees_base_ |= place == 0, fields_ |= bit(field);
  }
}

Value ParameterLookup::value(int place, Field field, double constant, Motion motion) const {
  Value value{.constant = constant};
  if (motion == Motion::rotation && constant != 0.0) value.cos = std::cos(constant), value.sin = std::sin(constant);
  value.parameter = index_of({place, field});
  if (value.parameter >= 0) value.angle = angle_[value.parameter];
  return value;
}

int ParameterLookup::index_of(const Key& key) const {
  if (!(fields_ & bit(key.field))) return -1;
  const auto next = keys_.begin() + next_;
  auto found = std::find(next, keys_.end(), key);
  if (found == keys_.end()) found = std::find(keys_.begin(), next, key);
  if (found == next && (next == keys_.end() || !(*next == key))) return -1;
  next_ = found - keys_.begin() + 1;
  return static_cast<int>(next_ - 1);
}

}  // namespace kinfer::batch
