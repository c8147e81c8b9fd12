// report.html: one self-contained file, made of evidence.json alone. It can be read without scripts and on paper; with
// scripts the machine moves and the plots can be looked into. Same evidence, same bytes.
#pragma once

#include <string>
#include <string_view>

#include "kinfer/base/result.hpp"

namespace kinfer {

/// `evidence`: the text of evidence.json of `calibrate` or `identify`.
Result<std::string> report_html(std::string_view evidence);

}  // namespace kinfer
