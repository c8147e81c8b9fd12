// SPDX-License-Identifier: Apache-2.0
// A report between the page's head and its scripts.
#pragma once

#include <string>
#include <vector>

#include "kinfer/report/parts/html.hpp"

namespace kinfer::report {

struct Page {
  std::string title;  ///< of the document
  std::string first;  ///< the first screen
  std::vector<html::Section> sections;
};

}  // namespace kinfer::report
