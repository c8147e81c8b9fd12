// SPDX-License-Identifier: Apache-2.0
// Rests measure gyroscope biases: of three quiet blocks in a row the middle one shows what the gyroscopes measure
// while nothing turns. Joint velocities are not set to zero: a joint that begins to creep would be held back (it cost
// 0.2° at each such start), and only the biases along a joint's axis are what its position suffers from.
#pragma once

#include <array>

#include "kinfer/measurement/ins_row.hpp"
#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class RestBias {
 public:
  explicit RestBias(const FilterModel& model);

  /// True if the block before the last is the middle of a rest; once for each.
  bool add(const InsRow& row);

  /// Corrects the filter's biases by that block.
  void correct(ChainFilter& filter) const;

 private:
  struct Block {
    std::vector<Vec3> sum, square, force_sum, force_square;
    std::vector<int> count;
    double begin = 0.0;
    int rows = 0;
    bool is_quiet = false;
  };
  void close();
  bool is_quiet(const Block& block) const;

  std::vector<InsLevel> noise_;
  Block open_;
  std::array<Block, 3> last_;  // oldest first
};

}  // namespace kinfer::track
