// SPDX-License-Identifier: Apache-2.0
#include "fuzz/readers.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "kinfer/base/expect.hpp"
#include "kinfer/io/evidence/evidence_file.hpp"
#include "kinfer/io/files/compressed_text.hpp"
#include "kinfer/io/files/zip_archive.hpp"
#include "kinfer/io/fleet/fleet_json.hpp"
#include "kinfer/io/fleet/manifest.hpp"
#include "kinfer/io/motion/reach_targets_csv.hpp"
#include "kinfer/io/pose_set/foreign/pose_tables.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/pose_set/pose_topics.hpp"
#include "kinfer/io/recording/foreign/foreign_log.hpp"
#include "kinfer/io/recording/foreign/ins_map.hpp"
#include "kinfer/io/recording/foreign/ins_presets.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/io/recording/ins_row_reader.hpp"
#include "kinfer/io/recording/ins_topics.hpp"
#include "kinfer/io/recording/machine_facts_toml.hpp"
#include "kinfer/io/recording/sensor_grade_toml.hpp"
#include "kinfer/io/robot/mjcf/mjcf.hpp"
#include "kinfer/io/robot/patch/mjcf_patch.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/robot/urdf/urdf.hpp"
#include "kinfer/io/robot_log/message_definition.hpp"
#include "kinfer/io/robot_log/message_log_formats.hpp"
#include "kinfer/io/tracking/tracking_model_toml.hpp"
#include "kinfer/report/report.hpp"
#include "kinfer/search/swarm/mlp.hpp"

