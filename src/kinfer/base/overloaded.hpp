// SPDX-License-Identifier: Apache-2.0
// A visitor of a std::variant made of lambdas.
#pragma once

namespace kinfer {

/// std::visit(Overloaded{[](const A&) { … }, [](const B&) { … }}, variant)
template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace kinfer
