// SPDX-License-Identifier: Apache-2.0
// Limbs that may be turned by any angle about the upright axis of their segment (UnknownTurn). On level ground that is
// of no consequence. A limb that is turned sees tilt and tilting of the base from elsewhere: until the turn is known
// that is noise of the limb's sensors, which lasts, and an uncertainty of its first joint.
#pragma once

#include "kinfer/track/model/chain_state.hpp"

namespace kinfer::track {

class LimbTurns {
 public:
  explicit LimbTurns(const FilterModel& model);

  /// At a start: positions allow for no tilt yet.
  void begin();
  bool is_known(std::size_t body) const;
  void know(std::size_t body, bool is_known);

  /// Variances of the sensors' rows by the turns that are not known, and what first joints have in `p` of the tilt.
  void update(const FilterModel& model, const ChainState& state, MatrixXd& p);
  const VectorXd& variance() const { return variance_; }

  /// [rad] by which the base is tilted against the axis of the segment, beyond what level ground may seem to be: the
  /// limb depends on its turn.
  static double tilt(const FilterModel& model, const ChainState& state, const MatrixXd& p, const UnknownTurn& turn);
  /// Whether the tilt changes in the segment, which shows the turn of its limbs.
  static bool are_shown(const FilterModel& model, const ChainState& state, const MatrixXd& p, const UnknownTurn& turn);
  /// Position of the limb's first joint: of a tilt [rad] whose direction may be any.
  static void free_first_joint(const FilterModel& model, const UnknownTurn& turn, double square_tilt, MatrixXd& p);

 private:
  struct Limb {
    std::size_t body = 0;
    bool is_known = false;
    double tilt = 0.0;  ///< [rad] that the position of its first joint allows for
  };
  std::vector<Limb> limbs_;  // in the order of the model
  VectorXd variance_;
};

}  // namespace kinfer::track
