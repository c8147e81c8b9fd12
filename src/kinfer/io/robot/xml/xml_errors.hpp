// SPDX-License-Identifier: Apache-2.0
// What tinyxml2 says about malformed XML, as a sentence with its place.
#pragma once

#include <tinyxml2.h>

#include <string>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// "arm.xml:12: malformed XML (mismatched element)"
tl::unexpected<Error> malformed_xml(const tinyxml2::XMLDocument& document, const std::string& name_in_messages);

}  // namespace kinfer
