// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "kinfer/base/angle.hpp"
#include "kinfer/report/identify/figures.hpp"
#include "kinfer/report/parts/pages.hpp"

namespace kinfer::pages {
namespace {

using Json = nlohmann::json;
using html::Cell;

constexpr double mm = 1e3, mrad = 1e3;
constexpr double unobservable_length = 0.5,
                 unobservable_angle = 0.5;  // [m], [rad] sd from which a value counts as unobservable

double across(const Json& sd) {
  return std::hypot(sd.at(0).get<double>(), sd.at(1).get<double>());
}

std::string facts(const Json& e) {
  const Json& time = e.at("motion").at("time");
  const double seconds = time.empty() ? 0.0 : time.back().get<double>() - time.front().get<double>();
  return fmt::format(
      "<dl class=\"facts\"><dt>Inertial sensors (INS)</dt><dd>{}</dd><dt>Log</dt><dd>{} "
      "s</dd><dt>Root</dt><dd>{}</dd></dl>",
      e.at("order").at("sensors").size(), html::fixed(seconds, 0), html::escape(string_at(e, "root")));
}

std::string first_screen(const Json& e) {
  const std::string figure = residual_drawing(e);
  const char* words =
      "<p class=\"note\"><i>Motion</i> is the rms acceleration of the segment that is predicted worst; <i>left</i> is "
      "what "
      "the found chain does not explain of it.</p>";
  return "<div class=\"say\">" + verdict_block(e, "Identification of a machine from its INS logs") + figure +
         (figure.empty() ? "" : words) + facts(e) +
         "</div><div class=\"machine\" id=\"machine\"><div class=\"still\">" + identified_machine_drawing(e) +
         "</div></div>";
}

/// Largest standard deviations of the joint axes. The azimuth of the forecast is listed separately, with what is
/// uncertain.
std::string axis_accuracy(const Json& e) {
  double line = 0.0, direction = 0.0;
  for (const Json& f : member(e, "forecast")) {
    line = std::max(line, f.at("line_sd_m").get<double>());
    direction = std::max(direction, f.at("direction_sd_rad").get<double>());
  }
  if (line == 0.0) return "";
  return fmt::format(
      "<p>The axes of the joints are known to ±&nbsp;<b>{}&nbsp;mm</b> and ±&nbsp;<b>{}&nbsp;mrad</b> or better (one "
      "standard deviation), "
      "apart from what is listed as uncertain.</p>",
      html::fixed(mm * line, 1), html::fixed(mrad * direction, 2));
}

std::string how_good(const Json& e) {
  std::string text =
      fmt::format("<p><b class=\"big\">{} joints</b> between {} segments; the root is {}.</p>", e.at("joints").size(),
                  e.at("order").at("sensors").size(), html::escape(string_at(e, "root")));
  text += axis_accuracy(e);
  const Json& margin = e.at("order").at("margin");
  if (margin.is_number())
    text += fmt::format("<p>The order of the segments is {}: the next best order fits {} times worse.</p>",
                        margin.get<double>() >= 2.0 ? "safe" : "<b>not safe</b>", html::short_number(margin));
  return text;
}

/// True if something that the user needs is unobservable: a direction or an azimuth. The point along the axis and the
/// split of an offset between parallel axes are free choices and do not count.
bool has_unobservable_direction(const Json& joint) {
  return !joint.at("not_identifiable_in_parent").empty() || !joint.at("not_identifiable_in_child").empty() ||
         joint.value("azimuth_undetermined", false);
}

/// The first unobservable quantity of a joint without its remedy, which the next card shows.
std::string first_unobservable(const Json& joint) {
  const Json& list = member(joint, "unobservable");
  return list.empty() ? "" : string_at(list.at(0), "what");
}

/// Sensors of the last segments (leaves of the tree).
std::vector<std::string> leaf_sensors(const Json& e) {
  std::vector<std::string> list;
  for (const Json& joint : e.at("joints"))
    if (std::ranges::none_of(
            e.at("joints"), [&](const Json& other) { return string_at(other, "parent") == string_at(joint, "child"); }))
      list.push_back(string_at(joint, "child"));
  return list;
}

std::vector<std::string> uncertain_items(const Json& e) {
  std::vector<std::string> items;
  for (const Json& f : member(e, "forecast"))
    if (const double sd = f.value("azimuth_sd_rad", 0.0); mrad * sd > 1.0)
      items.push_back(fmt::format("the turn of <b>{}</b> about its only axis: ±&nbsp;{}&nbsp;mrad",
                                  html::escape(string_at(f, "azimuth_of")), html::fixed(mrad * sd, 0)));
  for (const Json& joint : e.at("joints"))
    if (const std::string what = first_unobservable(joint); !what.empty() && has_unobservable_direction(joint))
      items.push_back(fmt::format("<b>{}–{}</b>: {}", html::escape(string_at(joint, "parent")),
                                  html::escape(string_at(joint, "child")), html::escape(what)));
  if (member(e, "places").empty())
    for (const std::string& sensor : leaf_sensors(e))
      items.push_back(fmt::format("where the tool is beyond <b>{}</b>", html::escape(sensor)));
  return items;
}

std::string how_uncertain(const Json& e) {
  constexpr std::size_t most = 4;
  std::vector<std::string> items = uncertain_items(e);
  const std::size_t all = items.size();
  if (all == 0)
    return "<p>Everything that was asked for leaves a trace in the signals; how sure it is stands beside each number "
           "as ±.</p>";
  if (all > most) items.resize(most);
  std::string text = "<p>These leave little or no trace in any signal. What leaves none is drawn dashed.</p>" +
                     html::list(items, "open");
  if (all > most) text += fmt::format("<p><a href=\"#unknown\">and {} more</a></p>", all - most);
  return text;
}

std::string vector_text(const Json& v, double scale, int decimals) {
  if (!v.is_array()) return "–";
  return fmt::format("{}&ensp;{}&ensp;{}", html::fixed(scale * v.at(0).get<double>(), decimals),
                     html::fixed(scale * v.at(1).get<double>(), decimals),
                     html::fixed(scale * v.at(2).get<double>(), decimals));
}

Cell vector_cell(const Json& v, double scale, int decimals) {
  const auto exact = [&](std::size_t k) { return fmt::format("{:.12g}", scale * v.at(k).get<double>()); };
  return {vector_text(v, scale, decimals), v.is_array() ? exact(0) + " " + exact(1) + " " + exact(2) : "", "num"};
}

Cell plus_minus(double sd, double scale, double unobservable, int decimals) {
  if (!(sd < unobservable)) return html::undetermined_cell("not determinable");
  return html::number(sd, scale, decimals);
}

/// An unobservable point is shown in brackets: it is a choice, not a measurement.
Cell point_cell(const Json& point, double sd) {
  Cell cell = vector_cell(point, mm, 1);
  if (!(sd < unobservable_length)) cell.shown = "<span class=\"note\">(" + cell.shown + ")</span>";
  return cell;
}

html::Section joints(const Json& e) {
  html::Table table{.name = "joints",
                    .caption = "Joints in the frames of the INS on both sides; point [mm]",
                    .head = {"Joint", "type", "seen by", "axis (x y z)", "± [mrad]", "point [mm] (x y z)", "± [mm]"},
                    .rows = {}};
  for (const Json& j : e.at("joints")) {
    const Json& sd = j.at("sd");
    const auto side = [&](const std::string& head, const std::string& type, const char* sensor) {
      const std::string in = std::string("_in_") + sensor;
      table.rows.push_back({html::text(head), html::text(type), html::text(string_at(j, sensor)),
                            vector_cell(j.at("axis" + in), 1.0, 5),
                            plus_minus(across(sd.at("axis" + in + "_rad")), mrad, mrad * unobservable_angle, 2),
                            point_cell(j.at("point" + in), across(sd.at("point" + in + "_m"))),
                            plus_minus(across(sd.at("point" + in + "_m")), mm, unobservable_length, 1)});
    };
    side(string_at(j, "parent") + "–" + string_at(j, "child"), string_at(j, "type"), "parent");
    side("", "", "child");
  }
  html::Table links{.name = "links",
                    .caption = "Shortest distance between the two axes of a segment [mm]",
                    .head = {"Segment", "from", "to", "length", "±"},
                    .rows = {}};
  for (const Json& link : e.at("links"))
    links.rows.push_back({html::text(string_at(link, "segment")), html::text(string_at(link, "from")),
                          html::text(string_at(link, "to")), html::number(link.at("length_m"), mm, 1),
                          plus_minus(link.at("sd_m"), mm, unobservable_length, 1)});
  return {"joints-section", "What was found",
          "Every joint as a line in space, in the frame of the INS on either side. Both points are the same physical "
          "point. A point in brackets is a choice that no signal tells.",
          html::table(table) + (links.rows.empty() ? "" : html::table(links))};
}

std::string phases_table(const Json& order) {
  html::Table table{
      .name = "phases", .caption = "Who moved when (1: moved)", .head = {"from [s]", "to [s]"}, .rows = {}};
  for (const Json& sensor : order.at("sensors")) table.head.push_back(sensor);
  for (const Json& phase : order.at("phases")) {
    std::vector<Cell> row{html::number(phase.at("begin").get<double>(), 2),
                          html::number(phase.at("end").get<double>(), 2)};
    for (const Json& moves : phase.at("moves")) row.push_back(html::number(moves.get<bool>() ? 1.0 : 0.0, 0));
    table.rows.push_back(row);
  }
  return table.rows.empty() ? "" : html::table(table);
}

std::string pairs_table(const Json& order) {
  html::Table table{.name = "pairs",
                    .caption = "How well two segments share a point",
                    .head = {"Pair", "acceleration left [m/s²]", "rate off the axis [rad/s]", ""},
                    .rows = {}};
  std::vector<Json> pairs(order.at("pairs").begin(), order.at("pairs").end());
  std::stable_sort(pairs.begin(), pairs.end(), [](const Json& a, const Json& b) {
    return a.at("residual").get<double>() < b.at("residual").get<double>();
  });
  for (const Json& p : pairs)
    table.rows.push_back({{html::escape(string_at(p, "first") + "–" + string_at(p, "second")), {}, "name"},
                          html::number(p.at("residual").get<double>(), 4),
                          html::number(p.at("off_axis_rate").get<double>(), 4),
                          html::text(p.at("joined").get<bool>() ? "joined" : "")});
  table.long_after = 14;
  return html::table(table);
}

html::Section order(const Json& e) {
  const Json& o = e.at("order");
  const Json& margin = o.at("margin");
  const std::string comparison = margin.is_number() ? fmt::format("the next best tree fits {} times worse ({} is safe)",
                                                                  html::short_number(margin), 2)
                                                    : "there is no other tree";
  return {
      "order", "Which segment hangs on which",
      fmt::format(
          "Segments that share a joint share a point, and their INS must agree on its acceleration. The tree takes "
          "the pairs that agree best; {}. Who moved when {}.",
          comparison, o.at("phases_agree").get<bool>() ? "gives the same order" : "does not give the same order"),
      html::figure("tree", "Order of the segments", tree_drawing(e),
                   "From the root on the left outwards; below each joint, by how much the two INS disagree about the "
                   "acceleration of the point that they share.") +
          "<div class=\"two\">" + pairs_table(o) + phases_table(o) + "</div>"};
}

Cell dh_cell(double value, double sd, double scale, double unobservable, int decimals) {
  if (!(sd < unobservable))
    return {html::undetermined_cell("not determinable").shown, fmt::format("{:.12g}", scale * value), "num"};
  const std::string shown = sd > 0.0 ? fmt::format("{} <small>± {}</small>", html::fixed(scale * value, decimals),
                                                   html::fixed(scale * sd, std::max(1, decimals - 1)))
                                     : html::fixed(scale * value, decimals);
  return {shown, fmt::format("{:.12g}", scale * value), "num"};
}

html::Section dh(const Json& e) {
  html::Table table{.name = "dh",
                    .caption = "The chain as DH rows RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta)",
                    .head = {"Towards", "theta [°]", "d [mm]", "a [mm]", "alpha [°]", "beta [°]", "variable"},
                    .rows = {}};
  constexpr double deg = 1.0 / degree;
  for (const Json& row : e.at("dh")) {
    const Json& sd = row.at("sd");
    const auto angle = [&](const char* k) { return dh_cell(row.at(k), sd.at(k), deg, unobservable_angle, 3); };
    const auto length = [&](const char* k) { return dh_cell(row.at(k), sd.at(k), mm, unobservable_length, 1); };
    table.rows.push_back(
        {html::text(string_at(row, "segment")), angle("theta"), length("d"), length("a"), angle("alpha"), angle("beta"),
         html::text(string_at(row, string_at(row, "theta_variable").empty() ? "d_variable" : "theta_variable"))});
  }
  return {
      "dh-section", "DH table",
      "The rows lead from one INS to the next: to the joint's axis, across the joint (once for each of its axes), to "
      "the next INS. A number without "
      "± is a choice of the convention. <i>Not determinable</i> means that no signal tells it.",
      html::table(table)};
}

html::Section fit(const Json& e) {
  html::Table table{.name = "fit",
                    .caption = "What the chain leaves unexplained (rms)",
                    .head = {"Segment", "acceleration [m/s²]", "orientation [rad]", "acceleration, not fitted",
                             "orientation, not fitted", "rows"},
                    .rows = {}};
  const Json& holdout = e.at("fit").at("holdout");
  for (const Json& f : e.at("fit").at("jrmse")) {
    const auto held = holdout.find(string_at(f, "segment"));
    const auto unseen = [&](const char* key) {
      return held == holdout.end() ? html::text("–") : html::number(held->at(key).get<double>(), 5);
    };
    table.rows.push_back({html::text(string_at(f, "segment")), html::number(f.at("acceleration").get<double>(), 5),
                          html::number(f.at("orientation").get<double>(), 5), unseen("acceleration"),
                          unseen("orientation"), html::number(f.at("rows").get<double>(), 0)});
  }
  std::string body;
  if (!e.at("motion").at("traces").empty())
    body += fmt::format(
        "<figure><h3>Predicted and measured motion</h3><div id=\"traces\"></div>{}<figcaption>Measured, "
        "predicted and their difference; each line spans the least and the largest sample of its time, so that "
        "no spike is lost. Drag to zoom, double click to go back, click to see the machine at that "
        "time.</figcaption></figure>",
        trace_drawings(e));
  return {"fit-section", "How well it explains the motion",
          "Rows or windows that were not fitted are the ones to trust.", body + html::table(table)};
}

html::Section unobservable(const Json& e) {
  html::Table table{.name = "unknown-table", .caption = "What no signal tells", .head = {"Joint", "What"}, .rows = {}};
  for (const Json& joint : e.at("joints"))
    for (const Json& sentence : joint.at("not_identifiable"))
      table.rows.push_back({html::text(string_at(joint, "parent") + "–" + string_at(joint, "child")),
                            html::text(sentence.get<std::string>())});
  std::vector<std::string> notes;
  for (const Json& note : e.at("notes")) notes.push_back(html::escape(note.get<std::string>()));
  std::string body = table.rows.empty() ? "<p>Nothing.</p>" : html::table(table);
  if (!notes.empty()) body += "<h3>Noticed</h3>" + html::list(notes);
  return {"unknown", "What cannot be known",
          "These directions are drawn dashed in the machine above. No longer log would tell them; another kind of "
          "motion or one "
          "measurement with a tape would.",
          body};
}

html::Section search(const Json& e) {
  const Json& s = e.at("search");
  std::string figures;
  for (std::size_t i = 0; i < s.at("best").size(); ++i) {
    if (s.at("best").at(i).size() < 2) continue;
    const std::string name = s.contains("segments") && i < s.at("segments").size()
                                 ? string_at(s.at("segments").at(i), "segment")
                                 : fmt::format("part {}", i + 1);
    figures += html::figure("convergence-" + std::to_string(i), "Search of " + html::escape(name),
                            convergence_plot(s.at("best").at(i), s.at("median").at(i), name), "");
  }
  return {"search", "How it was found",
          fmt::format("Engine {}: {} evaluations. <i class=\"key after\"></i> best of the population, <i class=\"key "
                      "before\"></i> its median.",
                      html::escape(string_at(s, "engine")), s.at("evaluations").get<long long>()),
          figures.empty() ? "<p>No population was searched.</p>" : "<div class=\"two\">" + figures + "</div>"};
}

html::Section words() {
  return glossary_section({
      {"INS", "The box with accelerometers, gyros and, maybe, a magnetometer; one on each segment, mounted anyhow."},
      {"root", "The segment that all others hang on, usually the one that stands still."},
      {"axis, point",
       "A joint is a line: its direction and one of its points. Of the points, the one nearest to the child's INS is "
       "given."},
      {"DH, theta, d, a, alpha",
       "Four numbers from one axis to the next (Denavit and Hartenberg); beta is Hayati's turn for "
       "nearly parallel axes."},
      {"± , sd", "One standard deviation of what is not known about the number."},
      {"not determinable", "No signal of this drive changes with the number."},
      {"margin", "How many times worse the next best tree of segments fits."},
      {"not fitted", "Parts of the log that the fit never saw. Only they tell how good the chain is."},
      {"rms", "Root of the mean square: weighs large errors more than the mean does."},
  });
}

}  // namespace

Page identification(const Json& e) {
  Page page{.title = "Identification of a machine", .first = first_screen(e), .sections = {}};
  page.first += cards({{"How good is it?", how_good(e)},
                       {"What is uncertain?", how_uncertain(e)},
                       {"What to do next?", advice_list(e, 3)}});
  page.sections = {joints(e), order(e),        dh(e),   fit(e),           unobservable(e),
                   search(e), next_section(e), words(), repeat_section(e)};
  return page;
}

}  // namespace kinfer::pages
