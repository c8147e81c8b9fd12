// SPDX-License-Identifier: Apache-2.0
// Names of a chain in XML files (URDF, MJCF), which cannot hold control characters or bytes that are no UTF-8: these
// are written as _xHHHH_, as spreadsheets do (ECMA-376, part 1, 22.9.2.19), and come back on reading.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

std::string xml_name(std::string_view name);

/// The name that xml_name was given. Other names are unchanged, those with an escape of a printable character too.
std::string name_from_xml(std::string_view text);

/// The chain with every name as XML can hold it.
Chain with_xml_names(Chain chain);

/// The name, with a number behind it where it is taken: tool_2. It is taken from then on.
std::string unique_name(const std::string& wish, std::set<std::string>& taken);

}  // namespace kinfer
