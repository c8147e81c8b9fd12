// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/merge.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "kinfer/fleet/monitoring.hpp"
#include "kinfer/fleet/population_fit.hpp"
#include "kinfer/fleet/spread.hpp"
#include "kinfer/fleet/thresholds.hpp"

namespace kinfer::fleet {
namespace {

constexpr int exit_of_bad_input = 2;
constexpr double interval_95 = 1.959964;  // standard deviations

void count_row(const FleetRow& row, FleetCounts& counts) {
  if (row.state == TaskState::unfinished)
    ++counts.unfinished;
  else if (row.state == TaskState::unreadable)
    ++counts.unreadable;
  else if (row.signal != 0 || row.exit_code > exit_of_bad_input)
    ++counts.failed;
  else if (row.exit_code == exit_of_bad_input)
    ++counts.refused;
  else if (row.exit_code != 0)
    ++counts.do_not_use;
  else
    ++(row.summary.usability == Usability::use_with_care ? counts.use_with_care : counts.use);
}

std::vector<FailureGroup> group_failures(const std::vector<FleetRow>& rows) {
  std::map<std::string, FailureGroup> by_sentence;
  for (const FleetRow& row : rows) {
    if (!has_failed(row) && row.state != TaskState::unreadable) continue;
    FailureGroup& group = by_sentence[row.sentence];
    group.sentence = row.sentence;
    group.keys.push_back(row.key);
  }
  std::vector<FailureGroup> groups;
  for (auto& [sentence, group] : by_sentence) groups.push_back(std::move(group));
  std::ranges::stable_sort(groups, std::ranges::greater{}, [](const FailureGroup& g) { return g.keys.size(); });
  return groups;
}

std::vector<CoverageCount> count_coverage(const std::vector<FleetRow>& rows) {
  std::map<std::string, CoverageCount> by_name;
  for (const FleetRow& row : rows)
    for (const SummaryParameter& parameter : row.summary.parameters) {
      if (!parameter.truth || !(parameter.sd > 0.0)) continue;
      CoverageCount& count = by_name[parameter.name];
      count.name = parameter.name;
      ++count.count;
      count.inside += std::abs(parameter.value - *parameter.truth) <= interval_95 * parameter.sd ? 1 : 0;
    }
  std::vector<CoverageCount> list;
  for (auto& [name, count] : by_name) list.push_back(std::move(count));
  return list;
}

}  // namespace

std::vector<int> rows_of_prior(const std::vector<FleetRow>& rows) {
  std::map<std::string, int> latest;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const FleetRow& row = rows[i];
    if (row.verb != "calibrate" || row.state != TaskState::done || row.exit_code != 0) continue;
    const auto [at, is_new] = latest.emplace(row.robot.empty() ? row.key : row.robot, static_cast<int>(i));
    const FleetRow& held = rows[static_cast<std::size_t>(at->second)];
    if (std::tie(held.date, held.key) < std::tie(row.date, row.key)) at->second = static_cast<int>(i);
  }
  std::vector<int> all, sample;
  for (const auto& [robot, row] : latest) all.push_back(row);
  const std::size_t n = std::min<std::size_t>(thresholds::largest_sample, all.size());
  for (std::size_t i = 0; i < n; ++i) sample.push_back(all[i * all.size() / n]);
  return sample;
}

Fleet merge_rows(std::vector<FleetRow> rows) {
  std::ranges::sort(rows, {}, &FleetRow::key);
  Fleet fleet{.rows = std::move(rows)};
  std::set<std::string> classes;
  for (const FleetRow& row : fleet.rows) {
    count_row(row, fleet.counts);
    if (!row.processor_class.empty()) classes.insert(row.processor_class);
  }
  fleet.processor_classes.assign(classes.begin(), classes.end());
  compare_rows(fleet);
  fleet.failures = group_failures(fleet.rows);
  fleet.coverage = count_coverage(fleet.rows);
  fleet.chart = monitor(fleet.rows);
  std::vector<const ParameterInformation*> robots;
  for (const int i : rows_of_prior(fleet.rows))
    if (const auto& information = fleet.rows[static_cast<std::size_t>(i)].summary.information)
      robots.push_back(&*information);
  fleet.prior_sample = {.calibrations = static_cast<int>(std::ranges::count(fleet.rows, "calibrate", &FleetRow::verb)),
                        .robots = static_cast<int>(robots.size()),
                        .robots_needed = thresholds::fewest_robots};
  fleet.population = fit_population(robots);
  return fleet;
}

}  // namespace kinfer::fleet
