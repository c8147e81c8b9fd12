// SPDX-License-Identifier: Apache-2.0
// The square of an expression, evaluated once.
#pragma once

namespace kinfer {

constexpr double square(double x) {
  return x * x;
}

}  // namespace kinfer
