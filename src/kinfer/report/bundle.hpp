// The front end of the report (folder web/), bundled when kinfer was built.
#pragma once

#include <string_view>

namespace kinfer {

std::string_view report_script();
std::string_view report_style();

}  // namespace kinfer
