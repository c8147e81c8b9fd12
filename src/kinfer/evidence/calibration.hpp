// What a calibration delivers: the estimate, its proof on poses that were not fitted, and what to make of it.
#pragma once

#include <optional>

#include "kinfer/evidence/advice.hpp"
#include "kinfer/evidence/estimate.hpp"
#include "kinfer/evidence/findings.hpp"
#include "kinfer/evidence/ladder.hpp"
#include "kinfer/evidence/picture.hpp"

namespace kinfer {

/// Position errors of one measured row under three chains [m]; NaN where the row's position was not measured.
struct RowErrors {
  int row = 0;          ///< from 0
  double before = 0.0;  ///< nominal chain, base and tool refitted (on other rows)
  double after = 0.0;   ///< by a fit that did not see the row where `held_out`, else by the final chain
  double fitted = 0.0;  ///< by the final chain
  bool held_out = false;
};

/// ISO 9283 at one commanded pose: the rows whose readings agree to 1e-4 rad or 0.01 mm.
struct PoseAccuracy {
  std::vector<int> rows;
  double accuracy_before = 0.0;  ///< AP [m]: distance of the measurements' middle from where `before` has the tool
  double accuracy_after = 0.0;   ///< AP [m] by the corrected chain
  std::optional<double>
      repeatability;  ///< RP [m]: mean distance from the middle + 3 sd of it; where rows repeat a pose
};

struct Calibration {
  Estimate estimate;  ///< the corrected chain
  ChainFit nominal;   ///< the chain as given
  ChainFit before;    ///< base and tool refitted, all else nominal
  ChainFit after;
  Ladder ladder;                      ///< empty where no model was chosen
  std::string measured = "position";  ///< what the position errors of the fits are: "ball in socket", "distance", …
  std::string holdout;                ///< how rows were kept aside: "5-fold cross-validation"
  std::vector<int> wrong_rows;        ///< held out, and not counted in the held-out figures of any model
  std::vector<RowErrors> rows;
  std::vector<PoseAccuracy> accuracy;  ///< in the order of each pose's first row; empty without measured tool points
  CalibrationPicture picture;          ///< what is drawn
  std::vector<Advice> next;            ///< what to measure or to do next, most useful first
  std::vector<Finding> findings;       ///< of the doctor, before the fit
  std::vector<std::string> notes;      ///< what was noticed and done, in words
  bool geometry_alone = false;         ///< a population searched, which climbs no ladder of models
  bool use = true;                     ///< false: the verdict advises against the result
  std::string verdict;                 ///< one sentence
};

}  // namespace kinfer
