// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/term_reach.hpp"

namespace kinfer::calibrate {

TermReach reach_of(Term term) {
  switch (term) {
    case Term::gravity_compliance:
    case Term::torque_compliance:
    case Term::thermal_expansion:
      return TermReach::loads;
    case Term::gain:
    case Term::backlash:
      return TermReach::joints;
    default:
      return TermReach::measured;
  }
}

}  // namespace kinfer::calibrate
