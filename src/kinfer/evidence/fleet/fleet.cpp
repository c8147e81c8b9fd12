// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/fleet/fleet.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace kinfer {
namespace {

/// 0 for what needs attention first.
int urgency(const FleetRow& row) {
  if (row.state == TaskState::unreadable) return 0;
  if (has_failed(row)) return row.exit_code > 2 || row.signal != 0 ? 1 : 2;
  if (row.state == TaskState::unfinished) return 5;
  if (row.exit_code == 1 || row.summary.usability == Usability::do_not_use) return 3;
  return row.summary.usability == Usability::use_with_care ? 4 : 6;
}

}  // namespace

std::string_view name(TaskState state) {
  constexpr std::array<std::string_view, 3> names{"done", "unfinished", "unreadable"};
  return names[static_cast<std::size_t>(state)];
}

bool has_failed(const FleetRow& row) {
  return row.state == TaskState::done && (row.signal != 0 || row.exit_code > 1);
}

std::string_view status_name(const FleetRow& row) {
  if (row.state != TaskState::done) return name(row.state);
  if (has_failed(row)) return row.signal != 0 || row.exit_code > 2 ? "failed" : "refused";
  if (row.summary.usability) return name(*row.summary.usability);
  return name(row.exit_code == 0 ? Usability::use : Usability::do_not_use);
}

std::vector<int> worst_first(const Fleet& fleet) {
  std::vector<int> order(fleet.rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) {
    const FleetRow &x = fleet.rows[static_cast<std::size_t>(a)], &y = fleet.rows[static_cast<std::size_t>(b)];
    return std::tuple(urgency(x), -x.deviation) < std::tuple(urgency(y), -y.deviation);
  });
  return order;
}

}  // namespace kinfer
