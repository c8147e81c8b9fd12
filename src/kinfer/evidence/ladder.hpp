// Which terms beyond geometry a model needed, as held-out errors judged it.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/fit.hpp"

namespace kinfer {

/// One model that was tried (or locked) on top of the rungs chosen before it.
struct LadderRung {
  std::string name{};                  ///< "geometry", "gravity", "gear", …
  std::string adds{};                  ///< in words: "compliance of each joint under gravity"
  ErrorStatistics train{}, holdout{};  ///< [m] by cross-validation over the fitted rows; n = 0 where it was locked
  int terms = 0, determined = 0;       ///< how many numbers it adds, and how many of them the data determine
  bool chosen = false;
  bool locked = false;                     ///< not tried: its terms are not excited
  std::vector<std::string> not_excited{};  ///< its terms that the data do not determine
  std::string why{};                       ///< why it was taken, refused or locked, in one sentence
};

struct Ladder {
  std::vector<LadderRung> rungs{};
  std::string chosen{};  ///< the model: "geometry + gravity"
};

}  // namespace kinfer
