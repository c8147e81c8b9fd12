// What is wrong with a pose set or a recording, found before any fit is believed, and what was done about it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinfer {

enum class Severity {
  note,     ///< worth knowing; the result stands
  warning,  ///< costs accuracy, or a few rows
  fault,    ///< spoils the result unless it is put right
};

/// "note", "warning", "fault"
constexpr std::string_view name(Severity severity) {
  return severity == Severity::note ? "note" : severity == Severity::warning ? "warning" : "fault";
}

struct Finding {
  std::string kind{};  ///< a stable word for programs: "rows_shifted"
  Severity severity = Severity::warning;
  std::vector<int> rows{};   ///< from 0; empty: the whole set
  std::vector<int> lines{};  ///< of these rows in the file, from 1
  std::string sentence{};    ///< what was seen
  std::string suggestion{};  ///< what the user can do about it; may be empty
  bool applied = false;      ///< certain, and put right before the fit
};

}  // namespace kinfer
