// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/model/facts.hpp"

#include <algorithm>

namespace kinfer {

bool is_measured_axis(const InsFacts& facts, std::size_t body) {
  const auto is_axis = [&](const InsPoint& point) {
    return point.kind == InsPoint::Kind::joint_axis && point.body == static_cast<int>(body);
  };
  return std::ranges::any_of(facts.tapes,
                             [&](const InsTapeDistance& tape) { return is_axis(tape.from) || is_axis(tape.to); }) ||
         std::ranges::any_of(facts.touches, is_axis, &InsRevisitedPoint::point) ||
         std::ranges::any_of(facts.surveyed, is_axis, &InsSurveyedPoint::point);
}

}  // namespace kinfer
