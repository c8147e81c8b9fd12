// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/identify/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/report/identify/figures.hpp"
#include "kinfer/report/identify/unobservable.hpp"
#include "kinfer/report/parts/shared_sections.hpp"
#include "kinfer/report/parts/units.hpp"

namespace kinfer::report {
namespace {

using html::Cell;

std::string phases_table(const OrderEvidence& order) {
  html::Table table{
      .name = "phases", .caption = "Phases of motion (1: moved)", .head = {"from [s]", "to [s]"}, .rows = {}};
  table.head.insert(table.head.end(), order.sensors.begin(), order.sensors.end());
  for (const PhaseEvidence& phase : order.phases) {
    std::vector<Cell> row{html::number(phase.begin, 2), html::number(phase.end, 2)};
    for (const bool moves : phase.moves) row.push_back(html::number(moves ? 1.0 : 0.0, 0));
    table.rows.push_back(row);
  }
  return table.rows.empty() ? "" : html::table(table);
}

std::string pairs_table(const OrderEvidence& order) {
  html::Table table{.name = "pairs",
                    .caption = "How well two segments share a point",
                    .head = {"Pair", "acceleration residual [m/s²]", "off-axis rate [rad/s]", ""},
                    .rows = {},
                    .long_after = 14};
  std::vector<PairEvidence> pairs = order.pairs;
  std::ranges::stable_sort(pairs, {}, &PairEvidence::residual);
  for (const PairEvidence& pair : pairs)
    table.rows.push_back({{html::escape(pair.first + "–" + pair.second), {}, html::CellKind::name},
                          html::number(pair.residual, 4),
                          html::number(pair.off_axis_rate, 4),
                          html::text(pair.joined ? "joined" : "")});
  return html::table(table);
}

std::vector<Cell> fit_row(const FitRecord& fit, const SegmentFitRecord& segment) {
  const auto held = std::ranges::find(fit.holdout, segment.segment, [](const auto& entry) { return entry.first; });
  const auto unseen = [&](double LinkFit::*value) {
    return held == fit.holdout.end() ? html::text("–") : html::number(held->second.*value, 5);
  };
  return {html::text(segment.segment),
          html::number(segment.fitted.acceleration, 5),
          html::number(segment.fitted.orientation, 5),
          unseen(&LinkFit::acceleration),
          unseen(&LinkFit::orientation),
          html::number(segment.rows, 0)};
}

}  // namespace

std::string joint_label(const JointEstimate& joint) {
  return joint.parent + "–" + joint.child;
}

html::Section order_section(const IdentificationEvidence& e) {
  const std::optional<double>& margin = e.order.margin;
  return {"order", "Order of the segments",
          fmt::format(
              "Segments that share a joint share a point, and their INS must agree on its acceleration. The tree joins "
              "the pairs that agree best; {}. The phases in which the segments move {}.",
              margin ? fmt::format("the next best tree fits {} times worse (2 is safe)", html::short_number(*margin))
                     : "there is no other tree",
              e.order.phases_agree ? "give the same order" : "do not give the same order"),
          html::figure(
              "tree", "Segment tree", tree_drawing(e),
              "From the root on the left outwards; below each joint, the difference of the two INS's accelerations of "
              "their common point.") +
              "<div class=\"two\">" + pairs_table(e.order) + phases_table(e.order) + "</div>"};
}

html::Section fit_section(const IdentificationEvidence& e) {
  html::Table table{.name = "fit",
                    .caption = "Residuals of the chain (rms)",
                    .head = {"Segment", "acceleration [m/s²]", "orientation [rad]", "acceleration, not fitted",
                             "orientation, not fitted", "rows"},
                    .rows = {}};
  for (const SegmentFitRecord& segment : e.fit.fitted) table.rows.push_back(fit_row(e.fit, segment));
  std::string figure;
  if (!e.motion.traces.empty())
    figure = fmt::format(
        "<figure><h3>Predicted and measured motion</h3><div id=\"traces\"></div>{}<figcaption>Measured, "
        "predicted and their difference; each line spans the smallest and the largest sample of its time, so "
        "that no spike is lost. Drag to zoom, double click to go back, click to see the machine at that "
        "time.</figcaption></figure>",
        trace_drawings(e));
  return {"fit-section", "How well it explains the motion",
          "Trust the figures of rows or windows that were not fitted.", figure + html::table(table)};
}

html::Section unobservable_section(const IdentificationEvidence& e) {
  html::Table table{
      .name = "unknown-table", .caption = "Unobservable quantities", .head = {"Joint", "What"}, .rows = {}};
  for (const JointRecord& joint : e.joints)
    for (const std::string& sentence : joint.sentences)
      table.rows.push_back({html::text(joint_label(joint.estimate)), html::text(sentence)});
  return {
      "unknown", "What is unobservable",
      "These directions are drawn dashed in the machine above. A longer log would not determine them; another kind of "
      "motion or one tape measurement would.",
      (table.rows.empty() ? "<p>Nothing.</p>" : html::table(table)) + notes_list(e.notes)};
}

html::Section recording_section(const IdentificationEvidence& e) {
  return {"doubts", "Findings", "Faults of the recording and deviations from a machine of rigid segments.",
          findings_table(e.findings, FindingRows::hidden)};
}

html::Section search_section(const IdentificationEvidence& e) {
  const StructureSearchRecord& s = e.search;
  std::string figures;
  for (std::size_t i = 0; i < s.best.size(); ++i) {
    if (s.best[i].size() < 2) continue;
    const std::string segment = i < s.segments.size() ? s.segments[i].segment : fmt::format("part {}", i + 1);
    figures += html::figure("convergence-" + std::to_string(i), "Search of " + html::escape(segment),
                            convergence_plot(s.best[i], s.median[i], segment), "");
  }
  return {"search", "How it was found",
          fmt::format("Engine {}: {} evaluations. <i class=\"key after\"></i> best of the population, <i class=\"key "
                      "before\"></i> its median.",
                      html::escape(name(s.method)), s.evaluations),
          figures.empty() ? "<p>No population was searched.</p>" : "<div class=\"two\">" + figures + "</div>"};
}

}  // namespace kinfer::report
