// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/facts/fact.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

template <class T>
const T& get(const FactValue* value, std::string_view name) {
  const T* typed = value ? std::get_if<T>(value) : nullptr;
  KINFER_EXPECT(typed, "no value \"{}\" of this type in a fact", name);
  return *typed;
}

}  // namespace

const FactValue* FactValues::find(std::string_view name) const {
  const auto at = std::ranges::find(entries_, name, &Entry::first);
  return at == entries_.end() ? nullptr : &at->second;
}

void FactValues::set(std::string name, FactValue value) {
  const auto at = std::ranges::find(entries_, name, &Entry::first);
  if (at == entries_.end())
    entries_.emplace_back(std::move(name), std::move(value));
  else
    at->second = std::move(value);
}

double FactValues::number(std::string_view name) const {
  return get<double>(find(name), name);
}
int FactValues::count(std::string_view name) const {
  return get<int>(find(name), name);
}
const std::string& FactValues::text(std::string_view name) const {
  return get<std::string>(find(name), name);
}
const std::vector<double>& FactValues::numbers(std::string_view name) const {
  return get<std::vector<double>>(find(name), name);
}
const std::vector<int>& FactValues::counts(std::string_view name) const {
  return get<std::vector<int>>(find(name), name);
}
const std::vector<std::string>& FactValues::texts(std::string_view name) const {
  return get<std::vector<std::string>>(find(name), name);
}

}  // namespace kinfer
