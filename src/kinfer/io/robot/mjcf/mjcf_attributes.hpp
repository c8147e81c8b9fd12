// SPDX-License-Identifier: Apache-2.0
// The attributes of one MJCF element: its own, else those of its default class.
#pragma once

#include <tinyxml2.h>

#include <optional>
#include <string>
#include <vector>

#include "kinfer/geometry/pose.hpp"
#include "kinfer/io/robot/mjcf/mjcf_defaults.hpp"
#include "kinfer/io/robot/mjcf/mjcf_orientation.hpp"

namespace kinfer {

struct MjcfPlacement {
  Pose pose;  ///< in what surrounds the element
  MjcfOrientation orientation = MjcfOrientation::none;
  std::vector<double> numbers{};  ///< of the orientation, as they stand in the file
};

/// What is wrong is reported to `first_error`, and replaced by the default.
class MjcfAttributes {
 public:
  /// `child_class`: of the bodies and frames around; the element's own class takes precedence. `kind`: its name among
  /// the defaults; empty: the element's own name.
  MjcfAttributes(const tinyxml2::XMLElement& element, const std::string& child_class, const MjcfDefaults& defaults,
                 const MjcfUnits& units, FirstError& first_error, const char* kind = "");

  std::string text_or(const char* key, const std::string& otherwise) const;
  std::string name(const char* key) const;  ///< as name_from_xml gives it; empty where there is none
  double number(const char* key, double otherwise) const;
  Vec3 vector(const char* key, const Vec3& otherwise) const;
  Vec3 direction(const char* key, const Vec3& otherwise) const;  ///< unit

  /// `count` numbers, or between `least` and `most`; none where there is no such attribute.
  std::optional<std::vector<double>> numbers(const char* key, std::size_t count) const;
  std::optional<std::vector<double>> numbers(const char* key, std::size_t least, std::size_t most) const;

  /// pos and the orientation.
  MjcfPlacement placement() const;

  void expect_class(const std::string& name) const;

  /// "joint "shoulder"", "body at line 12" for messages.
  std::string who() const;

 private:
  const char* find(const char* key) const;
  void report(const std::string& sentence) const;
  MjcfOrientation orientation_kind() const;

  const tinyxml2::XMLElement& element_;
  std::string class_, kind_;
  const MjcfDefaults& defaults_;
  const MjcfUnits& units_;
  FirstError& first_error_;
};

}  // namespace kinfer
