// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/chain_view.hpp"

#include <nlohmann/json.hpp>

namespace kinfer {
namespace {

using Json = nlohmann::json;

Vec3 vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Pose pose_of(const Json& json) {
  const Json& q = json.at("quat");
  const Quat rotation(q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>(), q.at(3).get<double>());
  return {rotation.normalized().toRotationMatrix(), vector_of(json.at("xyz"))};
}

JointView joint_of(const Json& json) {
  JointView joint{.name = json.at("name"),
                  .parent = json.at("parent"),
                  .type = joint_type_named(json.at("type").get<std::string>()).value_or(JointType::fixed),
                  .reading = json.at("reading"),
                  .before = pose_of(json.at("before")),
                  .after = pose_of(json.at("after")),
                  .axis = vector_of(json.at("axis")),
                  .gain = json.at("gain"),
                  .couplings = {}};
  for (const Json& c : json.at("couplings")) joint.couplings.emplace_back(c.at(0).get<int>(), c.at(1).get<double>());
  return joint;
}

double variable(const JointView& joint, const std::vector<double>& q) {
  const auto reading = [&](int k) {
    return k >= 0 && k < static_cast<int>(q.size()) ? q[static_cast<std::size_t>(k)] : 0.0;
  };
  double value = joint.gain * reading(joint.reading);
  for (const auto& [k, factor] : joint.couplings) value += factor * reading(k);
  return value;
}

}  // namespace

ChainView chain_view(const Json& json) {
  ChainView chain{pose_of(json.at("base")), pose_of(json.at("tool")), json.at("tip"), {}};
  for (const Json& joint : json.at("joints")) chain.joints.push_back(joint_of(joint));
  return chain;
}

std::vector<JointPlacementView> placed(const ChainView& chain, const std::vector<double>& q) {
  std::vector<JointPlacementView> places;
  for (const JointView& joint : chain.joints) {
    const Pose parent = joint.parent < 0 ? chain.base : places[static_cast<std::size_t>(joint.parent)].frame;
    const Pose before = parent * joint.before;
    const double v = variable(joint, q);
    const Pose moved = translates(joint.type) ? Pose{Mat3::Identity(), v * joint.axis}
                       : rotates(joint.type)  ? Pose{Eigen::AngleAxisd(v, joint.axis).toRotationMatrix(), Vec3::Zero()}
                                              : Pose{};
    places.push_back({before * moved * joint.after, before.rotation * joint.axis, before.position});
  }
  return places;
}

Pose tool_pose(const ChainView& chain, const std::vector<JointPlacementView>& joints) {
  return (chain.tip < 0 ? chain.base : joints[static_cast<std::size_t>(chain.tip)].frame) * chain.tool;
}

}  // namespace kinfer
