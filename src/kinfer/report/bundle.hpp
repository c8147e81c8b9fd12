// SPDX-License-Identifier: Apache-2.0
// Front end of the report (folder web/), bundled at build time.
#pragma once

#include <string_view>

namespace kinfer::report {

std::string_view report_script();
std::string_view report_style();

}  // namespace kinfer::report
