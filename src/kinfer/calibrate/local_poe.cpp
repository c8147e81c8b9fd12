#include "kinfer/calibrate/local_poe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/doctor_case.hpp"
#include "kinfer/estimate/residuals.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

constexpr double no_sight = 1e-9;  // [m], floor of a noise level

/// Rms distance of the points from their middle [m].
double spread(const PoseSet& data) {
  Vec3 middle = Vec3::Zero();
  for (const PointMeasurement& point : data.points) middle += point.position;
  middle /= static_cast<double>(data.points.size());
  double squares = 0.0;
  for (const PointMeasurement& point : data.points) squares += (point.position - middle).squaredNorm();
  return std::sqrt(squares / static_cast<double>(data.points.size()));
}

Mat3 random_rotation(Rng& rng) {
  return Quat(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized().toRotationMatrix();
}

/// All frames between the joints, and where the tool point is; its turn where orientations are measured. The priors are
/// as wide as the machine: they hold what cannot be told, and tell nothing else.
ParameterSet frames_between_joints(const Chain& chain, const PoseSet& data, double size) {
  Tolerances wide{.length = size, .angle = 1.0, .tool_length = size, .tool_angle = 1.0};
  ParameterSet set = all_parameters(chain, wide);
  std::erase_if(set.parameters, [&](const Parameter& p) {
    const bool turn = p.at.field == Field::rx || p.at.field == Field::ry || p.at.field == Field::rz;
    const bool place = p.at.field == Field::x || p.at.field == Field::y || p.at.field == Field::z;
    if (p.at.owner == Owner::base || !(turn || place)) return true;
    return p.at.owner == Owner::tool && turn && data.orientations.empty();
  });
  return set;
}

/// Frames turned at random, each a part of the machine's size from the one before; the first where the points are.
Chain generic_start(Chain chain, const PoseSet& data, double size, Rng rng) {
  const double part = size / static_cast<double>(chain.joints.size());
  for (Joint& joint : chain.joints) {
    auto& link = std::get<UrdfLink>(joint.link);
    link.origin = Frame::from_pose({random_rotation(rng), part * Vec3(rng.normal(), rng.normal(), rng.normal())});
  }
  std::get<UrdfLink>(chain.joints.front().link).origin.xyz += data.points.front().position;
  chain.tool.xyz = 0.3 * part * Vec3(rng.normal(), rng.normal(), rng.normal());
  return chain;
}

struct RefinedChain {
  Chain chain;
  double typical = 0.0;
};

/// Levenberg-Marquardt in rounds: the noise level falls with the residuals, and the turns are folded away, so that they
/// stay far from their singularity.
RefinedChain refined(Chain chain, const PoseSet& data, double size, int rounds) {
  LeastSquaresOptions options;
  options.loss = Loss::cauchy;
  options.loss_scale = 3.0;
  options.max_iterations = 15;
  double typical = median(point_errors(chain, data));
  for (int round = 0; round < rounds; ++round) {
    const Chain from = with_turns_folded(chain);
    const ParameterSet set = frames_between_joints(from, data, size);
    Weights weights;
    weights.point_sd.assign(data.points.size(), Vec3::Constant(std::max(typical, no_sight)));
    if (!data.orientations.empty())
      weights.orientation_sd.assign(data.orientations.size(),
                                    Vec3::Constant(std::max(median(orientation_errors(from, data)), no_sight)));
    chain = unpack(set, from, least_squares(pose_residuals(from, set, data, weights), pack(set, from), options).x);
    const double before = typical;
    typical = median(point_errors(chain, data));
    constexpr int patience = 6;  // rounds in which a start may still be on its way
    if (round > patience && typical > 0.999 * before) break;
  }
  return {with_turns_folded(chain), typical};
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

Chain generic_chain(const std::vector<JointType>& types) {
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
  const Chain plain = generic_chain(types);
  const auto unknowns = 4 * types.size() + 6;  // at most: two directions and two offsets a joint, base and tool
  const std::size_t equations = 3 * (data.points.size() + data.orientations.size());
  if (data.points.empty() || equations < unknowns + unknowns / 4)
    return error(
        "{} positions are too few to find a robot of {} joints; at least {} are needed (twice as many are better)",
        data.points.size(), types.size(), (unknowns + unknowns / 4) / 3 + 1);
  const double size = spread(data);
  const std::size_t rows = std::max<std::size_t>(40, 2 * unknowns);  // enough to tell a right optimum from a wrong one
  PoseSet some = thinned_points(data, rows);
  if (!data.orientations.empty() && static_cast<std::size_t>(data.rows()) <= rows) some = data;

  constexpr std::size_t batch = 8, most_batches = 8;
  constexpr double explained = 0.01;  // of the spread
  std::vector<RefinedChain> all;
  RefinedChain best;
  const auto agreeing = [&] {
    return static_cast<int>(std::count_if(
        all.begin(), all.end(), [&](const RefinedChain& f) { return f.typical <= 1.2 * best.typical + 1e-9; }));
  };
  for (std::size_t b = 0; b < most_batches; ++b) {
    std::vector<RefinedChain> found(batch);
    parallel_for(batch, threads, [&](std::size_t i) {
      constexpr int rounds = 20;
      found[i] = refined(generic_start(plain, some, size, rng.stream(b).stream(i)), some, size, rounds);
    });
    all.insert(all.end(), found.begin(), found.end());
    best = *std::min_element(all.begin(), all.end(),
                             [](const RefinedChain& x, const RefinedChain& y) { return x.typical < y.typical; });
    constexpr int enough = 3;  // starts that agree are no accident
    if (best.typical < explained * size && agreeing() >= enough) break;
  }
  if (!(best.typical < explained * size))
    return error(
        "no robot of these joints explains the points: the best of {} generic starts leaves {:.1f} mm. Are the joint "
        "types right, and do the readings belong to the measurements?",
        all.size(), 1e3 * best.typical);
  constexpr int final_rounds = 10;
  const int same = agreeing();
  const RefinedChain last = refined(best.chain, data, size, final_rounds);
  return LocalPoeFit{last.chain, last.typical, static_cast<int>(all.size()), same};
}

}  // namespace kinfer
