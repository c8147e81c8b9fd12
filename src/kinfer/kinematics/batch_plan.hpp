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

/// Slots of all: the first is at the base, the first slot at the tip.
int slots_of(const std::vector<Movement>& movements);

/// The numbers of the items, one item a row: the movements' slots, then the measured point.
MatrixXd items_of(const std::vector<Movement>& movements, const PointTable& points, const Pose& measured_from,
                  const Kernels& kernels);

/// Indices of the points at each place of the tool that has any: the tool point (−1) first.
struct PointsAtTarget {
  int target = -1;
  std::vector<int> points{};
};
std::vector<PointsAtTarget> points_by_target(const Chain& chain, const PointTable& points);

/// Where a base that is not identified is accounted for.
enum class BaseSide {
  chain,        ///< with the other constants
  measurement,  ///< the measured points are seen from it: their errors turn with it, but keep their size
};

/// Segments from the base to the tool. A general segment's factors are in `factors`.
struct SegmentList {
  std::vector<Segment> segments;
  std::vector<std::vector<Factor>> factors;
  Pose base;                      ///< what the measured points are to be seen from
  VectorXd nominal;               ///< of the free parameters
  std::vector<int> angles;        ///< those of them that are angles: Value::angle counts them
  std::vector<LinkSheet> sheets;  ///< empty: no segment is in one
  bool is_all_in_sheets = true;   ///< all segments that vary
};

/// Places on the tool where points start, tool point first; on the last axis where nothing takes it off.
Group group_at(const SegmentList& list, const Chain& nominal, int target);

/// Screws from the world to the tool.
struct ScrewPlan {
  std::vector<Screw> screws;
  std::vector<int> idle;  ///< parameters that nothing writes
};

/// All that the kernels know of a chain of which a set is identified.
struct ChainPlan {
  std::vector<Movement> movements;
  SegmentList list;
  ScrewPlan screws;  ///< where the base is on the chain's side
};
ChainPlan plan_of(const Chain& nominal, const ParameterSet& set, BaseSide side);

}  // namespace kinfer::batch
