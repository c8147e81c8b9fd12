// SPDX-License-Identifier: Apache-2.0
// Default classes of an MJCF file: <default class="…"> elements, each of which inherits from the one around it.
#pragma once

#include <tinyxml2.h>

#include <functional>
#include <map>
#include <string>

#include "kinfer/io/text/first_error.hpp"

namespace kinfer {

class MjcfDefaults {
 public:
  /// Reads all <default> of the model.
  void read(const tinyxml2::XMLElement& mujoco, FirstError& first_error);

  bool has_class(const std::string& name) const { return classes_.contains(name); }

  /// The default of an attribute, of elements such as "joint"; null where the class leaves it open. An empty class
  /// name is the outermost class.
  const char* find(const std::string& class_name, const std::string& element, const std::string& attribute) const;

 private:
  using Values = std::map<std::string, std::map<std::string, std::string, std::less<>>, std::less<>>;

  void read_class(const tinyxml2::XMLElement& element, const std::string& name, Values inherited,
                  FirstError& first_error);

  std::map<std::string, Values, std::less<>> classes_{{"main", {}}};
  std::string outermost_ = "main";
};

}  // namespace kinfer