namespace kinfer::fuzz {
namespace {

constexpr const char* name = "input";

/// Two joints, so that pose sets have columns to be read into.
const Chain& two_joints() {
  static const Chain chain = [] {
    Chain made;
    for (int j = 0; j < 2; ++j)
      made.joints.push_back(Joint{.name = j == 0 ? "shoulder" : "elbow", .parent = j - 1, .link = MdhLink{}});
    made.fixtures.anchors = {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)};
    return made;
  }();
  return chain;
}

/// What was written of something that was read.
template <class T>
void expect_readable(const Result<T>& again) {
  KINFER_EXPECT(again, "what was written cannot be read: {}", again.error().what);
}

/// More bodies inside each other than a reader of XML takes.
bool is_deep(const Chain& chain) {
  return chain.joints.size() > 90;
}

void read_robot(const std::string& bytes) {
  const auto robot = parse_robot_toml(bytes, name);
  if (!robot) return;
  const auto again = parse_robot_toml(format_robot_toml(*robot), name);
  expect_readable(again);
  if (is_deep(robot->chain)) return;
  const auto mjcf = parse_mjcf(format_mjcf(robot->chain), name);
  KINFER_EXPECT(mjcf, "the MJCF that was written cannot be read: {}", mjcf.error().what);
}

void read_urdf_text(const std::string& bytes) {
  const auto chain = parse_urdf(bytes, name);
  if (!chain) return;
  const auto again = parse_urdf(format_urdf(*chain), name);
  expect_readable(again);
}

Chain with_origins_moved(Chain chain) {
  for (Joint& joint : chain.joints)
    if (has_position(joint.type)) std::get<UrdfLink>(joint.link).origin.xyz.x() += 1e-3;
  return chain;
}

void write_back(const std::string& bytes, const Chain& in_file) {
  const auto tree = parse_mjcf_tree(bytes, name);
  const auto ends = mjcf_ends(tree.value(), name, {});
  for (const Chain& corrected : {in_file, with_origins_moved(in_file)}) {
    const auto origins = calibrated_origins(in_file, corrected, EncoderOffsets::folded);
    if (!origins) continue;
    const auto patched = patch_mjcf(bytes, name, ends.value(), *origins);
    if (!patched) continue;
    const auto again = parse_mjcf(patched->text, name);
    KINFER_EXPECT(again, "what was written back cannot be read: {}", again.error().what);
  }
}

void read_mjcf_text(const std::string& bytes) {
  const auto chain = parse_mjcf(bytes, name);
  if (!chain) return;
  write_back(bytes, *chain);
  if (is_deep(*chain)) return;
  const auto again = parse_mjcf(format_mjcf(*chain), name);
  expect_readable(again);
}

void read_poses(const std::string& bytes) {
  const auto set = parse_pose_set(bytes, name, two_joints(), {});
  if (!set) return;
  const auto again = parse_pose_set(format_pose_set_csv(*set, two_joints(), FileUnits::mm_deg), name, two_joints(), {});
  expect_readable(again);
}

void read_foreign(const std::string& bytes) {
  static_cast<void>(parse_foreign_log(bytes, name, {}));
}

void read_preset(const std::string& bytes) {
  const InsMap* preset = find_preset(bytes, name);
  if (preset) static_cast<void>(parse_foreign_log(bytes, name, *preset));
}

/// Every format of joint logs and tracker files, whichever would be recognised.
void read_pose_tables(const std::string& bytes) {
  const PoseTableChoice choice{.joints = {"shoulder", "elbow"}, .translates = {false, false}, .marker = "tip"};
  for (const PoseTableFormat& format : pose_table_formats()) {
    static_cast<void>(format.recognise(bytes));
    static_cast<void>(format.read(bytes, name, nullptr));
    const auto found = format.read(bytes, name, &choice);
    const bool is_points = format.kind == PoseTableKind::points;
    if (found)
      static_cast<void>(parse_pose_table(found->table, name, two_joints(), {},
                                         is_points ? RequiredContent::targets : RequiredContent::joints_only));
  }
}

void read_archive(const std::string& bytes) {
  const auto entries = zip_entries(bytes, name);
  if (!entries) return;
  constexpr std::size_t most = 4;  // an archive may list one file many times
  for (std::size_t i = 0; i < std::min(entries->size(), most); ++i)
    static_cast<void>(unpack_zip_entry(bytes, (*entries)[i], name));
}

void read_compressed(const std::string& bytes) {
  constexpr std::size_t most = std::size_t{1} << 20;
  static_cast<void>(unpack_zstd_head(bytes, most));
}

void read_grade(const std::string& bytes) {
  const auto grade = parse_sensor_grade(bytes, name);
  if (!grade) return;
  const auto again = parse_sensor_grade(format_sensor_grade(*grade), name);
  expect_readable(again);
}

void read_tracking(const std::string& bytes) {
  const auto model = parse_tracking_model(bytes, name);
  if (!model) return;
  const auto again = parse_tracking_model(format_tracking_model(*model), name);
  expect_readable(again);
}

void read_sweep(const std::string& bytes) {
  const auto tasks = parse_manifest(bytes, name);
  if (!tasks) return;
  const auto again = parse_manifest(format_manifest(*tasks), name);
  expect_readable(again);
  KINFER_EXPECT(*again == *tasks, "tasks change where they are written and read");
}

void read_net(const std::string& bytes) {
  const auto net = parse_mlp(bytes, name);
  if (!net) return;
  const auto again = parse_mlp(format_mlp(*net), name);
  expect_readable(again);
}

/// What a sweep keeps of each task, and what a merge makes of many.
void read_fleet(const std::string& bytes) {
  if (const auto summary = parse_task_summary(bytes)) {
    const auto again = parse_task_summary(format_task_summary(*summary));
    expect_readable(again);
  }
  if (const auto information = parse_information(bytes)) {
    const auto again = parse_information(format_information(*information));
    expect_readable(again);
  }
  if (const auto population = parse_population(bytes, name)) {
    const auto again = parse_population(format_population(*population), name);
    expect_readable(again);
  }
}

/// What a log that arrives in pieces of `size` bytes gives: rows, remarks and the error.
std::string rows_in_pieces(const std::string& bytes, std::size_t size) {
  InsRowReader reader({"ins0", "ins1"}, name);
  std::string seen;
  const auto sink = [&](const InsRow& row) -> Result<void> {
    seen.append(reinterpret_cast<const char*>(&row.time), sizeof row.time);
    return {};
  };
  Result<void> ended;
  for (std::size_t k = 0; k < bytes.size() && ended; k += size)
    ended = reader.add(std::string_view(bytes).substr(k, size), sink);
  if (ended) ended = reader.finish(sink);
  for (const std::string& remark : reader.remarks()) seen += remark;
  return ended ? seen : seen + ended.error().what;
}

void read_rows(const std::string& bytes) {
  KINFER_EXPECT(rows_in_pieces(bytes, 7) == rows_in_pieces(bytes, bytes.size()), "rows depend on how they arrive");
}

void read_definition(const std::string& bytes) {
  for (const bool is_ros1 : {false, true})
    static_cast<void>(parse_message_definition(bytes, "sensor_msgs/Imu", is_ros1));
}

/// Message logs are read from files; this one is in memory.
void read_log(const std::string& bytes) {
  const int file = ::memfd_create("log", 0);
  if (file < 0) return;
  const bool is_written = ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  if (is_written && is_message_log(bytes)) {
    InsRecording recording;
    const std::string path = "/proc/self/fd/" + std::to_string(file);
    static_cast<void>(append_all_ins_topics(path, recording));
    static_cast<void>(read_joint_topic(path, two_joints(), {}));
    static_cast<void>(read_point_topic(path, two_joints(), {}));
  }
  ::close(file);
}

constexpr std::array table{
    Reader{"ins_csv", [](const std::string& bytes) { static_cast<void>(parse_ins_csv(bytes, name)); }},
    Reader{"ins_map", [](const std::string& bytes) { static_cast<void>(parse_ins_map(bytes, name)); }},
    Reader{"foreign_log", read_foreign},
    Reader{"preset", read_preset},
    Reader{"pose_tables", read_pose_tables},
    Reader{"archive", read_archive},
    Reader{"compressed", read_compressed},
    Reader{"message_log", read_log},
    Reader{"facts", [](const std::string& bytes) { static_cast<void>(parse_machine_facts(bytes, name)); }},
    Reader{"grade", read_grade},
    Reader{"poses", read_poses},
    Reader{"column_map", [](const std::string& bytes) { static_cast<void>(parse_column_map(bytes, name)); }},
    Reader{"targets",
           [](const std::string& bytes) { static_cast<void>(parse_reach_targets(bytes, name, two_joints(), {})); }},
    Reader{"robot_toml", read_robot},
    Reader{"urdf", read_urdf_text},
    Reader{"mjcf", read_mjcf_text},
    Reader{"tracking_model", read_tracking},
    Reader{"evidence", [](const std::string& bytes) { static_cast<void>(report::report_of_file(bytes)); }},
    Reader{"manifest", read_sweep},
    Reader{"fleet", read_fleet},
    Reader{"net", read_net},
    Reader{"rows", read_rows},
    Reader{"message_definition", read_definition},
};

}  // namespace

std::span<const Reader> readers() {
  return table;
}

const Reader* find_reader(std::string_view wanted) {
  const auto found = std::ranges::find(table, wanted, &Reader::name);
  return found == table.end() ? nullptr : &*found;
}

}  // namespace kinfer::fuzz
