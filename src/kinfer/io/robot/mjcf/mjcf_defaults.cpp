// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/robot/mjcf/mjcf_defaults.hpp"

#include <string_view>

namespace kinfer {

void MjcfDefaults::read(const tinyxml2::XMLElement& mujoco, FirstError& first_error) {
  for (auto* section = mujoco.FirstChildElement("default"); section; section = section->NextSiblingElement("default")) {
    const char* name = section->Attribute("class");
    if (name) outermost_ = name;
    read_class(*section, outermost_, classes_[outermost_], first_error);
  }
}

/// The class's own elements first, wherever they stand: classes inside it inherit all of them.
void MjcfDefaults::read_class(const tinyxml2::XMLElement& element, const std::string& name, Values inherited,
                              FirstError& first_error) {
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string_view kind = child->Name();
    if (kind == "include") first_error.report(child->GetLineNum(), "<include> is not followed: give one complete file");
    if (kind == "default") continue;
    for (const auto* attribute = child->FirstAttribute(); attribute; attribute = attribute->Next())
      inherited[child->Name()][attribute->Name()] = attribute->Value();
  }
  classes_[name] = inherited;
  for (auto* child = element.FirstChildElement("default"); child; child = child->NextSiblingElement("default")) {
    const char* inner = child->Attribute("class");
    if (!inner) {
      first_error.report(child->GetLineNum(), "a <default> inside another has no class");
    } else if (has_class(inner)) {
      first_error.report(child->GetLineNum(), fmt::format("default class \"{}\" appears twice", inner));
    } else {
      read_class(*child, inner, inherited, first_error);
    }
  }
}

const char* MjcfDefaults::find(const std::string& class_name, const std::string& element,
                               const std::string& attribute) const {
  const auto values = classes_.find(class_name.empty() ? outermost_ : class_name);
  if (values == classes_.end()) return nullptr;
  const auto of_element = values->second.find(element);
  if (of_element == values->second.end()) return nullptr;
  const auto value = of_element->second.find(attribute);
  return value == of_element->second.end() ? nullptr : value->second.c_str();
}

}  // namespace kinfer
