// SPDX-License-Identifier: Apache-2.0
// What the magnetometers of a machine measure in a uniform field:
//   y = (I + S) Rᵀ m + b,  R = exp(δ₁ n₁) exp(δ₂ n₂) … R₀,
// with the field m in the root's frame, hard iron b and soft iron S of each sensor, R₀ the orientation of the sensor as
// the fit of gyroscopes and accelerometers found it, and δ rotations of sub-trees about axes n that this fit left free.
// S has a symmetric part, magnetised iron, and a skew part, by which the magnetometer is misaligned with the housing.
#pragma once

#include "kinfer/estimate/magnetometers/magnetic_series.hpp"

namespace kinfer {

/// A rotation of all bodies behind (and with) `child` about an axis.
struct SubtreeRotation {
  std::size_t child = 0;
  std::vector<Vec3> axis;  ///< unit, in the root's frame, one per bin
};

inline constexpr Eigen::Index iron_unknowns = 12;  // b, the symmetric and the skew part of S

struct MagneticUnknowns {
  VectorXd rotation;          ///< δ [rad]
  Vec3 field = Vec3::Zero();  ///< m
  std::vector<Vec3> hard_iron;
  std::vector<Mat3> soft_iron;  ///< S
};

/// Standard deviations of what a sensor adds; also the starting point of their estimates.
struct IronPrior {
  double hard_iron = 0.0;     ///< of each axis, in the unit of the field
  double soft_iron = 0.0;     ///< of the symmetric part's elements
  double misalignment = 0.0;  ///< [rad] of the skew part's elements
};

/// Basis of S: three diagonal elements, three symmetric pairs, three skew pairs.
const std::array<Mat3, 9>& soft_iron_basis();

/// Prediction for one sensor at one bin with its derivatives by [rotations, field, b, S in its basis].
struct MagneticPrediction {
  Vec3 value;
  Eigen::Matrix<double, 3, Eigen::Dynamic> derivative;
};

class MagneticModel {
 public:
  MagneticModel(const MagneticRecording& recording, const std::vector<SubtreeRotation>& rotations);

  Eigen::Index rotations() const { return static_cast<Eigen::Index>(rotations_.size()); }
  Eigen::Index unknowns() const;                      ///< of the whole model: rotations, field, iron of each sensor
  Eigen::Index first_iron(std::size_t series) const;  ///< of a sensor
  const MagneticRecording& recording() const { return recording_; }

  /// root_R_sensor with all rotations applied.
  Mat3 orientation(const MagneticUnknowns& x, std::size_t series, std::size_t bin) const;
  Vec3 residual(const MagneticUnknowns& x, std::size_t series, std::size_t bin) const;
  MagneticPrediction predict(const MagneticUnknowns& x, std::size_t series, std::size_t bin) const;
  MagneticUnknowns retract(const MagneticUnknowns& x, ConstVectorRef step) const;

 private:
  const MagneticRecording& recording_;
  const std::vector<SubtreeRotation>& rotations_;
  std::vector<std::vector<std::size_t>> acting_;  // rotations on each sensor, from the root outward
};

}  // namespace kinfer
