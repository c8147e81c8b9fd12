// SPDX-License-Identifier: Apache-2.0
// Sum of many harmonics of one joint, of orders 0, 1, 2, … without a gap: eight orders at a time, each eight the ones
// before turned on by eight times the position. Accurate to an epsilon for each of these turns.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "kinfer/kinematics/chain.hpp"

namespace kinfer::calibrate {

class HarmonicSum {
 public:
  /// Fewer than that are as fast one by one.
  static constexpr std::size_t least_length = 16;

  HarmonicSum() = default;
  /// Of the first harmonics, as far as the order of each is its place.
  explicit HarmonicSum(std::span<const Harmonic> harmonics) {
    std::size_t length = 0;
    while (length < harmonics.size() && harmonics[length].order == static_cast<double>(length)) ++length;
    if (length < least_length) return;
    length_ = length;
    sine_.resize((length + lanes - 1) / lanes, {}), cosine_.resize(sine_.size(), {});
    for (std::size_t k = 0; k < length; ++k) {
      sine_[k / lanes][k % lanes] = harmonics[k].sine;
      cosine_[k / lanes][k % lanes] = harmonics[k].cosine;
    }
  }

  std::size_t length() const { return length_; }

  /// [rad] Σ sine sin(order position) + cosine cos(order position).
  double at(double position) const {
    if (length_ == 0) return 0.0;
    Lane s{}, c{1.0}, sum{};
    double s1 = 0.0, c1 = 1.0;
    ::sincos(position, &s1, &c1);
    for (std::size_t k = 1; k < lanes; ++k) s[k] = s[k - 1] * c1 + c[k - 1] * s1, c[k] = c[k - 1] * c1 - s[k - 1] * s1;
    const double turned_s = s[lanes - 1] * c1 + c[lanes - 1] * s1, turned_c = c[lanes - 1] * c1 - s[lanes - 1] * s1;
    for (std::size_t m = 0; m < sine_.size(); ++m) {
      for (std::size_t k = 0; k < lanes; ++k) {
        sum[k] += sine_[m][k] * s[k] + cosine_[m][k] * c[k];
        const double before = s[k];
        s[k] = before * turned_c + c[k] * turned_s;
        c[k] = c[k] * turned_c - before * turned_s;
      }
    }
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
  }

 private:
  static constexpr std::size_t lanes = 8;
  using Lane = std::array<double, lanes>;

  std::size_t length_ = 0;
  std::vector<Lane> sine_, cosine_;
};

}  // namespace kinfer::calibrate
