// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/options/zero_argument.hpp"

#include <algorithm>

#include "kinfer/io/text/csv.hpp"
#include "kinfer/io/text/units.hpp"

namespace kinfer::cli {
namespace {

struct PhysicalValue {
  double value = 0.0;  ///< SI
  Dimension dimension = Dimension::one;
};

/// "-30deg", "1.2 s".
std::optional<PhysicalValue> parse_physical_value(std::string_view text) {
  const std::size_t end = text.find_last_of("0123456789.");
  if (end == std::string_view::npos) return std::nullopt;
  const auto number = parse_number(text.substr(0, end + 1));
  std::string_view unit_text = text.substr(end + 1);
  while (!unit_text.empty() && unit_text.front() == ' ') unit_text.remove_prefix(1);
  const auto unit = find_unit(unit_text);
  if (!number || !unit) return std::nullopt;
  return PhysicalValue{*number * unit->factor, unit->dimension};
}

Result<identify::NamedZero> parse_zero(const std::string& text) {
  const auto malformed = [&](const char* what) {
    return error("--zero {}: {}, as swing=0deg@12.5s or mast=250mm@3s", text, what);
  };
  const std::size_t equals = text.rfind('='), at = text.rfind('@');
  if (equals == std::string::npos || at == std::string::npos || equals == 0 || at < equals)
    return malformed("expected a joint, its position and the time at which it had it");
  const auto position = parse_physical_value(std::string_view(text).substr(equals + 1, at - equals - 1));
  if (!position || (position->dimension != Dimension::angle && position->dimension != Dimension::length))
    return malformed("the position needs a unit, deg or rad or mm or m");
  const auto time = parse_physical_value(std::string_view(text).substr(at + 1));
  if (!time || time->dimension != Dimension::time) return malformed("the time needs its unit, s");
  return identify::NamedZero{.joint = text.substr(0, equals),
                             .position = position->value,
                             .motion = position->dimension == Dimension::angle ? elementary::Motion::rotation
                                                                               : elementary::Motion::translation,
                             .at = time->value};
}

}  // namespace

Result<std::vector<identify::NamedZero>> parse_zeros(const std::string& text) {
  std::vector<identify::NamedZero> zeros;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    KINFER_TRY(zero, parse_zero(text.substr(begin, end - begin)));
    zeros.push_back(std::move(zero));
    begin = end + 1;
  }
  return zeros;
}

}  // namespace kinfer::cli
