// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "kinfer/report/bundle.hpp"
#include "kinfer/report/parts/packed.hpp"
#include "kinfer/report/parts/pages.hpp"

namespace kinfer {
namespace {

using Json = nlohmann::json;

/// Escapes JSON inside a script element, so that it cannot close the element.
std::string escape_for_script(std::string text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

/// Lengths rounded to 0.1 µm, sufficient for drawings and tooltips.
Json rounded(const Json& list) {
  Json result = Json::array();
  for (const Json& value : list)
    result.push_back(value.is_number() ? Json(std::round(value.get<double>() * 1e7) / 1e7) : value);
  return result;
}

/// The part of the evidence that the scripts need; everything else is in the page as text.
Json script_data(const Json& evidence) {
  Json part;
  for (const char* key : {"kind", "outliers", "picture", "root", "joints", "chain", "order"})
    if (evidence.contains(key)) part[key] = evidence.at(key);
  if (evidence.contains("motion")) part["motion"] = pages::with_packed_traces(evidence.at("motion"));
  if (const auto rows = evidence.find("rows"); rows != evidence.end()) {
    for (const char* key : {"before", "after"}) part["rows"][key] = rounded(rows->at(key));
    part["rows"]["held_out"] = rows->at("held_out");
  }
  return part;
}

std::string contents(const std::vector<html::Section>& sections) {
  std::string links;
  for (const html::Section& s : sections) links += fmt::format("<a href=\"#{}\">{}</a>", s.id, s.title);
  return links;
}

/// Content security policy: nothing is fetched.
constexpr std::string_view content_security_policy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:";

std::string page_html(const pages::Page& page, const Json& evidence) {
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
      "</main>\n<footer>Made by kinfer from evidence.json.</footer>\n"
      "<script type=\"application/json\" id=\"evidence\">{}</script>\n<script>{}</script>\n</body>\n</html>\n",
      escape_for_script(script_data(evidence).dump()), report_script());
  return html;
}

Result<pages::Page> page_of(const Json& evidence) {
  const std::string kind = pages::string_at(evidence, "kind");
  if (kind == "calibrate") return pages::calibration(evidence);
  if (kind == "identify") return pages::identification(evidence);
  return error("evidence.json: there is no report for kind '{}'", kind);
}

}  // namespace

Result<std::string> report_html(std::string_view text) {
  const Json evidence = Json::parse(text, nullptr, false);
  if (!evidence.is_object()) return error("evidence.json: not a JSON object");
  try {
    KINFER_TRY(page, page_of(evidence));
    return page_html(page, evidence);
  } catch (const Json::exception& malformed) {
    return error("evidence.json: not in kinfer's format ({})", malformed.what());
  }
}

}  // namespace kinfer
