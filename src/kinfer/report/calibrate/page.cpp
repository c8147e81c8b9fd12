// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/calibrate/figures.hpp"
#include "kinfer/report/parts/pages.hpp"

namespace kinfer::pages {
namespace {

using Json = nlohmann::json;
using html::Cell;

constexpr double mm = 1e3;

std::string in_mm(double metres) {
  return html::short_number(mm * metres) + " mm";
}

std::string plural(std::size_t n, std::string_view one) {
  return fmt::format("{} {}{}", n, one, n == 1 ? "" : "s");
}

std::string facts(const Json& e) {
  return fmt::format(
      "<dl class=\"facts\"><dt>Poses</dt><dd>{}, of which {} left out as wrong</dd><dt>Proof</dt><dd>{}</dd>"
      "<dt>Model</dt><dd>{}, {} parameters</dd></dl>",
      e.at("rows").at("row").size(), e.at("outliers").size(), html::escape(string_at(e, "holdout")),
      html::escape(string_at(e.at("model"), "chosen", "geometry")), e.at("parameters").size());
}

std::string first_screen(const Json& e) {
  const Headline h = headline(e);
  const std::string name = html::escape(string_at(e, "robot", "robot"));
  return "<div class=\"say\">" + verdict_block(e, "Calibration of " + name) + gain_drawing(e) +
         fmt::format(
             "<p class=\"note\">Mean error of {} on {}: <b>{} times</b> smaller. <i>Before</i> is the data sheet's "
             "model after base and tool were fitted; the line marks the worst pose.</p>",
             html::escape(h.what),
             h.held_out ? "poses that were <b>not</b> used for the fit" : "the poses that were fitted",
             html::short_number(h.mean_before / std::max(1e-12, h.mean_after))) +
         facts(e) + "</div><div class=\"machine\" id=\"machine\"><div class=\"still\">" + machine_drawing(e) +
         "</div></div>";
}

std::string how_good(const Json& e) {
  const Headline h = headline(e);
  const double most = mm * error_percentile_95(e);
  std::string text = fmt::format(
      "<p><b class=\"big\">{}&nbsp;{}</b> on average, <b>{}&nbsp;{}</b> at worst{}.</p><p>Judged on {} measurements: "
      "{}.</p>",
      html::short_number(h.mean_after), h.unit, html::short_number(h.max_after), h.unit,
      std::isfinite(most) ? fmt::format("; 95 of 100 poses stay below <b>{}&nbsp;mm</b>", html::short_number(most))
                          : "",
      h.n, html::escape(string_at(e, "holdout")));
  if (const Json& chi2 = e.at("chi2_per_n"); chi2.is_number()) {
    const double times = std::sqrt(chi2.get<double>());
    text += times < 1.5 ? fmt::format("<p>What is left is mostly what the instrument scatters, {} per axis.</p>",
                                      in_mm(e.at("sigma")))
                        : fmt::format(
                              "<p>What is left is {} times what the instrument scatters: something is not in the "
                              "model.</p>",
                              html::short_number(times));
  } else {
    text += fmt::format("<p>No instrument was stated: what is left, {} per axis, is taken as its scatter.</p>",
                        in_mm(e.at("sigma")));
  }
  return text;
}

std::string how_uncertain(const Json& e) {
  std::size_t open = 0;
  for (const Json& p : e.at("parameters")) open += p.at("identifiable").get<bool>() ? 0 : 1;
  std::string text = fmt::format(
      "<p><b class=\"big\">{}</b> is the expected error (rms) of the corrected model itself at the tool, over these "
      "poses. The errors above the cards hold the instrument's scatter too.</p>",
      in_mm(e.at("predicted_error")));
  text += open == 0 ? std::string("<p>The data fix every parameter.</p>")
                    : fmt::format(
                          "<p>{} of {} parameters cannot be told apart from others and stay near the data "
                          "sheet. That does no harm where these poses are; elsewhere see <a "
                          "href=\"#uncertainty\">the map</a>.</p>",
                          open, e.at("parameters").size());
  if (const std::size_t wrong = e.at("outliers").size(); wrong > 0)
    text += fmt::format("<p><a href=\"#doubts\">{}</a> not believed and left out.</p>",
                        wrong == 1 ? "One row was" : plural(wrong, "row") + " were");
  return text;
}

std::vector<Cell> error_row(const std::string& name, const Json& s, double factor, int decimals) {
  if (s.at("n").get<int>() == 0) return {};
  return {html::text(name),
          html::number(s.at("mean"), factor, decimals),
          html::number(s.at("rms"), factor, decimals),
          html::number(s.at("sd"), factor, decimals),
          html::number(s.at("max"), factor, decimals),
          html::number(s.at("n"), 0)};
}

std::string error_table(const Json& e, const char* name, const std::string& caption, const char* kind, double factor,
                        int decimals) {
  html::Table table{
      .name = name, .caption = caption, .head = {"Model, rows", "mean", "rms", "sd", "max", "n"}, .rows = {}};
  const auto add = [&](const char* which, const char* side, const std::string& words) {
    const Json& fit = *kind ? e.at(which).at(kind) : e.at(which);
    if (auto row = error_row(words, fit.at(side), factor, decimals); !row.empty()) table.rows.push_back(row);
  };
  add("nominal", "holdout", "as given, not fitted");
  add("nominal", "train", "as given, all rows");
  add("before", "holdout", "base and tool fitted, rows not fitted");
  add("before", "train", "base and tool fitted, rows fitted");
  add("after", "holdout", "calibrated, rows not fitted");
  if (!e.value("wrong_rows", Json::array()).empty())
    add("after", "holdout_all_rows", "the same with the rows that are wrong");
  add("after", "train", "calibrated, rows fitted");
  return html::table(table);
}

html::Section errors(const Json& e) {
  std::string body = "<div class=\"two\">" +
                     html::figure("histogram", "Errors before and after", error_histogram(e),
                                  "How many poses have which error. Every pose is judged by a fit that did not see it, "
                                  "where rows were held out. The last bar takes what lies beyond.") +
                     "<div>" + error_table(e, "errors", fmt::format("Error of {} [mm]", headline(e).what), "", mm, 4);
  if (e.at("after").contains("orientation_rad"))
    body +=
        error_table(e, "orientation-errors", "Error of the tool's orientation [°]", "orientation_rad", 1.0 / degree, 4);
  body += "</div></div>" +
          html::figure(
              "per-pose", "Pose by pose", errors_per_pose(e),
              "In the order of the file, so that a drift or a change of the set-up would show. Choose a dot to see "
              "the pose in the machine above.");
  return {"errors", "How good it is",
          fmt::format("Rows were kept aside: {}. The figures on rows that were not fitted are the ones to trust.",
                      html::escape(string_at(e, "holdout"))),
          body};
}

struct Shown {
  double factor;
  const char* unit;
  int decimals;
};
Shown shown(const std::string& unit) {
  if (unit == "m") return {mm, "mm", 4};
  if (unit == "rad") return {1.0 / degree, "°", 5};
  return {1.0, unit.c_str(), 8};
}

Cell state_of(const Json& parameter) {
  if (!parameter.at("identifiable").get<bool>()) return html::undetermined_cell("not determined");
  return html::text(string_at(parameter, "name").starts_with("base_") ? "placement" : "");
}

std::string parameter_table(const Json& e) {
  html::Table table{.name = "parameters",
                    .caption = "Parameters of the model: nominal, corrected, change ± one standard deviation",
                    .head = {"Parameter", "nominal", "corrected", "change", "±", "unit", "change / ±", ""},
                    .rows = {},
                    .long_after = 60};
  for (const Json& p : e.at("parameters")) {
    const std::string unit = p.at("unit");
    const auto [factor, unit_name, decimals] = shown(unit);
    const double nominal = p.at("nominal"), value = p.at("value"), sd = p.at("sd");
    table.rows.push_back({{fmt::format("<b>{}</b>", html::escape(string_at(p, "name"))), string_at(p, "name"), "name"},
                          html::number(nominal, factor, decimals),
                          html::number(value, factor, decimals),
                          html::number(value - nominal, factor, decimals),
                          html::number(sd, factor, decimals),
                          html::text(unit_name),
                          html::number(sd > 0 ? (value - nominal) / sd : NAN, 1),
                          state_of(p)});
  }
  return html::table(table);
}

std::string confounded_list(const Json& e) {
  std::vector<std::string> items;
  for (const Json& words : e.at("confounded")) items.push_back(html::escape(words.get<std::string>()));
  return items.empty() ? "<p>Every parameter can be told from every other.</p>"
                       : "<h3>What these poses cannot tell apart</h3>" + html::list(items, "open");
}

html::Section parameters(const Json& e) {
  return {
      "parameters-section", "What was corrected",
      "The numbers that now stand in <code>chain.toml</code>. A change many times its ± is real; a parameter that is "
      "<i>not determined</i> stayed close to its nominal value because these poses do not tell it; "
      "<i>placement</i> is where the robot stands in the instrument's frame, no error of the robot.",
      parameter_table(e)};
}

html::Section uncertainty(const Json& e) {
  std::string body =
      html::figure(
          "workspace", "Where the model is uncertain", workspace_map(e),
          "Expected error of the corrected model (without the instrument's scatter) at 500 places that fill the "
          "joint ranges of the data evenly. Far outside of the measured poses nothing is promised.") +
      "<div class=\"two\">" +
      html::figure(
          "singular", "What the data know", singular_value_plot(e),
          "Each dot is one independent combination of parameters, in units of what the tolerances allow. Above "
          "the line the data know it better than the data sheet does; below, the data sheet's value is kept.") +
      "<div>" + confounded_list(e) + "</div></div>";
  if (const std::string map = correlation_map(e); !map.empty())
    body +=
        "<details><summary>Correlation of the parameters</summary>" +
        html::figure("correlation", "Correlation", map,
                     "Strong colours: two parameters whose errors go together, so that only their combination is well "
                     "known. This is normal, and harmless for the tool's position where poses were measured.") +
        "</details>";
  return {"uncertainty", "What is uncertain", "How far to trust the corrected model, and where.", body};
}

html::Section ladder(const Json& e) {
  html::Table table{.name = "model",
                    .caption = "Models that were tried; error [mm]",
                    .head = {"Model", "mean, fitted", "mean, not fitted", "worst, not fitted", "", "Why"},
                    .rows = {}};
  for (const Json& rung : e.at("model").at("rungs")) {
    const bool tried = rung.contains("holdout");
    const auto figure = [&](const char* side, const char* which) {
      return tried ? html::number(rung.at(side).at(which), mm, 4) : html::number(NAN, 4);
    };
    const std::string adds = string_at(rung, "adds");
    table.rows.push_back({{fmt::format("<b>{}</b>{}", html::escape(string_at(rung, "name")),
                                       adds.empty() ? "" : "<br><small>" + html::escape(adds) + "</small>"),
                           string_at(rung, "name")},
                          figure("train", "mean"),
                          figure("holdout", "mean"),
                          figure("holdout", "max"),
                          html::text(rung.value("chosen", false) ? "taken"
                                     : tried                     ? ""
                                                                 : "not tried"),
                          html::text(string_at(rung, "why"))});
  }
  return {"model-section", "Which model",
          "From simple to rich, each on top of the ones taken before it. A richer model is only taken where poses that "
          "were "
          "not fitted get better, and the worst of them no worse.",
          ladder_plot(e) + html::table(table)};
}

/// Findings of the diagnosis before the fit.
std::string findings_table(const Json& e) {
  html::Table table{.name = "findings",
                    .caption = "What was noticed in the data before the fit",
                    .head = {"", "What", "rows (from 0)", "What to do"},
                    .rows = {}};
  const auto list = e.find("findings");
  if (list == e.end()) return "";
  for (const Json& f : *list) {
    std::string rows;
    const std::vector<double> all = numbers(f.value("rows", Json::array()));
    for (std::size_t i = 0; i < std::min<std::size_t>(all.size(), 8); ++i)
      rows += fmt::format("{}{}", i > 0 ? ", " : "", html::fixed(all[i], 0));
    if (all.size() > 8) rows += fmt::format(" and {} more", all.size() - 8);
    table.rows.push_back({html::text(string_at(f, "severity")), html::text(string_at(f, "sentence")), html::text(rows),
                          html::text(f.value("applied", false) ? "was put right" : string_at(f, "suggestion"))});
  }
  return table.rows.empty() ? "" : html::table(table);
}

html::Section doubts(const Json& e) {
  html::Table outliers{.name = "outliers",
                       .caption = "Rows that were not believed",
                       .head = {"row (from 0)", "line of the file", "why"},
                       .rows = {}};
  for (const Json& o : e.at("outliers"))
    outliers.rows.push_back({html::number(o.at("row").get<double>(), 0), html::number(o.at("line").get<double>(), 0),
                             html::text(string_at(o, "reason"))});
  std::vector<std::string> notes;
  for (const Json& note : e.at("notes")) notes.push_back(html::escape(note.get<std::string>()));
  std::string body = outliers.rows.empty() ? "<p>Every row is believed.</p>" : html::table(outliers);
  body += findings_table(e);
  if (!notes.empty()) body += "<h3>Noticed</h3>" + html::list(notes);
  return {"doubts", "What looked wrong", "Rows and readings that do not fit, and what was done about them.", body};
}

html::Section search(const Json& e) {
  const Json& s = e.at("search");
  std::string body = fmt::format("<p>{}: {} iterations, {} evaluations, {}.</p>", html::escape(string_at(s, "engine")),
                                 s.at("iterations").get<int>(), s.at("evaluations").get<int>(),
                                 html::escape(string_at(s, "stop_words")));
  if (s.at("median").size() > 1)
    body +=
        html::figure("convergence", "Convergence", convergence_plot(s.at("best"), s.at("median"), "the search"),
                     "<i class=\"key after\"></i> best of the population, <i class=\"key before\"></i> its median.");
  if (s.contains("side_by_side")) {
    html::Table table{.name = "starts",
                      .caption = "The same problem from several starts",
                      .head = {"start", "iterations to the optimum", "evaluations", "rms at the end [mm]"},
                      .rows = {}};
    for (const Json& run : s.at("side_by_side"))
      table.rows.push_back({html::text(string_at(run, "start")),
                            run.at("iterations").is_null() ? html::text("not reached")
                                                           : html::number(run.at("iterations").get<double>(), 0),
                            html::number(run.at("evaluations").get<double>(), 0), html::number(run.at("rms"), mm, 5)});
    body += html::table(table);
  }
  return {"search", "How it was found", "The method and its way to the answer.", body};
}

html::Section words() {
  return glossary_section({
      {"not fitted, held out", "Poses that the fit never saw. Only they tell how good the model is on the next pose."},
      {"cross-validation", "The poses are cut into parts; each part is judged by a fit to the others."},
      {"base and tool", "Where the robot stands in the instrument's frame, and where the target sits on the flange."},
      {"a, alpha, d, theta, beta",
       "The five numbers from one joint axis to the next (Denavit and Hartenberg; beta is Hayati's turn for nearly "
       "parallel "
       "axes). The number behind the letter is the joint's row, from 1."},
      {"gain, compliance", "Turn of the joint per turn of its reading; turn per torque of gravity."},
      {"±, sd", "One standard deviation of what is not known about the number."},
      {"not determined", "These poses do not tell the number better than the data sheet's tolerance does."},
      {"rms", "Root of the mean square: weighs large errors more than the mean does."},
  });
}

}  // namespace

Page calibration(const Json& e) {
  Page page{.title = "Calibration of " + string_at(e, "robot", "a robot"), .first = first_screen(e), .sections = {}};
  page.first += cards({{"How good is it?", how_good(e)},
                       {"What is uncertain?", how_uncertain(e)},
                       {"What to do next?", advice_list(e, 3)}});
  page.sections = {errors(e), parameters(e), uncertainty(e), ladder(e), doubts(e)};
  page.sections.push_back(search(e));
  page.sections.push_back(next_section(e));
  page.sections.push_back(words());
  page.sections.push_back(repeat_section(e));
  return page;
}

}  // namespace kinfer::pages
