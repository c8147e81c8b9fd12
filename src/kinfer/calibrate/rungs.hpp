// What a robot's model may need beyond geometry: candidates for the ladder, each with the numbers that it frees.
#pragma once

#include <string>
#include <vector>

#include "kinfer/calibrate/calibrate.hpp"

namespace kinfer {

/// A group of terms that are taken or refused together.
struct Rung {
  std::string name{};                ///< "gravity"
  std::string adds{};                ///< in words
  Chain nominal{};                   ///< the chain with a place for the terms (harmonics, masses), which are zero
  std::vector<Parameter> further{};  ///< the numbers that it frees, with priors about zero or the file's value
  std::string locked{};              ///< why it cannot be tried with these data; empty: it can
};

/// Names of all rungs beyond geometry, in the order in which they are tried.
std::vector<std::string> rung_names();

/// The rung of that name on top of `nominal`, for these rows. `fitted` is the best fit so far, whose residuals the
/// spectrum of the gears is looked for in.
Rung rung_on(const Chain& nominal, const std::string& name, const CalibrateTask& task, const PoseSet& rows,
             const Estimate& fitted);

}  // namespace kinfer
