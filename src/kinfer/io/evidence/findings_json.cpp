// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/evidence/findings_json.hpp"

#include <nlohmann/json.hpp>

namespace kinfer {

std::string format_findings(const std::vector<Finding>& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& f : findings)
    list.push_back({{"kind", name(f.kind)},
                    {"severity", name(f.severity)},
                    {"rows", f.rows},
                    {"lines", f.lines},
                    {"sentence", f.sentence},
                    {"suggestion", f.suggestion},
                    {"applied", f.applied}});
  return list.dump(1);
}

}  // namespace kinfer
