// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/identify/page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/report/identify/figures.hpp"
#include "kinfer/report/identify/sections.hpp"
#include "kinfer/report/identify/unobservable.hpp"
#include "kinfer/report/parts/shared_sections.hpp"
#include "kinfer/report/parts/units.hpp"
#include "kinfer/report/parts/verdict_block.hpp"

namespace kinfer::report {
namespace {

constexpr double safe_order_margin = 2.0;

std::string facts(const IdentificationEvidence& e) {
  const std::vector<double>& time = e.motion.time;
  const double seconds = time.empty() ? 0.0 : time.back() - time.front();
  return fmt::format(
      "<dl class=\"facts\"><dt>Inertial sensors (INS)</dt><dd>{}</dd><dt>Log</dt><dd>{} "
      "s</dd><dt>Root</dt><dd>{}</dd></dl>",
      e.order.sensors.size(), html::fixed(seconds, 0), html::escape(e.root));
}

std::string first_screen(const IdentificationEvidence& e) {
  const std::string figure = residual_drawing(e);
  const char* words =
      "<p class=\"note\"><i>Motion</i> is the rms acceleration of the segment that is predicted worst; <i>residual</i> "
      "is the part that the identified chain does not explain.</p>";
  return "<div class=\"say\">" + verdict_block(e.verdict, "Identification of a machine from its INS logs") + figure +
         (figure.empty() ? "" : words) + facts(e) +
         "</div><div class=\"machine\" id=\"machine\"><div class=\"still\">" + identified_machine_drawing(e) +
         "</div></div>";
}

/// Largest standard deviations of the joint axes. The azimuth of the forecast is listed separately, with what is
/// uncertain.
std::string axis_accuracy(const std::vector<JointForecast>& forecast) {
  double line = 0.0, direction = 0.0;
  for (const JointForecast& f : forecast) {
    if (!is_determined(f)) continue;  // its own row says so
    line = std::max(line, f.line_sd);
    direction = std::max(direction, f.direction_sd);
  }
  if (line == 0.0) return "";
  return fmt::format(
      "<p>The axes of the joints are known to ±&nbsp;<b>{}&nbsp;mm</b> and ±&nbsp;<b>{}&nbsp;mrad</b> or better (one "
      "standard deviation), "
      "apart from what is listed as uncertain.</p>",
      html::fixed(mm * line, 1), html::fixed(mrad * direction, 2));
}

std::string order_safety(const OrderEvidence& order) {
  const std::optional<double>& margin = order.margin;
  if (!margin) return "<p>The order of the segments is safe: no other order is possible.</p>";
  return fmt::format("<p>The order of the segments is {}: the next best order fits {} times worse.</p>",
                     *margin >= safe_order_margin ? "safe" : "<b>not safe</b>", html::short_number(*margin));
}

std::string how_good(const IdentificationEvidence& e) {
  return fmt::format("<p><b class=\"big\">{} joints</b> between {} segments; the root is {}.</p>", e.joints.size(),
                     e.order.sensors.size(), html::escape(e.root)) +
         axis_accuracy(e.forecast) + order_safety(e.order);
}

std::string how_uncertain(const IdentificationEvidence& e) {
  constexpr std::size_t most = 4;
  std::vector<std::string> items = uncertain_items(e);
  const std::size_t all = items.size();
  if (all == 0)
    return "<p>Every required quantity is observable from this recording; its uncertainty is the ± beside it.</p>";
  if (all > most) items.resize(most);
  std::string text =
      "<p>These quantities are weakly observable or unobservable. Unobservable directions are drawn dashed.</p>" +
      html::list(items, "open");
  if (all > most) text += fmt::format("<p><a href=\"#unknown\">and {} more</a></p>", all - most);
  return text;
}

html::Section identification_glossary() {
  return glossary_section({
      {"INS",
       "Inertial sensor: accelerometers, gyroscopes and often a magnetometer; one on each segment, in any mounting."},
      {"root", "The segment that all others descend from, usually the stationary one."},
      {"axis, point",
       "A joint is a line: its direction and one of its points. Of the points, the one nearest to the child's INS is "
       "given."},
      {"DH, theta, d, a, alpha",
       "Four numbers from one axis to the next (Denavit and Hartenberg); beta is Hayati's rotation for "
       "nearly parallel axes."},
      {"± , sd", "One standard deviation of the number."},
      {"not determinable", "Unobservable from this recording: no measurement depends on the number."},
      {"margin", "How many times worse the next best tree of segments fits."},
      {"not fitted",
       "Parts of the log that were not used for the fit. Only their residuals show how accurate the chain is."},
      {"rms", "Root of the mean square: weighs large errors more than the mean does."},
  });
}

}  // namespace

Page identification_page(const IdentificationEvidence& e) {
  Page page{.title = "Identification of a machine", .first = first_screen(e), .sections = {}};
  page.first += cards({{"How good is it?", how_good(e)},
                       {"What is uncertain?", how_uncertain(e)},
                       {"What to do next?", advice_list(e.next, 3)}});
  page.sections = {joints_section(e), order_section(e), dh_section(e), fit_section(e), unobservable_section(e)};
  if (e.update) page.sections.insert(page.sections.begin(), update_section(e));
  if (!e.findings.empty()) page.sections.push_back(recording_section(e));
  for (html::Section section : {search_section(e), next_section(e.next), identification_glossary(),
                                repeat_section(e.provenance), notices_section()})
    page.sections.push_back(std::move(section));
  return page;
}

}  // namespace kinfer::report
