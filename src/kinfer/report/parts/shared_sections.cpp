// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kinfer/report/parts/pages.hpp"
#include "kinfer/report/parts/plot.hpp"

namespace kinfer::pages {
namespace {

using Json = nlohmann::json;

std::string as_sentence(std::string words) {
  if (!words.empty() && words.front() >= 'a' && words.front() <= 'z') words.front() += 'A' - 'a';
  return words;
}

std::string advice_item(const Json& advice) {
  return fmt::format("<b>{}.</b> <span class=\"why\">{}.</span>", html::prose(string_at(advice, "what")),
                     html::prose(as_sentence(string_at(advice, "why"))));
}

std::string value_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

html::Table inputs_table(const Json& provenance) {
  html::Table table{.name = "inputs", .caption = "Input files", .head = {"File", "SHA-256"}, .rows = {}};
  for (const Json& input : member(provenance, "inputs"))
    table.rows.push_back({html::text(string_at(input, "name")),
                          {fmt::format("<code>{}</code>", html::escape(string_at(input, "sha256")))}});
  return table;
}

html::Table options_table(const Json& provenance) {
  html::Table table{.name = "options", .caption = "Options, seed and version", .head = {"What", "Value"}, .rows = {}};
  table.rows.push_back({html::text("kinfer"), html::text(string_at(provenance, "version"))});
  table.rows.push_back({html::text("seed"), html::text(member(provenance, "seed").dump())});
  for (const auto& [name, value] : member(provenance, "options").items())
    table.rows.push_back({html::text(name), html::text(value_text(value))});
  return table;
}

}  // namespace

std::vector<double> numbers(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list)
    values.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
  return values;
}

std::string string_at(const Json& object, const char* key, const std::string& otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

const Json& member(const Json& object, const char* key) {
  static const Json nothing = Json::object();
  const auto found = object.find(key);
  return found == object.end() ? nothing : *found;
}

/// Colour of the verdict and the words beside it where the sentence has none of its own.
struct Chip {
  const char* kind;
  const char* words;
};

Chip chip_of(const Json& evidence) {
  const std::string usability =
      string_at(evidence, "usability", evidence.value("use", true) ? "use_with_care" : "do_not_use");
  if (usability == "do_not_use") return {"bad", "Do not use"};
  return usability == "use" ? Chip{"good", "Use it"} : Chip{"fair", "Use with care"};
}

/// The first clause is the headline; what follows a semicolon is shown below it. Only the layout looks for them.
std::string verdict_block(const Json& evidence, const std::string& what) {
  const std::string verdict = string_at(evidence, "verdict");
  const auto colon = verdict.find(": ");
  const Chip usability = chip_of(evidence);
  const std::string chip = colon != std::string::npos ? verdict.substr(0, colon) : usability.words,
                    sentence = colon != std::string::npos ? verdict.substr(colon + 2) : verdict;
  const auto semicolon = sentence.find("; ");
  const std::string added = semicolon == std::string::npos ? "" : as_sentence(sentence.substr(semicolon + 2));
  return fmt::format(
      "<p class=\"kicker\">{}</p><div id=\"verdict\"><h1>{}{}</h1>{}</div>", what,
      fmt::format("<span class=\"chip {}\">{}</span> ", usability.kind, html::escape(chip)),
      html::prose(as_sentence(sentence.substr(0, semicolon))),
      added.empty() ? "" : fmt::format("<p>{}{}</p>", html::prose(added), added.ends_with('.') ? "" : "."));
}

std::string cards(const std::vector<std::pair<std::string, std::string>>& list) {
  std::string text = "<div class=\"cards\">";
  for (const auto& [title, body] : list) text += fmt::format("<article><h2>{}</h2>{}</article>", title, body);
  return text + "</div>\n";
}

std::string advice_list(const Json& evidence, std::size_t most) {
  std::vector<std::string> items;
  for (const Json& advice : member(evidence, "next"))
    if (items.size() < most) items.push_back(advice_item(advice));
  return html::list(items, "todo");
}

html::Section next_section(const Json& evidence) {
  std::string list = advice_list(evidence, std::numeric_limits<std::size_t>::max());
  if (list.empty()) list = "<p>Nothing was noticed that another measurement would improve.</p>";
  return {"next", "What to do next", "The most useful first.", list};
}

html::Section repeat_section(const Json& evidence) {
  const Json& provenance = member(evidence, "provenance");
  return {
      "repeat", "How to make this again",
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
  return {"words", "Words used here", "", body + "</dl>\n"};
}

std::string convergence_plot(const Json& best_json, const Json& median_json, const std::string& subject) {
  const std::vector<double> best = numbers(best_json), median = numbers(median_json);
  std::vector<double> all = best, step;
  all.insert(all.end(), median.begin(), median.end());
  for (std::size_t i = 0; i < std::max(best.size(), median.size()); ++i) step.push_back(static_cast<double>(i + 1));
  svg::Plot plot({.label = "generation", .low = 0.0, .high = static_cast<double>(step.size())},
                 svg::log_axis_for("cost", all));
  std::vector<double> x(step.begin(), step.begin() + static_cast<std::ptrdiff_t>(median.size()));
  plot.line(x, median, "line-before");
  x.assign(step.begin(), step.begin() + static_cast<std::ptrdiff_t>(best.size()));
  plot.line(x, best, "line-after");
  return plot.svg(fmt::format("Cost of {} over the generations: best and median of the population", subject));
}

}  // namespace kinfer::pages
