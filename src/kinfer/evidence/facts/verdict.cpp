// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/facts/verdict.hpp"

namespace kinfer {

std::string_view name(Usability usability) {
  switch (usability) {
    case Usability::use:
      return "use";
    case Usability::use_with_care:
      return "use_with_care";
    case Usability::do_not_use:
      return "do_not_use";
  }
  return "";
}

std::string sentence(const VerdictText& verdict) {
  std::string text = verdict.recommendation + ": " + verdict.statement;
  for (const std::string& remark : verdict.remarks) text += "; " + remark;
  return text;
}

}  // namespace kinfer
