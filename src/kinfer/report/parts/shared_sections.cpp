// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/shared_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "kinfer/report/parts/plot.hpp"
#include "kinfer/report/parts/verdict_block.hpp"

namespace kinfer::report {
namespace {

std::string advice_item(const Advice& advice) {
  return fmt::format("<b>{}.</b> <span class=\"why\">{}.</span>", html::prose(advice.what),
                     html::prose(as_sentence(advice.why)));
}

/// The first eight, and how many more there are.
std::string rows_text(const std::vector<int>& rows) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(rows.size(), most); ++i) text += fmt::format("{}{}", i > 0 ? ", " : "", rows[i]);
  return rows.size() > most ? text + fmt::format(" and {} more", rows.size() - most) : text;
}

html::Table inputs_table(const ProvenanceRecord& provenance) {
  html::Table table{.name = "inputs", .caption = "Input files", .head = {"File", "SHA-256"}, .rows = {}};
  for (const InputFile& input : provenance.inputs)
    table.rows.push_back({html::text(input.name), {fmt::format("<code>{}</code>", html::escape(input.sha256))}});
  return table;
}

html::Table options_table(const ProvenanceRecord& provenance) {
  html::Table table{.name = "options", .caption = "Options, seed and version", .head = {"What", "Value"}, .rows = {}};
  table.rows.push_back({html::text("kinfer"), html::text(provenance.version)});
  table.rows.push_back({html::text("seed"), html::text(fmt::format("{}", provenance.seed))});
  auto options = provenance.options;
  std::ranges::sort(options);
  for (const auto& [name, value] : options) table.rows.push_back({html::text(name), html::text(value)});
  return table;
}

constexpr const char* mit_licence =
    "Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated "
    "documentation files (the \"Software\"), to deal in the Software without restriction, including without limitation "
    "the rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and "
    "to permit persons to whom the Software is furnished to do so, subject to the following conditions: The above "
    "copyright notice and this permission notice shall be included in all copies or substantial portions of the "
    "Software. THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT "
    "LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT "
    "SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION "
    "OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER "
    "DEALINGS IN THE SOFTWARE.";

}  // namespace

std::string cards(const std::vector<std::pair<std::string, std::string>>& list) {
  std::string text = "<div class=\"cards\">";
  for (const auto& [title, body] : list) text += fmt::format("<article><h2>{}</h2>{}</article>", title, body);
  return text + "</div>\n";
}

std::string advice_list(const std::vector<Advice>& advice, std::size_t most) {
  std::vector<std::string> items;
  for (std::size_t i = 0; i < std::min(advice.size(), most); ++i) items.push_back(advice_item(advice[i]));
  return html::list(items, "todo");
}

std::string findings_table(const std::vector<FindingRecord>& findings, FindingRows rows) {
  if (findings.empty()) return "";
  html::Table table{
      .name = "findings", .caption = "Findings in the data before the fit", .head = {"", "What"}, .rows = {}};
  if (rows == FindingRows::shown) table.head.push_back("rows (from 0)");
  table.head.push_back("What to do");
  for (const FindingRecord& f : findings) {
    std::vector<html::Cell> row{html::text(name(f.finding.severity)), html::text(f.sentence)};
    if (rows == FindingRows::shown) row.push_back(html::text(rows_text(f.finding.rows)));
    row.push_back(html::text(f.finding.applied ? "was corrected" : f.suggestion));
    table.rows.push_back(row);
  }
  return html::table(table);
}

std::string notes_list(const std::vector<std::string>& notes) {
  std::vector<std::string> items;
  for (const std::string& note : notes) items.push_back(html::escape(note));
  return items.empty() ? "" : "<h3>Notes</h3>" + html::list(items);
}

html::Section next_section(const std::vector<Advice>& advice) {
  std::string list = advice_list(advice, std::numeric_limits<std::size_t>::max());
  if (list.empty()) list = "<p>No further measurement is recommended.</p>";
  return {"next", "What to do next", "The most useful first.", list};
}

html::Section repeat_section(const ProvenanceRecord& provenance) {
  return {
      "repeat", "How to reproduce this",
      "The same files, options and seed give the same bytes, on any number of threads. When it ran, for how long and "
      "on what machine is in <code>run.json</code> beside this file.",
      "<div class=\"two\">" + html::table(options_table(provenance)) + html::table(inputs_table(provenance)) +
          "</div><p class=\"fine\">Lengths are in metres and angles in radians inside every file; this page shows "
          "millimetres and degrees. Frames are right-handed; the world's z points up; a frame written a in b maps "
          "coordinates of a to those of b. ± is one standard deviation: the truth lies within two of them in about "
          "95 of 100 cases. Every number of this page is in <code>evidence.json</code>.</p>"};
}

html::Section glossary_section(const std::vector<std::pair<std::string, std::string>>& list) {
  std::string body = "<dl class=\"words\">";
  for (const auto& [word, meaning] : list) body += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", word, meaning);
  return {"words", "Glossary", "", body + "</dl>\n"};
}

html::Section notices_section() {
  return {"notices", "Third-party notices", "",
          fmt::format("<p class=\"fine\">The scripts of this page contain, unmodified, three.js, copyright © 2010-2026 "
                      "three.js authors, and µPlot, copyright © 2022 Leon Sorokin, both under the MIT licence:</p>"
                      "<p class=\"fine\">{}</p>",
                      html::escape(mit_licence))};
}

std::string convergence_plot(const std::vector<double>& best, const std::vector<double>& median,
                             const std::string& subject) {
  std::vector<double> all = best, step;
  all.insert(all.end(), median.begin(), median.end());
  for (std::size_t i = 0; i < std::max(best.size(), median.size()); ++i) step.push_back(static_cast<double>(i + 1));
  svg::Plot plot({.label = "generation", .low = 0.0, .high = static_cast<double>(step.size())},
                 svg::log_axis_for("cost", all));
  plot.line({step.begin(), step.begin() + static_cast<std::ptrdiff_t>(median.size())}, median, "line-before");
  plot.line({step.begin(), step.begin() + static_cast<std::ptrdiff_t>(best.size())}, best, "line-after");
  return plot.svg(fmt::format("Cost of {} over the generations: best and median of the population", subject));
}

}  // namespace kinfer::report
