// SPDX-License-Identifier: Apache-2.0
// Compensation: joint targets that bring the real tool to the pose of the nominal model, or to a given target.
//
// The corrected chain represents the real robot. For each desired tool pose its inverse kinematics is solved starting
// from the nominal joint positions, so that the robot keeps its configuration.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/prediction_model.hpp"
#include "kinfer/evidence/deployment/compensation.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::deploy {

/// The frames in which nominal and corrected tool poses are compared.
enum class CompensationFrames {
  as_given,  ///< each chain with its own base and tool: both files use the same world frame
  robot,     ///< the nominal base and tool for both: the corrected base is relative to the instrument
};

/// `as_given`, or `robot` where the corrected base differs from the nominal one by more than three tolerances: the
/// instrument then used another world frame.
CompensationFrames select_compensation_frames(const Chain& corrected, const Chain& nominal,
                                              const Tolerances& tolerances);

/// The corrected chain in these frames.
Chain express_in_frames(Chain corrected, const Chain& nominal, CompensationFrames frames);

/// Its prediction model in these frames: the nominal base and tool do not change beyond the measured region.
std::optional<PredictionModel> express_in_frames(std::optional<PredictionModel> prediction, CompensationFrames frames);

/// Both chains, comparable.
struct CompensationModels {
  Chain corrected, nominal;
  CompensationFrames frames = CompensationFrames::as_given;
  std::optional<PredictionModel> prediction{};  ///< of the corrected chain
};

/// Expresses the corrected chain in these frames; none: those that select_compensation_frames chooses. An error where
/// the two chains do not have the same joints.
Result<CompensationModels> prepare_compensation(const Chain& corrected, const Chain& nominal,
                                                const Tolerances& tolerances,
                                                std::optional<CompensationFrames> frames = std::nullopt,
                                                const std::optional<PredictionModel>& prediction = std::nullopt);

/// An error where rows name another set-up or arm than the chain's own: compensation uses the chain's base and tool.
Result<void> expect_own_mounting(const Chain& corrected, const PoseSet& rows);

/// For each row: the joint positions at which the tool of `corrected` has the pose that `nominal` has at the row's,
/// both under the row's payload, temperature and torques and approached from the previous row.
/// With fewer than six joints the orientation is not free, and only the tool point is corrected. With a prediction
/// model the corrections fade outside the measured region.
std::vector<CompensatedJoints> compensate_joints(const Chain& corrected, const Chain& nominal, const PoseSet& rows,
                                                 int threads,
                                                 const std::optional<PredictionModel>& prediction = std::nullopt);

/// The same for the columns of `q`, without payload, at the reference temperature.
std::vector<CompensatedJoints> compensate_joints(const Chain& corrected, const Chain& nominal, const MatrixXd& q,
                                                 int threads,
                                                 const std::optional<PredictionModel>& prediction = std::nullopt);

/// A desired tool position, with or without an orientation.
struct ToolTarget {
  Vec3 position = Vec3::Zero();
  std::optional<Mat3> rotation;
};

/// Joint positions that bring the tool of `corrected` to each target. Each search starts from the nominal solution,
/// which itself starts from `start` (dof x targets) where given; else it is the first posture inside the limits that
/// motion::reach finds, which draws its starts from `seed`. What is not reached from there without a `start` is tried
/// in the other postures of `corrected`, the nearest first. `loads`: payload, temperature and torques of each target;
/// empty: none.
std::vector<CompensatedJoints> compensate_targets(const Chain& corrected, const Chain& nominal,
                                                  const std::vector<ToolTarget>& targets, const MatrixXd& start,
                                                  int threads, std::uint64_t seed,
                                                  const std::optional<PredictionModel>& prediction = std::nullopt,
                                                  const PoseSet& loads = {});

}  // namespace kinfer::deploy
