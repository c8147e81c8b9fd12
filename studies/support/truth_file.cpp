// SPDX-License-Identifier: Apache-2.0
#include "studies/support/truth_file.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/io/files/text_file.hpp"

namespace kinfer::study {
namespace {

using Json = nlohmann::json;

Vec3 vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

std::vector<Vec3> vectors_of(const Json& json) {
  std::vector<Vec3> list;
  for (const Json& entry : json) list.push_back(vector_of(entry));
  return list;
}

JointType joint_type_of(const std::string& text) {
  for (const JointType type : {JointType::revolute, JointType::prismatic, JointType::fixed})
    if (traits(type).name == text) return type;
  return JointType::revolute;
}

JointTruth joint_of(const Json& json) {
  return {.name = json.at("name"),
          .parent = json.at("parent"),
          .child = json.at("child"),
          .type = joint_type_of(json.at("type")),
          .axis_in_parent = vector_of(json.at("axis_in_parent")),
          .axis_in_child = vector_of(json.at("axis_in_child")),
          .point_in_parent = vector_of(json.at("point_in_parent")),
          .point_in_child = vector_of(json.at("point_in_child")),
          .unobservable_in_parent = vectors_of(json.at("not_identifiable_in_parent")),
          .unobservable_in_child = vectors_of(json.at("not_identifiable_in_child")),
          .is_axial_offset_observable = json.at("slide_observable"),
          .heading_needs_magnetometer = json.at("azimuth_by_magnetometer_only")};
}

}  // namespace

Result<MachineTruth> read_truth(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  const Json json = Json::parse(text);
  MachineTruth truth{.root = json.at("root"), .joints = {}, .loops = {}, .links = {}};
  for (const Json& joint : json.at("joints")) truth.joints.push_back(joint_of(joint));
  for (const Json& link : json.at("links"))
    truth.links.push_back({.segment = link.at("segment"),
                           .from = link.at("from"),
                           .to = link.at("to"),
                           .length = link.at("length_m"),
                           .axis_angle = link.at("axis_angle_rad")});
  return truth;
}

}  // namespace kinfer::study
