// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinfer::report::html {

std::string escape(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || c == '-';
}

/// Length of "kinfer verb" or "kinfer verb --option" at the start of the text; 0 if it does not start with a command.
std::size_t length_of_call(std::string_view text) {
  constexpr std::string_view program = "kinfer ";
  if (!text.starts_with(program)) return 0;
  const auto end_of_word = [&](std::size_t from) {
    while (from < text.size() && is_letter(text[from])) ++from;
    return from;
  };
  const std::size_t verb = end_of_word(program.size());
  return text.substr(verb).starts_with(" --") ? end_of_word(verb + 1) : verb;
}

}  // namespace

std::string prose(std::string_view text) {
  std::string set;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (const std::size_t call = length_of_call(text.substr(i)); call > 0) {
      set += "<code>" + escape(text.substr(i, call)) + "</code>";
      i += call - 1;
    } else if (text[i] == ' ' && i > 0 && i + 1 < text.size() &&
               (is_digit(text[i - 1]) ? !is_digit(text[i + 1]) : set.ends_with("±"))) {
      set += "&nbsp;";
    } else {
      set += escape(text.substr(i, 1));
    }
  }
  return set;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = std::all_of(text.begin(), text.end(), [](char c) { return c == '-' || c == '0' || c == '.'; });
  if (text.front() == '-') text = is_zero ? text.substr(1) : "−" + text.substr(1);
  return text;
}

std::string short_number(double value) {
  const double size = std::abs(value);
  const int decimals = size >= 100.0 ? 0 : size >= 10.0 ? 1 : size >= 1.0 ? 2 : 3;
  return fixed(value, size > 0.0 && size < 0.01 ? 4 : decimals);
}

Cell text(std::string_view words) {
  return {escape(words)};
}

Cell number(double value, int decimals) {
  return {fixed(value, decimals), std::isfinite(value) ? fmt::format("{}", value) : "", CellKind::number};
}

Cell number(double value, double factor, int decimals) {
  return {fixed(factor * value, decimals), std::isfinite(value) ? fmt::format("{:.12g}", factor * value) : "",
          CellKind::number};
}

Cell undetermined_cell(std::string_view words) {
  return {fmt::format("<span class=\"tag open\">{}</span>", escape(words)), std::string(words), CellKind::number};
}

namespace {

std::string cell_html(const Cell& cell) {
  std::string attributes;
  if (cell.kind != CellKind::text)
    attributes += fmt::format(" class=\"{}\"", cell.kind == CellKind::number ? "num" : "name");
  if (!cell.exact.empty()) attributes += fmt::format(" data-v=\"{}\"", escape(cell.exact));
  return fmt::format("<td{}>{}</td>", attributes, cell.shown);
}

}  // namespace

std::string table(const Table& t) {
  const bool folded = t.rows.size() > t.long_after;
  std::string html =
      fmt::format("<div class=\"table{}\" data-csv=\"{}\"><div class=\"scroll\" tabindex=\"0\"><table id=\"{}\">",
                  folded               ? " folded"
                  : t.rows.size() < 15 ? " short"
                                       : "",
                  t.name, t.name);
  html += fmt::format("<caption>{}</caption><thead><tr>", escape(t.caption));
  for (std::size_t k = 0; k < t.head.size(); ++k) {
    const bool is_number = !t.rows.empty() && k < t.rows.front().size() && t.rows.front()[k].kind == CellKind::number;
    html += fmt::format("<th scope=\"col\"{}>{}</th>", is_number ? " class=\"num\"" : "", escape(t.head[k]));
  }
  html += "</tr></thead><tbody>\n";
  for (const auto& row : t.rows) {
    html += "<tr>";
    for (const Cell& cell : row) html += cell_html(cell);
    html += "</tr>\n";
  }
  return html + "</tbody></table></div></div>\n";
}

std::string figure(std::string_view id, std::string_view title, std::string_view drawing, std::string_view words) {
  if (drawing.empty()) return "";
  return fmt::format("<figure id=\"{}\"><h3>{}</h3>{}<figcaption>{}</figcaption></figure>\n", id, title, drawing,
                     words);
}

std::string section(const Section& s) {
  return fmt::format(
      "<section id=\"{}\" aria-labelledby=\"{}-title\"><h2 id=\"{}-title\">{}</h2>\n<p "
      "class=\"lead\">{}</p>\n{}</section>\n",
      s.id, s.id, s.id, s.title, s.lead, s.body);
}

std::string legend(const std::vector<std::pair<const char*, const char*>>& entries) {
  std::string text = "<p class=\"legend\">";
  for (const auto& [kind, meaning] : entries) text += fmt::format("<span><i class=\"{}\"></i>{}</span>", kind, meaning);
  return text + "</p>";
}

std::string list(const std::vector<std::string>& items, std::string_view kind) {
  if (items.empty()) return "";
  std::string html = kind.empty() ? "<ul>" : fmt::format("<ul class=\"{}\">", kind);
  for (const std::string& item : items) html += fmt::format("<li>{}</li>", item);
  return html + "</ul>\n";
}

}  // namespace kinfer::report::html
