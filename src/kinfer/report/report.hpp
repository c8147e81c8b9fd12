// SPDX-License-Identifier: Apache-2.0
// report.html: one self-contained file, made from evidence.json alone. It is readable without scripts and on paper;
// with scripts the machine moves and the plots are interactive. Deterministic to the byte.
#pragma once

#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// `evidence`: the text of evidence.json of `calibrate` or `identify`.
Result<std::string> report_html(std::string_view evidence);

}  // namespace kinfer
