// SPDX-License-Identifier: Apache-2.0
// Rests measure gyroscope biases: of three quiet blocks of both sensors of a joint the middle one shows what their
// gyroscopes measure while neither rotates; the rest of the machine may move. Joint velocities are not set to zero: a
// joint that begins to creep would be held back (it cost 0.2° at each such start), and only the biases along a joint's
// axis are what its position suffers from.
#pragma once

#include <array>

#include "kinfer/measurement/ins/ins_row.hpp"
#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

class RestBias {
 public:
  explicit RestBias(const FilterModel& model);

  /// True if in the block before the last some sensor is in the middle of a rest; once for each block.
  bool add(const InsRow& row);

  /// Corrects the filter's biases along the axes of the joints that rest in that block.
  void correct(ChainFilter& filter) const;

 private:
  struct Block {
    std::vector<Vec3> sum, square, force_sum, force_square;
    std::vector<int> count;
    std::vector<bool> is_quiet;  // of each sensor
    double begin = 0.0;
    int rows = 0;
  };
  void close();
  bool is_quiet(const Block& block, std::size_t sensor) const;
  bool rests(std::size_t sensor) const;
  bool is_upright(const InsBody& joint, std::size_t parent_sensor) const;
  bool integrates_alone(const FilterModel& model, std::size_t body) const;
  Vec3 mean_rate(std::size_t sensor) const;
  ChainFilter::ScalarRow bias_row(const ChainFilter& filter, std::size_t body) const;

  std::vector<InsLevel> noise_;
  Block open_;
  std::array<Block, 3> last_;  // oldest first
};

}  // namespace kinfer::track
