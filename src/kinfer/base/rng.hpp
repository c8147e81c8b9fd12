// SPDX-License-Identifier: Apache-2.0
// Random number streams keyed by work item: a stream is identified by a path of integers, never by a thread.
//
// Counter-based: draw k of stream s is mix(key(s) + k * golden), SplitMix64 (Steele, Lea, Flood 2014). Streams are
// therefore cheap to copy, need no warm-up, and give the same numbers with every compiler and number of threads.
#pragma once

#include <cstdint>
#include <span>

namespace kinfer {

class Rng {
 public:
  explicit Rng(std::uint64_t seed = 1);

  /// An independent stream: `rng.stream(generation).stream(individual)`. Does not change *this.
  Rng stream(std::uint64_t name) const;

  std::uint64_t bits();                      ///< 64 random bits
  double uniform();                          ///< in [0, 1)
  double uniform(double low, double high);   ///< in [low, high)
  void uniform(std::span<double> to);        ///< fills `to`, each number in [0, 1)
  double normal();                           ///< mean 0, standard deviation 1 (Box-Muller, one value a call)
  std::uint64_t index(std::uint64_t count);  ///< in 0 .. count-1, each equally likely; count >= 1

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace kinfer
