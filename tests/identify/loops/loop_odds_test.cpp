// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/loops/loop_odds.hpp"

#include <gtest/gtest.h>

#include "kinfer/identify/loops/thresholds.hpp"

namespace kinfer {
using namespace identify;
namespace {

/// A planar linkage: its axes are parallel, closed or not.
LoopEvidence planar(double gap, double positions = 30.0, double mirrored = 0.05) {
  LoopEvidence evidence{.positions = positions, .lever = 1.0};
  evidence.closing.gap = gap;
  evidence.closing.misalignment = evidence.mirrored.misalignment = 5e-4;
  evidence.mirrored.gap = mirrored;
  return evidence;
}

TEST(LoopOdds, APinThatHoldsToItsPlayClosesALoop) {
  EXPECT_GT(log_odds(planar(1e-3)), 50.0);
  EXPECT_LT(log_odds(planar(0.05)), -100.0);
}

TEST(LoopOdds, MoreMotionAndMorePositionsAreMoreEvidence) {
  EXPECT_GT(log_odds(planar(1e-3, 60.0)), log_odds(planar(1e-3)));
  EXPECT_GT(log_odds(planar(1e-3, 30.0, 0.1)), log_odds(planar(1e-3)));
}

TEST(LoopOdds, LittlePlayIsEvidenceInFewPositionsOfASmallMotion) {
  const auto odds = [](double gap) {
    LoopEvidence evidence = planar(gap, 6.0, 2.6e-3);
    evidence.lever = 0.05;
    return log_odds(evidence);
  };
  EXPECT_GT(odds(3e-5), min_loop_log_odds);
  EXPECT_LT(odds(1e-3), min_loop_log_odds);
}

TEST(LoopOdds, AGapThatTheMirroredMotionLeavesTooClosesNoneHoweverSmall) {
  for (const double gap : {1e-4, 1e-3, 1.5e-3, 2e-3, 3e-3, 1e-2})
    EXPECT_LT(log_odds(planar(gap, 200.0, gap)), min_loop_log_odds) << gap;
}

TEST(LoopOdds, TwoPositionsOfAMachineFitAnyPin) {
  EXPECT_LT(log_odds(planar(1e-4, 2.0)), min_loop_log_odds);
}

TEST(LoopOdds, BodiesOfAWristShareAPointButNoAxis) {
  LoopEvidence wrist = planar(0.0);
  wrist.mirrored.misalignment = wrist.closing.misalignment = 0.3;
  EXPECT_LT(log_odds(wrist), -100.0);
}

}  // namespace
}  // namespace kinfer
