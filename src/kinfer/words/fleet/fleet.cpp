// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/fleet/fleet.hpp"

#include <cmath>

#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::string headline(const FleetCounts& counts) {
  const int tasks = counts.use + counts.use_with_care + counts.do_not_use + counts.refused + counts.failed +
                    counts.unfinished + counts.unreadable;
  std::string text = fmt::format("{} task{}: {} to use", tasks, tasks == 1 ? "" : "s", counts.use);
  const auto add = [&](int count, const char* what) {
    if (count > 0) text += fmt::format(", {} {}", count, what);
  };
  add(counts.use_with_care, "to use with care");
  add(counts.do_not_use, "not to use");
  add(counts.refused, "refused");
  add(counts.failed, "failed");
  add(counts.unfinished, "unfinished");
  add(counts.unreadable, "unreadable");
  return phrase("fleet", "{}", text);
}

std::string figure_name(const std::string& name) {
  if (name.starts_with("rms_before")) return phrase(name, "rms error before, not fitted");
  if (name.starts_with("rms_after")) return phrase(name, "rms error after, not fitted");
  if (name.starts_with("max_after")) return phrase(name, "largest error after, not fitted");
  if (name == "sigma_m") return phrase(name, "noise level");
  if (name == "rms_m") return phrase(name, "rms error");
  if (name == "max_m") return phrase(name, "largest error");
  if (name == "rms_frames_refitted_m") return phrase(name, "rms error, base and tool refitted");
  if (name == "worst_acceleration_m_s2") return phrase(name, "worst residual of an acceleration");
  return name;
}

std::string sentence(const FleetDeviation& deviation) {
  return phrase("deviation", "{}: {} is {:.4g}, of the fleet {:.4g} ({:+.1f} sd)", deviation.key,
                figure_name(deviation.name), deviation.value, deviation.typical, deviation.sigmas);
}

std::string sentence(const FleetAlarm& alarm) {
  return phrase("alarm", "{}: {} {} since {}, noticed on {}", alarm.robot, figure_name(alarm.name),
                alarm.rises ? "rises" : "falls", alarm.since, alarm.noticed);
}

std::vector<std::string> remarks(const Fleet& fleet) {
  std::vector<std::string> list;
  if (fleet.processor_classes.size() > 1)
    list.push_back(
        phrase("classes_mixed",
               "results come from processors of different classes ({}): numbers of the same task may differ in "
               "the last digits between them; --kernels portable makes kinfer's own kernels the same",
               joined(fleet.processor_classes)));
  if (fleet.counts.unfinished > 0)
    list.push_back(phrase("unfinished",
                          "{} tasks of the manifest have no result yet: run the sweep again with --resume",
                          fleet.counts.unfinished));
  if (fleet.chart.series > 0)
    list.push_back(phrase("false_alarms",
                          "{} series with {} checks are monitored; where nothing changes, a false alarm in any of them "
                          "is to be expected in one of {:.0f} reports of this size (one series: one in {:.0f} checks)",
                          fleet.chart.series, fleet.chart.checks, 1.0 / fleet.chart.false_alarms,
                          fleet.chart.run_length));
  if (fleet.population)
    list.push_back(phrase("population", "prior.json: mean and covariance of {} joint parameters over {} robots",
                          fleet.population->names.size(), fleet.population->robots));
  else if (fleet.prior_sample.calibrations > 0)
    list.push_back(
        phrase("no_population", "no prior.json: {} robot{} with a calibration that may be used, and a prior needs {}",
               fleet.prior_sample.robots, fleet.prior_sample.robots == 1 ? "" : "s", fleet.prior_sample.robots_needed));
  return list;
}

}  // namespace kinfer::words
