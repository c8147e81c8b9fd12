// The square of an expression that is written once.
#pragma once

namespace kinfer {

constexpr double square(double x) {
  return x * x;
}

}  // namespace kinfer
