// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/deployment/pose_plan.hpp"

#include <algorithm>

namespace kinfer {
namespace {

/// In the order of the enumerators.
constexpr std::array<std::string_view, 5> criterion_names{"tool", "worst", "d", "a", "e"};

}  // namespace

std::string_view name(Criterion criterion) {
  return criterion_names[static_cast<std::size_t>(criterion)];
}

std::optional<Criterion> criterion_named(std::string_view name) {
  const auto at = std::ranges::find(criterion_names, name);
  if (at == criterion_names.end()) return std::nullopt;
  return static_cast<Criterion>(at - criterion_names.begin());
}

}  // namespace kinfer
