// One sensor's readings in one interval as whitened, robustly weighted rows, with their derivatives by all that they
// depend on.
//
// Gyroscope and magnetometer know nothing of points, nor does the accelerometer of the errors of the two: so the rows
// come in two parts, each with columns of its own.
#pragma once

#include "kinfer/estimate/ins_motion.hpp"
#include "kinfer/estimate/ins_mount.hpp"
#include "kinfer/estimate/ins_residual.hpp"

namespace kinfer {

/// The rows of instruments that depend on the same unknowns.
struct SensorRows {
  std::vector<Eigen::Index> band;    ///< of each column of the band: i·channels + channel in the span, ascending
  std::vector<Eigen::Index> border;  ///< of each column behind those: its unknown
  MatrixXd jacobian;                 ///< transposed: columns x rows
  VectorXd residual;
  Eigen::Index used = 0;  ///< rows of this interval

  // Where columns begin; of what is not there or held nothing is put anywhere.
  Eigen::Index turning = 0, shifting = 0, tilt = 0, clock = 0;
};

/// One sensor in one interval after the other; what it is made from must outlive it.
class SensorSystem {
 public:
  SensorSystem(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const IntervalMotion& motion,
               std::size_t body, InsScope scope);

  /// Where `motion` went to.
  void go_to(Eigen::Index interval);

  const std::array<SensorRows, 2>& parts() const { return parts_; }

 private:
  struct Use {
    InstrumentUse instrument;
    std::size_t part;
    Eigen::Index bias = 0, matrix = 0;  // columns
  };
  /// One block: row i of it is Σ weight(i, node) · what the instrument shows at the node.
  struct Weighed {
    const Use& use;
    NodeMatrix weight;
    std::array<Mat3, block_nodes> by_truth;  // of what it shows, by what its segment would feel
    Eigen::Index first, rows;                // of its rows in their part, three a row of the block
  };
  Use use_of(const InstrumentUse& instrument);
  void feel(Eigen::Index interval);
  void add_rows(const Use& use, Eigen::Index interval);
  void put_band(const Weighed& block);
  void put_border(const Weighed& block, const Eigen::Ref<const MatrixXd>& by_unknowns, Eigen::Index column);
  void put_errors(const Weighed& block);
  void put_clock(const Weighed& block, const BlockResidual& by_shift, Eigen::Index interval);
  Mat3 scaled(const Use& use) const;

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  const IntervalMotion& motion_;
  std::size_t body_, sensor_;
  InsScope scope_;
  std::array<SensorRows, 2> parts_;  // gyroscope and magnetometer, accelerometer
  std::vector<Use> uses_;
  InsErrors errors_;
  std::array<FeltDerivative, block_nodes> felt_;
};

}  // namespace kinfer
