// SPDX-License-Identifier: Apache-2.0
#include "kinfer/base/threshold.hpp"

#ifdef KINFER_VARY_THRESHOLDS

#include <map>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

struct Varied {
  double standard = 0.0, value = 0.0;
};

std::map<std::string, Varied, std::less<>>& registry() {
  static std::map<std::string, Varied, std::less<>> all;
  return all;
}

}  // namespace

double& vary_threshold(std::string_view name, double value) {
  return registry().try_emplace(std::string(name), Varied{value, value}).first->second.value;
}

void scale_threshold(std::string_view name, double factor) {
  const auto found = registry().find(name);
  KINFER_EXPECT(found != registry().end());
  found->second.value = factor * found->second.standard;
}

double threshold_value(std::string_view name) {
  const auto found = registry().find(name);
  KINFER_EXPECT(found != registry().end());
  return found->second.value;
}

std::vector<std::string> threshold_names() {
  std::vector<std::string> names;
  for (const auto& entry : registry()) names.push_back(entry.first);
  return names;
}

}  // namespace kinfer

#endif
