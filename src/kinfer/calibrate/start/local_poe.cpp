// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/start/local_poe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/start/thresholds.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

constexpr double min_noise = 1e-9;  // [m], floor of a noise level

/// All frames between the joints, and the tool point; the tool rotation if orientations are measured. The priors are as
/// wide as the machine: they fix unobservable directions and have no influence otherwise.
ParameterSet free_frame_parameters(const Chain& chain, const PoseSet& data, double size) {
  Tolerances wide{.length = size, .angle = 1.0, .tool_length = size, .tool_angle = 1.0};
  ParameterSet set = all_parameters(chain, wide);
  std::erase_if(set.parameters, [&](const Parameter& p) {
    const std::optional<Field> field = field_of(p.at);
    if (is_own_frame_parameter(p.at, SetupFrame::base) || !field) return true;
    if (!is_rotation(*field)) return !is_translation(*field);
    return is_own_frame_parameter(p.at, SetupFrame::tool) && data.orientations.empty();
  });
  return set;
}

/// Randomly rotated frames, each displaced from the previous one by a part of the machine's size; the first near the
/// points.
Chain draw_random_chain(Chain chain, const PoseSet& data, double size, Rng rng) {
  const double part = size / static_cast<double>(chain.joints.size());
  for (Joint& joint : chain.joints) {
    auto& link = std::get<UrdfLink>(joint.link);
    link.origin = Frame::from_pose({random_orientation(rng).toRotationMatrix(), part * normal_vector(rng)});
  }
  std::get<UrdfLink>(chain.joints.front().link).origin.xyz += data.points.front().position;
  chain.tool.xyz = 0.3 * part * normal_vector(rng);
  return chain;
}

struct RefinedChain {
  Chain chain;
  double median_error = 0.0;
};

/// Levenberg-Marquardt in rounds: each updates the noise level and folds the rotation vectors into the frames, so that
/// they stay far from their singularity.
RefinedChain refine_chain(Chain chain, const PoseSet& data, double size, int rounds) {
  LeastSquaresOptions options;
  options.loss = Loss::cauchy;
  options.loss_scale = 3.0;
  options.max_iterations = 15;
  double median_error = median(point_errors(chain, data));
  for (int round = 0; round < rounds; ++round) {
    const Chain from = with_small_rotations_folded(chain);
    const ParameterSet set = free_frame_parameters(from, data, size);
    Weights weights;
    weights.of<PointMeasurement>().assign(data.points.size(), Vec3::Constant(std::max(median_error, min_noise)));
    if (!data.orientations.empty())
      weights.of<OrientationMeasurement>().assign(
          data.orientations.size(), Vec3::Constant(std::max(median(orientation_errors(from, data)), min_noise)));
    chain = unpack(set, from, least_squares(pose_residuals(from, set, data, weights), pack(set, from), options).x);
    const double before = median_error;
    median_error = median(point_errors(chain, data));
    if (round > thresholds::refinement_patience && median_error > 0.999 * before) break;
  }
  return {with_small_rotations_folded(chain), median_error};
}

}  // namespace

Result<std::vector<JointType>> parse_joint_types(const std::string& text) {
  std::vector<JointType> types;
  int count = 0;
  bool counted = false;
  for (const char c : text) {
    if (c >= '0' && c <= '9') {
      count = std::min(100, 10 * count + (c - '0')), counted = true;
      continue;
    }
    if ((c != 'R' && c != 'P') || (counted && count == 0))
      return error("unknown:{}: expected joint types as 6R or RRPR, R for revolute and P for prismatic", text);
    types.insert(types.end(), counted ? count : 1, c == 'R' ? JointType::revolute : JointType::prismatic);
    count = 0, counted = false;
  }
  constexpr std::size_t most = 20;
  if (types.empty() || counted || types.size() > most)
    return error("unknown:{}: expected joint types as 6R or RRPR, at most {} joints", text, most);
  return types;
}

Chain make_serial_chain(const std::vector<JointType>& types) {
  Chain chain;
  chain.name = "unknown";
  for (std::size_t i = 0; i < types.size(); ++i) {
    Joint joint;
    joint.name = fmt::format("J{}", i + 1);
    joint.parent = static_cast<int>(i) - 1;
    joint.type = types[i];
    joint.link = UrdfLink{};
    chain.joints.push_back(joint);
  }
  return chain;
}

Result<LocalPoeFit> fit_local_poe(const std::vector<JointType>& types, const PoseSet& data, int threads, Rng rng) {
  const Chain template_chain = make_serial_chain(types);
  const auto unknowns = 4 * types.size() + 6;  // at most: two directions and two offsets per joint, base and tool
  const std::size_t equations = 3 * (data.points.size() + data.orientations.size());
  if (data.points.empty() || equations < unknowns + unknowns / 4)
    return error(
        "{} positions are too few to find a robot of {} joints; at least {} are needed (twice as many are better)",
        data.points.size(), types.size(), (unknowns + unknowns / 4) / 3 + 1);
  const double size = rms_spread(point_positions(data));
  const std::size_t rows = std::max<std::size_t>(thresholds::min_start_rows, 2 * unknowns);
  PoseSet some = thin_pose_set(data, rows);
  if (!data.orientations.empty() && static_cast<std::size_t>(data.rows()) <= rows) some = data;

  const double solution_error = thresholds::explained_spread * size;  // [m]
  std::vector<RefinedChain> all;
  RefinedChain best;
  const auto agreeing = [&] {
    return static_cast<int>(std::count_if(all.begin(), all.end(), [&](const RefinedChain& f) {
      return f.median_error <= thresholds::agreeing_ratio * best.median_error + 1e-9;
    }));
  };
  for (std::size_t b = 0; b < thresholds::max_batches; ++b) {
    std::vector<RefinedChain> found(thresholds::starts_per_batch);
    parallel_for(found.size(), threads, [&](std::size_t i) {
      const Chain start = draw_random_chain(template_chain, some, size, rng.stream(b).stream(i));
      found[i] = refine_chain(start, some, size, thresholds::refinement_rounds);
    });
    all.insert(all.end(), found.begin(), found.end());
    best = *std::min_element(all.begin(), all.end(), [](const RefinedChain& x, const RefinedChain& y) {
      return x.median_error < y.median_error;
    });
    if (best.median_error < solution_error && agreeing() >= thresholds::enough_agreeing) break;
  }
  if (!(best.median_error < solution_error))
    return error(
        "no robot with these joint types fits the points: the best of {} random starts leaves {:.1f} mm; check the "
        "joint types, and that the joint positions belong to the measurements",
        all.size(), 1e3 * best.median_error);
  const int same = agreeing();
  const RefinedChain last = refine_chain(best.chain, data, size, thresholds::final_rounds);
  return LocalPoeFit{last.chain, last.median_error, static_cast<int>(all.size()), same};
}

}  // namespace kinfer::calibrate
