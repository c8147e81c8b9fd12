// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/mjcf/mjcf_attributes.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

#include "kinfer/io/robot/xml/xml_names.hpp"

namespace kinfer {
namespace {

constexpr double least_direction = 1e-9;  // [1] a shorter axis is zeros

/// Numbers separated by spaces; none where a word is no number.
std::optional<std::vector<double>> split_numbers(std::string_view text) {
  constexpr std::string_view spaces = " \t\r\n";
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(spaces); at < text.size(); at = text.find_first_not_of(spaces, at)) {
    const std::size_t end = std::min(text.find_first_of(spaces, at), text.size());
    const char *first = text.data() + at + (text[at] == '+' ? 1 : 0), *last = text.data() + end;
    double value = 0.0;
    const auto [after, code] = std::from_chars(first, last, value);
    if (code != std::errc{} || after != last) return std::nullopt;
    numbers.push_back(value);
    at = end;
  }
  return numbers;
}

bool are_finite(const std::vector<double>& numbers) {
  for (const double number : numbers)
    if (!std::isfinite(number)) return false;
  return true;
}

}  // namespace

MjcfAttributes::MjcfAttributes(const tinyxml2::XMLElement& element, const std::string& child_class,
                               const MjcfDefaults& defaults, const MjcfUnits& units, FirstError& first_error,
                               const char* kind)
    : element_(element),
      class_(element.Attribute("class") ? element.Attribute("class") : child_class),
      kind_(*kind ? kind : element.Name()),
      defaults_(defaults),
      units_(units),
      first_error_(first_error) {
  expect_class(class_);
}

void MjcfAttributes::expect_class(const std::string& name) const {
  if (!name.empty() && !defaults_.has_class(name)) report(fmt::format("default class \"{}\" does not exist", name));
}

const char* MjcfAttributes::find(const char* key) const {
  if (const char* own = element_.Attribute(key)) return own;
  return defaults_.find(class_, kind_, key);
}

std::string MjcfAttributes::text_or(const char* key, const std::string& otherwise) const {
  const char* text = find(key);
  return text ? text : otherwise;
}

std::string MjcfAttributes::name(const char* key) const {
  return name_from_xml(text_or(key, ""));
}

std::optional<std::vector<double>> MjcfAttributes::numbers(const char* key, std::size_t count) const {
  return numbers(key, count, count);
}

std::optional<std::vector<double>> MjcfAttributes::numbers(const char* key, std::size_t least, std::size_t most) const {
  const char* text = find(key);
  if (!text) return std::nullopt;
  auto values = split_numbers(text);
  if (!values || values->size() < least || values->size() > most) {
    const std::string expected = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    report(fmt::format("{}=\"{}\": expected {} number{}", key, text, expected, most == 1 ? "" : "s"));
    return std::nullopt;
  }
  if (are_finite(*values)) return values;
  report(fmt::format("{}=\"{}\": a number is not finite", key, text));
  return std::nullopt;
}

double MjcfAttributes::number(const char* key, double otherwise) const {
  const auto values = numbers(key, 1);
  return values ? values->front() : otherwise;
}

Vec3 MjcfAttributes::vector(const char* key, const Vec3& otherwise) const {
  const auto values = numbers(key, 3);
  return values ? Vec3(values->data()) : otherwise;
}

Vec3 MjcfAttributes::direction(const char* key, const Vec3& otherwise) const {
  const Vec3 v = vector(key, otherwise);
  if (v.stableNorm() > least_direction) return v.stableNormalized();
  report(fmt::format("{} is zeros, expected a direction", key));
  return otherwise;
}

/// The element's own orientation; where it has none, that of its class.
MjcfOrientation MjcfAttributes::orientation_kind() const {
  MjcfOrientation own = MjcfOrientation::none, inherited = MjcfOrientation::none;
  for (const MjcfOrientationTraits& row : mjcf_orientations) {
    if (element_.Attribute(row.attribute)) {
      if (own != MjcfOrientation::none) report("more than one orientation, expected one");
      own = row.kind;
    } else if (defaults_.find(class_, kind_, row.attribute)) {
      inherited = row.kind;
    }
  }
  return own != MjcfOrientation::none ? own : inherited;
}

MjcfPlacement MjcfAttributes::placement() const {
  MjcfPlacement placement{.pose = {Mat3::Identity(), vector("pos", Vec3::Zero())}};
  const MjcfOrientation kind = orientation_kind();
  if (kind == MjcfOrientation::none) return placement;
  const MjcfOrientationTraits& row = mjcf_orientations[static_cast<std::size_t>(kind) - 1];
  auto values = numbers(row.attribute, row.numbers);
  if (!values) return placement;
  const auto rotation = rotation_of(kind, *values, units_);
  if (!rotation) {
    report(fmt::format("{}=\"{}\" gives no direction", row.attribute, text_or(row.attribute, "")));
    return placement;
  }
  placement.pose.rotation = *rotation;
  placement.orientation = kind;
  placement.numbers = std::move(*values);
  return placement;
}

std::string MjcfAttributes::who() const {
  const char* name = element_.Attribute("name");
  return name ? fmt::format("{} \"{}\"", element_.Name(), name) : fmt::format("a <{}>", element_.Name());
}

void MjcfAttributes::report(const std::string& sentence) const {
  first_error_.report(element_.GetLineNum(), fmt::format("{}: {}", who(), sentence));
}

}  // namespace kinfer
