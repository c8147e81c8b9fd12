// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/findings_json.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/json_parts.hpp"
#include "kinfer/words/findings.hpp"

namespace kinfer {

std::string format_findings(const std::vector<Finding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& f : findings)
    list.push_back({{"kind", name(f.kind)},
                    {"severity", name(f.severity)},
                    {"rows", f.rows},
                    {"lines", f.lines},
                    {"sentence", words::sentence(f)},
                    {"suggestion", words::suggestion(f)},
                    {"applied", f.applied},
                    {"values", values_json(f.values)}});
  return list.dump(1);
}

}  // namespace kinfer
