// SPDX-License-Identifier: Apache-2.0
#include "kinfer/io/pose_set/pose_log.hpp"

#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/foreign/pose_tables.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/pose_set/pose_topics.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"

namespace kinfer {
namespace {

PoseTableChoice table_choice(const Chain& chain, const PoseLogChoice& choice) {
  PoseTableChoice wanted{.joints = active_joint_names(chain), .marker = choice.marker};
  for (const int joint : active_joints(chain))
    wanted.translates.push_back(translates(chain.joints[static_cast<std::size_t>(joint)].type));
  return wanted;
}

Result<PoseLog> read_table(std::string_view text, const std::string& name, const Chain& chain,
                           const PoseTableFormat& format, const PoseTableChoice& choice, RequiredContent required) {
  const auto kind = required == RequiredContent::targets ? PoseTableKind::points : PoseTableKind::joints;
  if (format.kind != kind)
    return error("{}: this is {}, which holds {}", name, format.title,
                 kind == PoseTableKind::points ? "joint positions; expected measured points"
                                               : "measured points; expected joint positions");
  KINFER_TRY(found, format.read(text, name, &choice));
  KINFER_TRY(set, parse_pose_table(found.table, name, chain, {}, required));
  return PoseLog{std::move(set), std::string(format.title), std::move(found.remarks)};
}

}  // namespace

Result<PoseLog> read_pose_log(const std::filesystem::path& path, const Chain& chain, const PoseLogChoice& choice,
                              RequiredContent required) {
  const std::string name = path.string();
  if (is_message_log_file(path)) {
    auto topic = required == RequiredContent::targets ? read_point_topic(path, chain, choice.topics)
                                                      : read_joint_topic(path, chain, choice.topics);
    if (!topic) return forward_error(topic.error());
    return PoseLog{std::move(topic->set), "topic " + topic->topic, std::move(topic->remarks)};
  }
  KINFER_TRY(text, read_text_file(path));
  const PoseTableFormat* format = choice.map.columns.empty() ? find_pose_table_format(text) : nullptr;
  if (format) return read_table(text, name, chain, *format, table_choice(chain, choice), required);
  if (!choice.marker.empty()) return error("{}: --marker has no effect on this file, which is no tracker's", name);
  KINFER_TRY(set, parse_pose_set(text, name, chain, choice.map, required));
  return PoseLog{.set = std::move(set)};
}

}  // namespace kinfer
