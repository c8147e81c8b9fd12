// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/tracking/track_summary.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kinfer/base/angle.hpp"

namespace kinfer::cli {
namespace {

constexpr std::size_t most_events_shown = 20;

/// "-" for a joint that was never known.
std::string cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:>10.{}f}", value, digits) : fmt::format("{:>10}", "-");
}

std::string position_line(const TrackCurve& curve) {
  double low = NAN, high = NAN, sd = NAN;
  for (std::size_t i = 0; i < curve.low.size(); ++i) {
    low = std::fmin(low, curve.low[i]);
    high = std::fmax(high, curve.high[i]);
    sd = std::fmax(sd, curve.sd[i]);
  }
  const double unit = curve.rotates ? degree : 1e-3;
  return fmt::format("{:<16} {} {} {}  {}\n", curve.name, cell(low / unit, 2), cell(high / unit, 2), cell(sd / unit, 3),
                     curve.rotates ? "deg" : "mm");
}

}  // namespace

std::string track_summary(const TrackRun& run) {
  std::string text = run.verdict.sentence + ".\n\n";
  text += fmt::format("{:<16} {:>10} {:>10} {:>10}\n", "joint", "least", "greatest", "largest sd");
  for (const TrackCurve& curve : run.positions) text += position_line(curve);
  if (!run.events.empty()) text += '\n';
  for (std::size_t i = 0; i < run.events.size() && i < most_events_shown; ++i) {
    const TrackEvent& event = run.events[i];
    text += fmt::format("{:>9.2f} s  {}{}\n", event.alarm.since, event.sentence,
                        std::isnan(event.until) ? "" : fmt::format(" (until {:.2f} s)", event.until));
  }
  if (run.events.size() > most_events_shown)
    text += fmt::format("{:>11}  and {} more\n", "", run.events.size() - most_events_shown);
  if (!run.remarks.empty()) text += '\n';
  for (const std::string& remark : run.remarks) text += "! " + remark + '\n';
  return text;
}

}  // namespace kinfer::cli
