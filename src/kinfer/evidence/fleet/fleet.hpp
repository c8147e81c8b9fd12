// SPDX-License-Identifier: Apache-2.0
// Many results side by side: a row for each task, what is unusual among them, and what changed over time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/fleet/population.hpp"
#include "kinfer/evidence/fleet/task_summary.hpp"

namespace kinfer {

enum class TaskState {
  done,
  unfinished,  ///< in the manifest, without a result
  unreadable,  ///< its record is truncated, or of something else
};
std::string_view name(TaskState state);

struct FleetRow {
  std::string key{}, verb{};
  std::string folder{};                      ///< of the task's files, or the archive that holds them; in no output
  std::optional<std::uint64_t> packed_at{};  ///< where in the archive [bytes]; nothing: a folder
  std::string robot{}, date{};               ///< of the manifest; the date as YYYY-MM-DD, with a time or without
  TaskState state = TaskState::done;
  int exit_code = 0, signal = 0;
  std::string sentence{};         ///< what the program said where it failed, or why the record cannot be read
  std::string processor_class{};  ///< processor and kernels: results are the same to the bit within one class
  TaskSummary summary{};
  double deviation = 0.0;  ///< the largest of its deviations from the fleet, in standard deviations
  std::string most_deviant{};
};

/// Failed for the program's sake, or refused for the data's.
bool has_failed(const FleetRow& row);

/// "use", "use_with_care", "do_not_use", "refused", "failed", "unfinished", "unreadable"
std::string_view status_name(const FleetRow& row);

/// The spread of one number over the fleet.
struct FleetSpread {
  std::string verb{}, name{};
  bool logarithmic = false;       ///< median and sd are those of the logarithm
  double median = 0.0, sd = 0.0;  ///< robust
  int count = 0;
};

/// A number that the fleet's spread does not explain, at a risk of `fleet_risk` for the whole fleet.
struct FleetDeviation {
  std::string key{}, name{};
  double value = 0.0, typical = 0.0;  ///< SI; of the fleet
  double sigmas = 0.0;
};

/// A change over time, by a control chart.
struct FleetAlarm {
  std::string robot{}, name{};
  std::string since{}, noticed{};  ///< dates
  std::string key{};               ///< of the row in which it was noticed
  bool rises = false;
  double statistic = 0.0, limit = 0.0;
};

struct ControlChartSummary {
  int series = 0, checks = 0;
  double limit = 0.0;         ///< of the statistic
  double run_length = 0.0;    ///< checks until a false alarm, on average, in one series
  double false_alarms = 0.0;  ///< expected in the whole fleet
  std::vector<FleetAlarm> alarms{};
};

struct FailureGroup {
  std::string sentence{};
  std::vector<std::string> keys{};
};

/// How often the truth lies in the 95 % interval, where it is known.
struct CoverageCount {
  std::string name{};  ///< of the parameter
  int inside = 0, count = 0;
};

struct FleetCounts {
  int use = 0, use_with_care = 0, do_not_use = 0, refused = 0, failed = 0, unfinished = 0, unreadable = 0;
};

/// What a prior can be made of.
struct PriorSample {
  int calibrations = 0;  ///< in the table, whatever became of them
  int robots = 0;        ///< with a calibration that may be used and whose data tell of joint parameters
  int robots_needed = 0;
};

struct Fleet {
  std::vector<FleetRow> rows{};  ///< by key
  FleetCounts counts{};
  std::vector<FleetSpread> spreads{};
  std::vector<FleetDeviation> deviations{};  ///< largest first
  std::vector<FailureGroup> failures{};      ///< most frequent first
  std::vector<CoverageCount> coverage{};
  std::vector<std::string> processor_classes{};
  ControlChartSummary chart{};
  PriorSample prior_sample{};
  std::optional<PopulationPrior> population{};  ///< nothing: too few robots
};

/// Indices of the rows, those that need attention first: failed, not to be used, deviating; then by key.
std::vector<int> worst_first(const Fleet& fleet);

}  // namespace kinfer
