// A chain and what of it is identified, as the batch kernels want it.
#pragma once

#include <span>
#include <vector>

#include "kinfer/kinematics/batch_kernel.hpp"
#include "kinfer/kinematics/parameters.hpp"

namespace kinfer {

/// Measured points, each at its own joint readings.
struct PointTable {
  MatrixXd joints;            ///< dof x points
  Eigen::Matrix3Xd measured;  ///< [m], in the world
  std::vector<int> target{};  ///< one a point, index into Chain::targets, −1: the tool point; empty: all −1
};

/// True where a joint's movement is its reading times a gain plus couplings, and only geometry and gains are
/// identified: deflection, backlash, harmonics and warming have no batch form.
bool has_batch_form(const Chain& chain, const ParameterSet& set);

}  // namespace kinfer

namespace kinfer::batch {

/// How a joint moves with the readings, where its numbers are in an item, and what kind they are.
struct Movement {
  int joint = 0;
  Move move = Move::turn;
  int slot = 0;
  Value gain;
  int reading = -1;                   ///< index into q; −1: none
  std::vector<Coupling> couplings{};  ///< Coupling::joint is an index into q

  int slots() const { return move == Move::turn ? 2 : move == Move::shift ? 1 : 3; }
};

/// The joints of the path that move, from the base to the tip; slots from the tip inwards.
std::vector<Movement> movements_of(const Chain& chain, const ParameterSet& set);
int slots_of(const std::vector<Movement>& movements);

/// The numbers of one item, measured point included.
void write_item(const std::vector<Movement>& movements, const double* q, const Vec3& measured, std::span<double> item);

/// Where a base that is not identified is accounted for.
enum class BaseSide {
  chain,        ///< with the other constants
  measurement,  ///< the measured points are seen from it: their errors turn with it, but keep their size
};

/// Segments from the base to the tool. A general segment's factors are in `factors`.
struct SegmentList {
  std::vector<Segment> segments;
  std::vector<std::vector<Factor>> factors;
  Pose base;         ///< what the measured points are to be seen from
  VectorXd nominal;  ///< of the free parameters
};
SegmentList segments_of(const Chain& nominal, const ParameterSet& set, BaseSide side);

/// Places on the tool where points start, tool point first; on the last axis where nothing takes it off.
Group group_at(const SegmentList& list, const Chain& nominal, int target);

/// Steps from the world to the tool, and where each takes its number from.
struct StepPlan {
  std::vector<Step> steps;
  std::vector<Value> values;  ///< one a step
  std::vector<Value> gains;   ///< one a step
  std::vector<int> idle;      ///< parameters that nothing records

  /// The steps at one candidate.
  std::vector<Step> at(ConstVectorRef x) const;
};
StepPlan steps_of(const Chain& nominal, const ParameterSet& set);

}  // namespace kinfer::batch
