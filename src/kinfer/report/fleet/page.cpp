// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/fleet/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/report/fleet/figures.hpp"
#include "kinfer/report/parts/shared_sections.hpp"
#include "kinfer/report/parts/verdict_block.hpp"
#include "kinfer/words/fleet/fleet.hpp"

namespace kinfer::report {
namespace {

constexpr std::size_t rows_on_paper = 200;  // of a list; table.csv and fleet.json hold all

std::string first_screen(const Fleet& fleet) {
  const std::string drawing = error_drawing(fleet);
  std::string text =
      fmt::format("<div class=\"say\"><p class=\"kicker\">A fleet</p><div id=\"verdict\"><h1>{}</h1></div>",
                  html::prose(words::headline(fleet.counts)));
  std::vector<std::string> remarks;
  for (const std::string& remark : words::remarks(fleet)) remarks.push_back(html::prose(as_sentence(remark) + "."));
  text += html::list(remarks) + "</div>";
  if (drawing.empty()) return text;
  return text + "<div class=\"machine\"><div class=\"still\">" + drawing +
         "<p class=\"note\">Errors of all tasks on rows that were not fitted, sorted; grey: before the calibration.</p>"
         "</div></div>";
}

std::string sentence_list(const std::vector<std::string>& sentences, const char* none) {
  if (sentences.empty()) return fmt::format("<p>{}</p>", none);
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(rows_on_paper, sentences.size()); ++i)
    shown.push_back(html::prose(sentences[i]));
  if (sentences.size() > shown.size()) shown.push_back(fmt::format("and {} more", sentences.size() - shown.size()));
  return html::list(shown);
}

html::Section unusual_section(const Fleet& fleet) {
  std::vector<std::string> sentences;
  for (const FleetDeviation& deviation : fleet.deviations) sentences.push_back(words::sentence(deviation));
  return {"unusual", "What is unusual",
          "Numbers that the spread of the fleet does not explain; one wrong entry in one of twenty fleets. SI units.",
          sentence_list(sentences, "Nothing.")};
}

html::Section changes_section(const Fleet& fleet) {
  std::vector<std::string> sentences;
  for (const FleetAlarm& alarm : fleet.chart.alarms) sentences.push_back(words::sentence(alarm));
  return {"changes", "What changed over time", "Two-sided CUSUM of each robot's dated results against its own history.",
          fleet.chart.series == 0
              ? "<p>No robot has four dated results: give the manifest the columns robot and date.</p>"
              : sentence_list(sentences, "No change that chance does not explain.")};
}

html::Section failures_section(const Fleet& fleet) {
  html::Table table{.name = "failures", .caption = "By sentence", .head = {"tasks", "sentence", "keys"}, .rows = {}};
  for (const FailureGroup& group : fleet.failures) {
    constexpr std::size_t most = 6;
    std::string keys;
    for (std::size_t i = 0; i < std::min(most, group.keys.size()); ++i) keys += (i > 0 ? ", " : "") + group.keys[i];
    if (group.keys.size() > most) keys += " …";
    table.rows.push_back(
        {html::number(static_cast<double>(group.keys.size()), 0), html::text(group.sentence), html::text(keys)});
  }
  return {"failures", "What failed", "Tasks that were refused, failed, or left a record that cannot be read.",
          table.rows.empty() ? "<p>Nothing.</p>" : html::table(table)};
}

html::Section coverage_section(const Fleet& fleet) {
  html::Table table{.name = "coverage",
                    .caption = "Truths inside the 95 % interval",
                    .head = {"parameter", "inside", "of", "[%]"},
                    .rows = {}};
  for (const CoverageCount& count : fleet.coverage)
    table.rows.push_back({html::text(count.name), html::number(count.inside, 0), html::number(count.count, 0),
                          html::number(static_cast<double>(count.inside) / count.count, 100.0, 1)});
  return {"coverage", "Coverage", "How often the stated interval holds the truth, where it is known.",
          html::table(table)};
}

html::Section spread_section(const Fleet& fleet) {
  return {"spread", "The spread of the parameters", "All robots side by side; dots at the edge are farther away.",
          html::figure("parameter-figure", "Parameters of all robots", parameter_drawing(fleet), "")};
}

/// Without scripts the worst rows; with scripts all of them, from the page's data.
html::Section rows_section(const Fleet& fleet) {
  html::Table table{.name = "rows",
                    .caption = "The rows that need attention first",
                    .head = {"key", "robot", "date", "verb", "status", "largest deviation [sd]", "of", "sentence"},
                    .rows = {}};
  for (const int i : worst_first(fleet)) {
    if (table.rows.size() == rows_on_paper) break;
    const FleetRow& row = fleet.rows[static_cast<std::size_t>(i)];
    table.rows.push_back({html::text(row.key), html::text(row.robot), html::text(row.date), html::text(row.verb),
                          html::text(status_name(row)), html::number(row.deviation, 1), html::text(row.most_deviant),
                          html::text(row.sentence)});
  }
  return {"rows", "All tasks", "Worst first. table.csv holds every figure and parameter.",
          "<div id=\"fleet-rows\"></div><div id=\"fleet-rows-static\">" + html::table(table) + "</div>"};
}

}  // namespace

Page fleet_page(const Fleet& fleet) {
  Page page{.title = "A fleet", .first = first_screen(fleet), .sections = {}};
  page.sections = {unusual_section(fleet), changes_section(fleet), failures_section(fleet)};
  if (!fleet.coverage.empty()) page.sections.push_back(coverage_section(fleet));
  if (!parameter_drawing(fleet).empty()) page.sections.push_back(spread_section(fleet));
  page.sections.push_back(rows_section(fleet));
  page.sections.push_back(
      glossary_section({{"robust sd", "1.4826 times the median absolute deviation from the median."},
                        {"CUSUM", "Cumulated sum of standardised deviations; an alarm where it passes a limit."},
                        {"rms", "Root mean square."}}));
  page.sections.push_back(notices_section());
  return page;
}

}  // namespace kinfer::report
