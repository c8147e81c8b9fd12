// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/identify/sections.hpp"
#include "kinfer/report/parts/units.hpp"

namespace kinfer::report {
namespace {

html::Cell size_cell(const std::optional<ChangeSize>& size, double unit, int decimals) {
  if (!size) return html::undetermined_cell("unknown");
  return {html::fixed(unit * size->value, decimals) + " ± " + html::fixed(unit * size->sd, decimals),
          fmt::format("{}", unit * size->value), html::CellKind::number};
}

std::string change_table(const ChainUpdateRecord& update) {
  if (update.changes.empty()) return "";
  html::Table table{.name = "changes",
                    .caption = "What changed, most certain first",
                    .head = {"Sensor or joint", "on the segment of", "turned by [°]", "moved by [mm]", "ln odds"},
                    .rows = {}};
  for (const ChainChangeRecord& record : update.changes) {
    const ChainChange& change = record.change;
    table.rows.push_back({html::text(change.name), html::text(change.segment), size_cell(change.angle, 1.0 / degree, 2),
                          size_cell(change.distance, mm, 1), html::number(change.log_odds, 0)});
  }
  return html::table(table);
}

std::string part_table(const ChainUpdateRecord& update) {
  html::Table table{
      .name = "parts",
      .caption =
          "Both identifications, part by part: an axis in mrad, a point in mm. Expected: by the standard "
          "deviations of both, if nothing changed",
      .head = {"Joint", "seen by", "part", "difference", "expected", "squared distance", "degrees of freedom"},
      .rows = {}};
  for (const ChainPartComparison& part : update.parts) {
    const double unit = part.quantity == ChainPartQuantity::axis ? mrad : mm;
    table.rows.push_back({html::text(part.joint), html::text(part.sensor), html::text(name(part.quantity)),
                          html::number(part.difference, unit, 2), html::number(part.sd, unit, 2),
                          html::number(part.squared_distance, 1), html::number(part.freedom, 0)});
  }
  return html::table(table);
}

}  // namespace

html::Section update_section(const IdentificationEvidence& e) {
  const ChainUpdateRecord& update = *e.update;
  return {"update-section", "What changed since the last identification",
          "The geometry that this log alone shows, beside that of the chain that was updated. A sensor that sits "
          "otherwise moves all that is expressed in its frame as one rigid body; a pin that moved changes one joint on "
          "one segment.",
          "<p>" + html::prose(update.sentence) + ".</p>" + change_table(update) + part_table(update)};
}

}  // namespace kinfer::report
