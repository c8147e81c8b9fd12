// SPDX-License-Identifier: Apache-2.0
// Residual model of one kind of measurement: residual and Jacobian. Each kind of measurement_lists has a file that
// defines its ResidualModel.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Poses and their derivatives at all rows of a pose set: evaluated once for all kinds of measurements.
struct EvaluatedPoses {
  std::vector<Pose> pose;      ///< one per row
  std::vector<Twists> twists;  ///< one per row, by the free parameters; empty for residuals only
};

/// Jacobian columns of the free parameters outside the robot (fixtures, gravity); −1: not free.
struct FixtureColumns {
  using Xyz = std::array<Eigen::Index, 3>;
  using Numbers = std::array<Eigen::Index, 6>;  ///< in the order of fields_of the fixture
  std::vector<Xyz> target;
  std::array<std::vector<Numbers>, fixture_kinds> fixture;
  Xyz gravity{-1, -1, -1};
  std::vector<Eigen::Index> base;  ///< columns of all base frames

  const Numbers& of(FixtureKind kind, int entry) const { return fixture[index(kind)][entry]; }
};
FixtureColumns fixture_columns(const Chain& chain, const ParameterSet& set);

/// Input of a residual.
struct ResidualContext {
  const Chain& chain;
  const PoseSet& data;
  const EvaluatedPoses& at;
  const FixtureColumns& columns;

  int mounting(int row) const { return data.mounting.empty() ? -1 : data.mounting[row]; }
};

/// Destination of one block's rows; the Jacobian is null for residuals only.
struct BlockRows {
  VectorXd& residuals;
  MatrixXd* jacobian;
  Eigen::Index row = 0;
};

/// Residuals are measured − predicted, in m, rad or m/s²; the caller divides by the standard deviation.
struct ResidualModel {
  void (*write)(const ResidualContext&, std::size_t index, BlockRows&);  ///< residual and Jacobian of one block
  /// Standard deviations of one block, of which the first `rows` are used; null: the kind's sigma_of for each row.
  Vec3 (*specified_sd)(const PoseSet&, std::size_t index, const Instrument&) = nullptr;
  /// Metres at the tool point that one unit of the residual is worth; null: 1.
  double (*metres)(const ResidualContext&, std::size_t index) = nullptr;
};
/// Of the kind M; specialised in the file of each instrument.
template <class M>
ResidualModel residual_model();

/// A row of the table of kinds: the model with the list that it applies to.
struct ResidualKind {
  MeasurementKind kind;
  MeasurementTraits traits;
  ResidualModel model;
  int size;                                                        ///< rows of one block
  std::size_t (*count)(const PoseMeasurements&);                   ///< number of blocks
  int (*row)(const PoseMeasurements&, std::size_t index);          ///< row of the pose
  void (*keep)(PoseMeasurements&, const std::vector<bool>& kept);  ///< removes the others

  void write(const ResidualContext& scene, std::size_t index, BlockRows& out) const { model.write(scene, index, out); }
  Vec3 specified_sd(const PoseSet& data, std::size_t index, const Instrument& instrument) const {
    return model.specified_sd ? model.specified_sd(data, index, instrument)
                              : Vec3::Constant(traits.sigma_of(instrument));
  }
  double metres(const ResidualContext& scene, std::size_t index) const {
    return model.metres ? model.metres(scene, index) : 1.0;
  }
};

const ResidualKind& residual_kind(MeasurementKind kind);
/// All kinds, in the order of the blocks.
std::span<const ResidualKind> residual_kinds();

/// An error in the principal axes of its covariance, so that its components are independent; without axes: unchanged.
inline Vec3 along_axes(const std::optional<Mat3>& axes, const Vec3& error) {
  return axes ? Vec3(axes->transpose() * error) : error;
}

}  // namespace kinfer
