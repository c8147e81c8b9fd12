// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/least_squares/loss.hpp"

#include <cmath>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

LossValue huber(double s, double limit) {
  if (s <= limit * limit) return {s, 1.0};
  const double norm = std::sqrt(s);
  return {2.0 * limit * norm - limit * limit, limit / norm};
}

LossValue cauchy(double s, double limit) {
  const double square = limit * limit;
  return {square * std::log1p(s / square), 1.0 / (1.0 + s / square)};
}

LossValue tukey(double s, double limit) {
  const double square = limit * limit, ratio = s / square;
  if (ratio >= 1.0) return {square / 3.0, 0.0};
  // (1 − (1 − u)³) / 3 = u − u² + u³/3, without the cancellation at small u
  return {s * (1.0 - ratio + ratio * ratio / 3.0), (1.0 - ratio) * (1.0 - ratio)};
}

}  // namespace

LossValue loss_value(Loss loss, double s, double limit) {
  switch (loss) {
    case Loss::none:
      return {s, 1.0};
    case Loss::huber:
      return huber(s, limit);
    case Loss::cauchy:
      return cauchy(s, limit);
    case Loss::tukey:
      return tukey(s, limit);
  }
  KINFER_EXPECT(false, "unknown Loss");
}

}  // namespace kinfer
