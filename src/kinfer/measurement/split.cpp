// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/split.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

std::vector<int> shuffle_rows(int count, Rng rng) {
  std::vector<int> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  for (int i = count - 1; i > 0; --i) std::swap(rows[i], rows[rng.index(i + 1)]);
  return rows;
}

Split hold_out_range(std::vector<int> rows, int begin, int end) {
  Split split;
  split.holdout.assign(rows.begin() + begin, rows.begin() + end);
  split.train.assign(rows.begin(), rows.begin() + begin);
  split.train.insert(split.train.end(), rows.begin() + end, rows.end());
  std::sort(split.train.begin(), split.train.end());
  std::sort(split.holdout.begin(), split.holdout.end());
  return split;
}

}  // namespace

Split random_split(int count, double fraction, Rng rng) {
  KINFER_EXPECT(fraction >= 0.0 && fraction <= 1.0, "fraction {}", fraction);
  int held_out = static_cast<int>(std::lround(fraction * count));
  if (count >= 2) held_out = std::clamp(held_out, 1, count - 1);
  return hold_out_range(shuffle_rows(count, rng), 0, held_out);
}

std::vector<Split> folds(int count, int k, Rng rng) {
  KINFER_EXPECT(k >= 2 && count >= k, "{} folds of {} rows", k, count);
  const std::vector<int> rows = shuffle_rows(count, rng);
  std::vector<Split> splits;
  for (int i = 0; i < k; ++i) splits.push_back(hold_out_range(rows, i * count / k, (i + 1) * count / k));
  return splits;
}

}  // namespace kinfer
