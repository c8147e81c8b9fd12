// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/text/table_format.hpp"

namespace kinfer {
namespace {

char read_character(TableReader& file, std::string_view key) {
  std::string text = file.text_or(key, "auto");
  if (text == "auto") return automatic;
  if (text == "tab") text = "\t";
  if (text == "spaces") return blanks;
  if (text.size() == 1) return text.front();
  file.report_error(file.line_of(key), fmt::format("\"{}\": expected one character, found \"{}\"", key, text));
  return automatic;
}

int read_skip_lines(TableReader& file) {
  const double lines = file.number_or("skip_lines", 0.0);
  if (lines >= 0 && lines <= 1e6 && lines == static_cast<int>(lines)) return static_cast<int>(lines);
  file.report_error(file.line_of("skip_lines"), "\"skip_lines\": expected a whole number from 0");
  return 0;
}

}  // namespace

CsvFormat read_table_format(TableReader& file) {
  CsvFormat format;
  format.delimiter = read_character(file, "delimiter");
  format.decimal = read_character(file, "decimal");
  if (format.decimal != '.' && format.decimal != ',' && format.decimal != automatic)
    file.report_error(file.line_of("decimal"), "\"decimal\": expected \".\" or \",\"");
  if (format.decimal == format.delimiter && format.decimal != automatic)
    file.report_error(file.line_of("decimal"), "\"decimal\" and \"delimiter\" are the same character");
  format.skip_lines = read_skip_lines(file);
  if (const std::string comment = file.text_or("comment", ""); !comment.empty()) format.comments = {comment};
  format.only = file.text_or("only", "");
  format.end = file.text_or("end", "");
  format.header_word = file.text_or("header", "");
  if (format.header_word == "none")
    format.header_line = HeaderLine::none;
  else if (!format.header_word.empty())
    format.header_line = HeaderLine::with_word;
  return format;
}

}  // namespace kinfer
