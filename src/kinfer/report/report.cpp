// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/report.hpp"

#include <fmt/format.h>

#include "kinfer/io/evidence/evidence_file.hpp"
#include "kinfer/report/bundle.hpp"
#include "kinfer/report/calibrate/page.hpp"
#include "kinfer/report/fleet/page.hpp"
#include "kinfer/report/fleet/table_data.hpp"
#include "kinfer/report/identify/page.hpp"
#include "kinfer/report/parts/script_data.hpp"
#include "kinfer/report/track/page.hpp"

namespace kinfer::report {
namespace {

std::string contents(const std::vector<html::Section>& sections) {
  std::string links;
  for (const html::Section& s : sections) links += fmt::format("<a href=\"#{}\">{}</a>", s.id, s.title);
  return links;
}

/// Content security policy: nothing is fetched.
constexpr std::string_view content_security_policy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:";

std::string page_html(const Page& page, const std::string& data, std::string_view source = "evidence.json") {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      content_security_policy, html::escape(page.title), report_style());
  html += fmt::format(
      "<a class=\"skip\" href=\"#main\">Skip to the report</a>\n<header class=\"bar\"><b>kinfer</b>"
      "<nav aria-label=\"Sections\">{}</nav></header>\n<main id=\"main\">\n<div class=\"first\">{}</div>\n",
      contents(page.sections), page.first);
  for (const html::Section& section : page.sections) html += html::section(section);
  html += fmt::format(
      "</main>\n<footer>Made by kinfer from {}.</footer>\n"
      "<script type=\"application/json\" id=\"evidence\">{}</script>\n<script>{}</script>\n</body>\n</html>\n",
      source, escape_for_script(data), report_script());
  return html;
}

}  // namespace

std::string report_html(const CalibrationEvidence& evidence) {
  return page_html(calibration_page(evidence), script_data(evidence));
}

std::string report_html(const IdentificationEvidence& evidence) {
  return page_html(identification_page(evidence), script_data(evidence));
}

std::string report_html(const TrackRun& run) {
  return page_html(track_page(run), "{\"kind\":\"track\"}");
}

std::string report_html(const Fleet& fleet) {
  return page_html(fleet_page(fleet), fleet_table_data(fleet), "table.csv and fleet.json");
}

Result<std::string> report_of_file(std::string_view text) {
  KINFER_TRY(evidence, read_evidence(text));
  if (const auto* calibration = std::get_if<CalibrationEvidence>(&evidence)) return report_html(*calibration);
  if (const auto* identification = std::get_if<IdentificationEvidence>(&evidence)) return report_html(*identification);
  if (const auto* run = std::get_if<TrackRun>(&evidence)) return report_html(*run);
  return error("evidence.json: there is no report for kind 'frames'");
}

}  // namespace kinfer::report
