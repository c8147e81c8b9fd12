// SPDX-License-Identifier: Apache-2.0
// Parts that the invented results share.
#pragma once

#include <cmath>
#include <limits>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/deployment/frame_estimate.hpp"
#include "kinfer/evidence/facts/provenance.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "support/robots.hpp"

namespace kinfer::test {

inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

inline Provenance rich_provenance() {
  return {.inputs = {{"poses.csv", std::string(64, 'a')}, {"robot.toml", std::string(64, 'b')}},
          .options = {{"model", "auto"}, {"holdout", "0.2"}, {"columns", "<map>"}},
          .seed = 18446744073709551615U};
}

inline Finding rich_finding(FindingKind kind, Severity severity, bool applied) {
  using Texts = std::vector<std::string>;
  return {.kind = kind,
          .severity = severity,
          .rows = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
          .lines = {2, 3, 4},
          .values = {{"joint", std::string("J<2>")},
                     {"stationary", Texts{"s<1>", "s2"}},
                     {"left_out", Texts{"s2 & s3"}},
                     {"kept", std::string("s0")},
                     {"extra", std::vector<double>{1, 2.5}},
                     {"counts", std::vector<int>{1, 2}},
                     {"none", std::vector<int>{}}},
          .applied = applied};
}

/// A chain with a tree, a coupling, a slide, one-sided limits and targets.
inline Chain rich_chain() {
  Chain chain;
  chain.name = "two <joints> & \"more\"";
  chain.joints = {mdh_joint(0.0, 0.0, 0.4, -170, 170, -1), mdh_joint(0.3, -90.0, 0.0, -90, 90, 0),
                  mdh_joint(0.2, 10.0, 0.1, -90, 90, 1)};
  chain.joints[2].type = JointType::prismatic;
  chain.joints[2].couplings = {{0, 0.01}};
  chain.joints[2].upper = std::numeric_limits<double>::infinity();
  chain.base.xyz = {0.1, 0.2, 0.3};
  chain.targets = {{"s\"2\"", Vec3(0.01, 0.02, 0.03)}};
  return chain;
}

}  // namespace kinfer::test
