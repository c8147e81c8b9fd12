// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/track/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/parts/shared_sections.hpp"
#include "kinfer/report/parts/units.hpp"
#include "kinfer/report/parts/verdict_block.hpp"
#include "kinfer/report/track/figures.hpp"

namespace kinfer::report {
namespace {

struct CurveSummary {
  double low = NAN, high = NAN, last_sd = NAN, largest_sd = NAN;
};

CurveSummary summary_of(const TrackCurve& curve) {
  CurveSummary summary;
  for (std::size_t i = 0; i < curve.low.size(); ++i) {
    summary.low = std::fmin(summary.low, curve.low[i]);
    summary.high = std::fmax(summary.high, curve.high[i]);
    summary.largest_sd = std::fmax(summary.largest_sd, curve.sd[i]);
    if (std::isfinite(curve.sd[i])) summary.last_sd = curve.sd[i];
  }
  return summary;
}

std::string first_screen(const TrackRun& run) {
  const std::string path = tool_path_drawing(run);
  return "<div class=\"say\">" + verdict_block(run.verdict, "A run of the tracker on an identified chain") +
         fmt::format(
             "<dl class=\"facts\"><dt>Sensors</dt><dd>{}</dd><dt>Log</dt><dd>{} s</dd><dt>Rows</dt><dd>{}</dd>"
             "</dl>",
             run.sensors.size(), html::fixed(run.end - run.begin, 1), run.rows) +
         "</div><div class=\"machine\"><div class=\"still\">" + path +
         (path.empty() ? "" : "<p class=\"note\">Path of the tool in the frame of the base's sensor.</p>") +
         "</div></div>";
}

html::Section positions_section(const TrackRun& run) {
  html::Table table{.name = "positions",
                    .caption = "Joint positions in this run",
                    .head = {"joint", "unit", "least", "greatest", "sd at the end", "largest sd"},
                    .rows = {}};
  for (const TrackCurve& curve : run.positions) {
    const CurveSummary s = summary_of(curve);
    const double unit = curve.rotates ? 1.0 / degree : mm;
    const int digits = curve.rotates ? 2 : 1;
    table.rows.push_back({html::text(curve.name), html::text(curve.rotates ? "deg" : "mm"),
                          html::number(s.low, unit, digits), html::number(s.high, unit, digits),
                          html::number(s.last_sd, unit, digits + 1), html::number(s.largest_sd, unit, digits + 1)});
  }
  return {"positions", "Joint positions", "Zeros and senses are those of the chain.",
          html::figure("position-figure", "Joint positions over time", position_drawings(run),
                       "Lines: position; where a line is double, least and greatest of each bin. Band: 95 % interval. "
                       "Grey stripes: an alarm was active.") +
              html::table(table)};
}

html::Section alarms_section(const TrackRun& run) {
  html::Table table{.name = "alarms",
                    .caption = "Alarms of this run",
                    .head = {"from [s]", "to [s]", "what", "strength"},
                    .rows = {}};
  for (const TrackEvent& event : run.events)
    table.rows.push_back({html::number(event.alarm.since, 2),
                          std::isnan(event.until) ? html::text("end") : html::number(event.until, 2),
                          html::text(event.sentence), html::number(event.alarm.strength, 1)});
  const std::string body =
      run.events.empty()
          ? "<p>There was no alarm.</p>"
          : html::figure("alarm-figure", "Alarms over time", alarm_drawing(run), "") + html::table(table);
  return {"alarms", "Alarms", "An alarm says that a sensor or a joint no longer agrees with the chain.", body};
}

html::Section sensors_section(const TrackRun& run) {
  const std::string drawing = innovation_drawing(run);
  return {"sensors", "Sensors",
          "How far each sensor is from what all others make of it, over what is expected; 1 is as expected.",
          drawing.empty() ? "<p>Not computed in this run.</p>"
                          : html::figure("innovation-figure", "Innovation of each sensor", drawing, "")};
}

html::Section track_glossary() {
  return glossary_section({{"base's frame", "The frame of the sensor on the base segment."},
                           {"sd", "One standard deviation."},
                           {"relative to the start", "The position counts from where the run began."},
                           {"composed", "From the orientations of the joint's two sensors, each filtered alone."}});
}

}  // namespace

Page track_page(const TrackRun& run) {
  Page page{.title = "Tracking of a machine", .first = first_screen(run), .sections = {}};
  page.sections = {positions_section(run), alarms_section(run), sensors_section(run)};
  if (!run.remarks.empty())
    page.sections.push_back({"log", "The log", "What is remarkable about it.", notes_list(run.remarks)});
  page.sections.push_back(track_glossary());
  page.sections.push_back(repeat_section(run.provenance));
  page.sections.push_back(notices_section());
  return page;
}

}  // namespace kinfer::report
